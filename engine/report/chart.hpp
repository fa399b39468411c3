#pragma once

#include "report/comparison.hpp"
#include "report/json.hpp"

#include <string>
#include <vector>

// Charts of pages. The page has their data as JSON, and the page's script draws them by the library
// uPlot (report/page/charts.js).
namespace catoptric::report {

/// Returns a script element that holds the data as JSON.
std::string data_script(const Json& data);
/// `fallback`: HTML for readers without script.
std::string html_chart(const Json& data, const std::string& fallback);

/// Returns the rows of a comparison as a chart of time against any column of the table of all rows.
/// Without script, the chart is the SVG of comparison_plot. Empty if no row has a time and a
/// value.
std::string rows_chart(const Comparison& comparison);

struct ChartLine {
    std::string name; ///< name shown at the line's right end
    /// One value for each of LineChart::x, at least 0; NaN leaves the point out.
    std::vector<double> y;
};

struct LineChart {
    std::string x_name, y_name;
    std::string says;      ///< text for readers who cannot see the chart
    std::vector<double> x; ///< increasing; positive if `log_x`
    std::vector<double> x_ticks;
    bool log_x = false;
    std::vector<ChartLine> lines; ///< the last line is the strongest
};

/// Returns a chart of lines. The y axis is logarithmic, and values of 0 lie in a separate lane.
/// Returns an empty text if no line has a point.
std::string html_chart(const LineChart& chart);

} // namespace catoptric::report
