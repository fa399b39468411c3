#pragma once

#include <string>
#include <vector>

namespace catoptric::report {

struct PlotLine {
    std::string name;      ///< at its right end
    std::vector<double> y; ///< one for each of LinePlot::x, at least 0; NaN: no point there
    double strength = 1;   ///< opacity, 0..1
};

struct LinePlot {
    std::string x_name, y_name;
    std::string says;      ///< for who cannot see it
    std::vector<double> x; ///< increasing; positive if `log_x`
    std::vector<double> x_ticks;
    bool log_x = false;
    std::vector<PlotLine> lines;
};

/// An SVG for inside a page: y logarithmic, 0 in a lane of its own. Empty when there is no point.
std::string line_plot(const LinePlot& plot);

} // namespace catoptric::report
