#include "report/stacked_bars.hpp"

#include "report/html.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace catoptric::report {

namespace {

// Sizes in the units of the drawing, which are pixels where it is not scaled.
constexpr double kBarsWidth = 860, kBarHeight = 14, kBarDistance = 21, kLetterWidth = 6.6;
constexpr double kLegendLineHeight = 18, kLegendBoxSize = 10, kAxisHeight = 44, kRightMargin = 24;
constexpr double kMaxLabelWidth = 330;

double bar_length(double value) { return std::isfinite(value) && value > 0 ? value : 0; }

double sum_bar(const StackedBar& bar) {
    double sum = 0;
    for (const double value : bar.lengths) sum += bar_length(value);
    return sum;
}

/// Returns a distance of ticks, 1, 2 or 5 times a power of ten, that gives 3 to 8 ticks.
double tick_distance(double longest) {
    const double decade = std::pow(10.0, std::floor(std::log10(longest / 3)));
    for (const double step : {1.0, 2.0, 5.0})
        if (longest / (step * decade) < 8) return step * decade;
    return 10 * decade;
}

std::string draw_text(double x, double y, const char* anchor, const std::string& text) {
    return fmt::format(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="{}">{}</text>)", x, y, anchor,
                       escape_html(text));
}

/// Draws the names of the kinds that some bar has, in as many lines as they need. Sets `y` below
/// the last line.
std::string draw_legend(const StackedBars& chart, double left, double& y) {
    std::string svg;
    double x = left;
    y = kLegendLineHeight;
    for (std::size_t k = 0; k < chart.kinds.size(); ++k) {
        const BarPartKind& kind = chart.kinds[k];
        if (std::ranges::none_of(chart.bars, [k](const StackedBar& bar) {
                return k < bar.lengths.size() && bar_length(bar.lengths[k]) > 0;
            }))
            continue;
        const double width = kLegendBoxSize + 6 +
                             kLetterWidth * static_cast<double>(kind.name.size()) + 14;
        if (x + width > kBarsWidth && x > left) x = left, y += kLegendLineHeight;
        svg += fmt::format(
                   R"(<rect x="{:.1f}" y="{:.1f}" width="{}" height="{}" style="fill:{}"/>)", x,
                   y - kLegendBoxSize, kLegendBoxSize, kLegendBoxSize, kind.colour) +
               draw_text(x + kLegendBoxSize + 5, y, "start", kind.name);
        x += width;
    }
    y += 10;
    return svg;
}

} // namespace

std::string bar_colour(std::size_t kind) {
    constexpr std::array kColours{"#0072b2", "#e69f00", "#009e73", "#56b4e9",
                                  "#d55e00", "#cc79a7", "#f0e442", "#999999"};
    return kColours[kind % kColours.size()];
}

std::string draw_bars(const StackedBars& chart) {
    double longest = 0;
    std::size_t letters = 0;
    for (const StackedBar& bar : chart.bars) {
        longest = std::max(longest, sum_bar(bar));
        letters = std::max(letters, bar.label.size());
    }
    if (!(longest > 0)) return "";
    const double left = std::min(kMaxLabelWidth, 16 + kLetterWidth * static_cast<double>(letters));
    const double scale = (kBarsWidth - kRightMargin - left) / longest;
    double top = 0;
    const std::string legend = draw_legend(chart, left, top);
    const double bottom = top + kBarDistance * static_cast<double>(chart.bars.size());
    std::string svg = fmt::format(R"(<svg viewBox="0 0 {} {:.0f}" role="img" aria-label="{}">)",
                                  kBarsWidth, bottom + kAxisHeight, escape_html(chart.says)) +
                      legend;
    const double step = tick_distance(longest);
    for (int tick = 0; tick * step <= longest * (1 + 1e-9); ++tick) {
        const double x = left + tick * step * scale;
        svg += fmt::format(
                   R"(<line class="grid" x1="{0:.1f}" y1="{1:.1f}" x2="{0:.1f}" y2="{2:.1f}"/>)", x,
                   top, bottom) +
               draw_text(x, bottom + 15, "middle", fmt::format("{:g}", tick * step));
    }
    double y = top;
    for (const StackedBar& bar : chart.bars) {
        svg += draw_text(left - 8, y + kBarHeight - 3, "end", bar.label);
        double x = left;
        for (std::size_t k = 0; k < bar.lengths.size(); ++k) {
            const double width = scale * bar_length(bar.lengths[k]);
            if (!(width > 0)) continue;
            svg += fmt::format(
                R"(<rect x="{:.2f}" y="{:.1f}" width="{:.2f}" height="{}" style="fill:{}">)"
                "<title>{}: {}, {:.4g}</title></rect>",
                x, y, width, kBarHeight, chart.kinds[k].colour, escape_html(bar.label),
                escape_html(chart.kinds[k].name), bar.lengths[k]);
            x += width;
        }
        y += kBarDistance;
    }
    return svg +
           draw_text((left + kBarsWidth - kRightMargin) / 2, bottom + 34, "middle", chart.x_name) +
           "</svg>";
}

} // namespace catoptric::report
