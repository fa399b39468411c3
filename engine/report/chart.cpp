#include "report/chart.hpp"

#include "measure/halves.hpp"
#include "measure/judge.hpp"
#include "measure/rows.hpp"
#include "report/html.hpp"
#include "report/plot.hpp"
#include "report/tables.hpp"
#include "report/text.hpp"

#include <algorithm>
#include <cmath>

namespace catoptric::report {

namespace {

Json chart_column(const RowMetricColumn& column, const std::vector<std::size_t>& rows) {
    return {{"name", column.name},
            {"values",
             list_json(rows, [&](std::size_t row) { return number_json(column.values[row]); })},
            {"intervals", list_json(rows, [&](std::size_t row) {
                 return interval_json(column.intervals[row]);
             })}};
}

Json chart_row(const Comparison& comparison, std::size_t index) {
    const Row& row = comparison.rows[index];
    return {{"label", row.label},
            {"picture", index + 1}, // number of the row's picture in the comparer
            {"place", format_time_places(measure::find_rank_range(comparison, row))},
            {"front", measure::is_on_front(comparison, row)},
            {"traced", measure::is_ray_traced(row)},
            {"hidden", measure::is_below_noise(row.error)}};
}

} // namespace

std::string data_script(const Json& data) {
    // The character "<" is escaped, because a label with "</script>" would end the script element.
    std::string text;
    for (const char c : data.dump(-1, ' ', true, Json::error_handler_t::replace))
        text += c == '<' ? "\\u003c" : std::string(1, c);
    return "<script type=\"application/json\">" + text + "</script>";
}

std::string html_chart(const Json& data, const std::string& fallback) {
    return std::string(kChartOpening) + data_script(data) + "<noscript>" + fallback +
           "</noscript></div>";
}

std::string rows_chart(const Comparison& comparison) {
    std::vector<std::size_t> rows;
    for (std::size_t i = 0; i < comparison.rows.size(); ++i)
        if (has_time(comparison.rows[i])) rows.push_back(i);
    const std::vector<RowMetricColumn> columns = row_metric_columns(comparison);
    if (rows.empty() || columns.empty()) return "";
    RowMetricColumn time{time_axis_name(comparison), {}, {}};
    for (const Row& row : comparison.rows) {
        time.values.push_back(row.time_ms().median);
        time.intervals.push_back(row.time_ms().ci95);
    }
    std::vector<std::vector<std::size_t>> curves = knob_curves(comparison, rows);
    for (std::vector<std::size_t>& curve : curves) // indices of the chart's rows
        for (std::size_t& row : curve)
            row = static_cast<std::size_t>(std::ranges::find(rows, row) - rows.begin());
    Json data{
        {"kind", "rows"},
        {"says", "Time against error of each row; the figures are in the table of every row"},
        {"time", chart_column(time, rows)},
        {"metrics",
         list_json(columns,
                   [&](const RowMetricColumn& column) { return chart_column(column, rows); })},
        {"rows", list_json(rows, [&](std::size_t row) { return chart_row(comparison, row); })},
        {"curves", curves},
        {"log_x", true},
        {"log_y", true}};
    if (comparison.noise && comparison.noise->flip_floor > 0)
        data["floor"] = {{"value", comparison.noise->flip_floor}, {"name", kBelowNoise}};
    const std::string plot = comparison_plot(comparison);
    return html_chart(data, plot.empty() ? plot
                                         : "<div class=\"scroll\" tabindex=\"0\" role=\"region\" "
                                           "aria-label=\"Plot\">" +
                                               plot + "</div>");
}

std::string html_chart(const LineChart& chart) {
    if (std::ranges::none_of(chart.lines, [](const ChartLine& line) {
            return std::ranges::any_of(line.y, [](double y) { return std::isfinite(y); });
        }))
        return "";
    return html_chart(
        {{"kind", "lines"},
         {"says", chart.says},
         {"x_name", chart.x_name},
         {"y_name", chart.y_name},
         {"x", numbers_json(chart.x)},
         {"x_ticks", numbers_json(chart.x_ticks)},
         {"lines", list_json(chart.lines,
                             [](const ChartLine& line) {
                                 return Json{{"name", line.name}, {"y", numbers_json(line.y)}};
                             })},
         {"log_x", chart.log_x},
         {"log_y", true}},
        "<p class=\"note\">This chart needs JavaScript.</p>");
}

} // namespace catoptric::report
