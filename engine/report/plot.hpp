#pragma once

#include "report/comparison.hpp"

#include <string>
#include <vector>

// Functions that draw plots as SVG, to embed in a page.
namespace catoptric::report {

struct PlotLine {
    std::string name; ///< name shown at the line's right end
    /// One value for each of LinePlot::x, at least 0; NaN leaves the point out.
    std::vector<double> y;
};

struct LinePlot {
    std::string x_name, y_name;
    std::string says;      ///< text for readers who cannot see the plot
    std::vector<double> x; ///< increasing; positive if `log_x`
    std::vector<double> x_ticks;
    bool log_x = false;
    std::vector<PlotLine> lines; ///< the last line is the strongest
};

/// Returns an SVG to embed in a page. The y axis is logarithmic and values of 0 lie in a separate
/// lane. Returns an empty text if the plot has no point.
std::string make_line_plot(const LinePlot& plot);

/// Returns the rows as an SVG: median ms against FLIP, both logarithmic. Error 0
/// has a separate lane and the Pareto front is drawn. Empty if no row can be placed.
std::string make_comparison_plot(const Comparison& comparison);

/// Returns plots of the lag as a section of a page; empty if no lag was measured at several
/// instants.
std::string make_lag_plots(const Comparison& comparison);

} // namespace catoptric::report
