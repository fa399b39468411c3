#pragma once

#include <string>
#include <vector>

namespace catoptric::report {

struct PlotLine {
    std::string name; ///< name shown at the line's right end
    /// One value for each of LinePlot::x, at least 0; NaN leaves the point out.
    std::vector<double> y;
    double strength = 1; ///< opacity, 0..1
};

struct LinePlot {
    std::string x_name, y_name;
    std::string says;      ///< text for readers who cannot see the plot
    std::vector<double> x; ///< increasing; positive if `log_x`
    std::vector<double> x_ticks;
    bool log_x = false;
    std::vector<PlotLine> lines;
};

/// Returns an SVG to embed in a page. The y axis is logarithmic and values of 0 lie in a separate
/// lane. Empty if there is no point.
std::string line_plot(const LinePlot& plot);

} // namespace catoptric::report
