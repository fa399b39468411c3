// Plots of the lag as curves: along the path, against speed, after a cut.
#include "report/html_text.hpp"
#include "report/lag_tables.hpp"
#include "report/line_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace catoptric::report {

namespace {

constexpr auto kFlip = &measure::Difference::flip;

/// Returns the opacity of the k-th of n lines. The last line is the strongest.
double strength(std::size_t k, std::size_t n) {
    return 0.3 + 0.7 * static_cast<double>(k + 1) / static_cast<double>(n);
}

std::string along_path(const Lag& lag, const LagRow& row) {
    LinePlot plot{.x_name = "instant of the scene, s",
                  .y_name = "FLIP to the still picture",
                  .says = "Lag of " + row.label + " along the path, one line a speed",
                  .x = lag.seconds};
    for (const double share : {0.0, 0.25, 0.5, 0.75})
        plot.x_ticks.push_back(lag.seconds.front() + share * lag.path);
    std::erase_if(plot.x_ticks, [&](double tick) { return tick > lag.seconds.back(); });
    for (std::size_t k = 0; k < row.speeds.size(); ++k)
        plot.lines.push_back({fmt::format("{:g}x", row.speeds[k].speed),
                              measure::figures_of(row.speeds[k].errors, kFlip),
                              strength(k, row.speeds.size())});
    return line_plot(plot);
}

std::string against_speed(const Lag& lag) {
    LinePlot plot{.x_name = "speed of the scene's time",
                  .y_name = "FLIP to the still picture, mean",
                  .says = "Mean lag against speed, one line a row",
                  .log_x = true};
    for (const LagAtSpeed& at : lag.rows.front().speeds) plot.x.push_back(at.speed);
    plot.x_ticks = plot.x;
    for (std::size_t k = 0; k < lag.rows.size(); ++k) {
        PlotLine line{lag.rows[k].label, {}, strength(k, lag.rows.size())};
        for (const LagAtSpeed& at : lag.rows[k].speeds)
            line.y.push_back(measure::mean_of(at.errors, kFlip));
        plot.lines.push_back(std::move(line));
    }
    return line_plot(plot);
}

std::string after_jump(const Lag& lag) {
    constexpr std::size_t kShown = 10; // number of frames shown
    LinePlot plot{.x_name = "frame after a jump of half the path",
                  .y_name = "rmse to the still picture",
                  .says = "Error of the frames after a jump, one line a row"};
    for (std::size_t k = 0; k < lag.rows.size(); ++k) {
        const std::vector<double>& rmse = lag.rows[k].after_jump.rmse;
        const std::size_t shown = std::min(kShown, rmse.size());
        for (std::size_t i = plot.x.size(); i < shown; ++i)
            plot.x.push_back(static_cast<double>(i + 1));
        const std::vector<double> first(rmse.begin(),
                                        rmse.begin() + static_cast<std::ptrdiff_t>(shown));
        plot.lines.push_back({lag.rows[k].label, first, strength(k, lag.rows.size())});
    }
    plot.x_ticks = plot.x;
    return line_plot(plot);
}

std::string figure(const std::string& drawing, const std::string& caption) {
    if (drawing.empty()) return "";
    return "<figure>" + drawing + "<figcaption>" + html_escaped(caption) + "</figcaption></figure>";
}

} // namespace

std::string lag_plots(const Comparison& comparison) {
    if (!comparison.lag || comparison.lag->rows.empty()) return "";
    const Lag& lag = *comparison.lag;
    std::string html = "<section><h2>Lag</h2><div class=\"panels\">";
    for (const LagRow& row : lag.rows)
        html += figure(along_path(lag, row), row.label + " along the path, one line a speed");
    html += figure(against_speed(lag), "Mean over the path against speed");
    html += figure(after_jump(lag), "Frames after a cut");
    return html + "</div><p class=\"note\">All against the still picture of the same row and "
                  "instant, over the mirrors. The lane below is 0.</p></section>\n";
}

} // namespace catoptric::report
