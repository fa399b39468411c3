#include "report/line_plot.hpp"

#include "report/html_text.hpp"
#include "report/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace catoptric::report {

using svg::grid_line, svg::kLine, svg::Scale, svg::text;

namespace {

constexpr double kChartWidth = 500, kChartHeight = 300;
constexpr double kChartLeft = 66, kChartRight = 340, kChartTop = 12, kChartLane = 226,
                 kChartBottom = 250; // the lane holds values of 0
constexpr double kChartZero = (kChartLane + kChartBottom) / 2;
constexpr std::size_t kMostTicks = 8;

double x_place(const LinePlot& plot, double x) {
    const auto along = [&](double value) { return plot.log_x ? std::log10(value) : value; };
    const double first = along(plot.x.front()), last = along(plot.x.back());
    return last > first
               ? kChartLeft + (along(x) - first) / (last - first) * (kChartRight - kChartLeft)
               : kChartLeft;
}

double y_place(const Scale& scale, double y) { return y > 0 ? scale(y) : kChartZero; }

std::vector<double> y_ticks(const Scale& scale) {
    std::vector<double> values = svg::ticks(scale);
    if (values.size() > kMostTicks) // too many ticks: keep only powers of ten
        std::erase_if(values, [](double value) {
            const double place = std::log10(value);
            return std::abs(place - std::round(place)) > 0.01;
        });
    return values;
}

std::string axes(const LinePlot& plot, const Scale& y) {
    std::string drawn = fmt::format(R"(<rect class="lane" x="{}" y="{}" width="{}" height="{}"/>)",
                                    kChartLeft, kChartLane, kChartRight - kChartLeft,
                                    kChartBottom - kChartLane);
    for (const double value : plot.x_ticks) {
        const double x = x_place(plot, value);
        drawn += grid_line(x, kChartTop, x, kChartBottom) +
                 text(x, kChartBottom + 16, "middle", fmt::format("{:g}", value));
    }
    for (const double value : y_ticks(y))
        drawn += grid_line(kChartLeft, y(value), kChartRight, y(value)) +
                 text(kChartLeft - 6, y(value) + 4, "end", fmt::format("{:g}", value));
    drawn += text(kChartLeft - 6, kChartZero + 4, "end", "0");
    drawn += text((kChartLeft + kChartRight) / 2, kChartBottom + 38, "middle",
                  html_escaped(plot.x_name));
    drawn += fmt::format("<g transform=\"translate(12 {}) rotate(-90)\">",
                         (kChartTop + kChartLane) / 2);
    return drawn + text(0, 0, "middle", html_escaped(plot.y_name)) + "</g>";
}

std::string path_of(const LinePlot& plot, const PlotLine& line, const Scale& y) {
    std::string path;
    for (std::size_t i = 0; i < line.y.size(); ++i)
        if (std::isfinite(line.y[i]))
            path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L",
                                x_place(plot, plot.x[i]), y_place(y, line.y[i]));
    return fmt::format(R"(<path class="line" style="opacity:{:.2f}" d="{}"/>)", line.strength,
                       path);
}

/// Returns the names at the right ends of the lines. A name moves up if it would overlap another.
std::string names(const LinePlot& plot, const Scale& y) {
    std::vector<std::pair<double, std::string>> places;
    for (const PlotLine& line : plot.lines)
        if (!line.y.empty() && std::isfinite(line.y.back()))
            places.emplace_back(y_place(y, line.y.back()), line.name);
    std::ranges::stable_sort(places, std::greater(), &std::pair<double, std::string>::first);
    std::string drawn;
    double free = kChartBottom + kLine;
    for (const auto& [place, name] : places) {
        free = std::min(place, free - kLine);
        drawn += text(kChartRight + 6, free + 4, "start", html_escaped(name));
    }
    return drawn;
}

} // namespace

std::string line_plot(const LinePlot& plot) {
    std::vector<double> positive;
    bool any = false;
    for (const PlotLine& line : plot.lines)
        for (const double y : line.y) {
            any |= std::isfinite(y);
            if (std::isfinite(y) && y > 0) positive.push_back(y);
        }
    if (!any) return "";
    const Scale y = svg::log_scale(positive, kChartLane - 6, kChartTop);
    std::string drawn = fmt::format(R"(<svg viewBox="0 0 {} {}" role="img" aria-label="{}">)",
                                    kChartWidth, kChartHeight, html_escaped(plot.says));
    drawn += axes(plot, y);
    for (const PlotLine& line : plot.lines) drawn += path_of(plot, line, y);
    return drawn + names(plot, y) + "</svg>";
}

} // namespace catoptric::report
