#pragma once

#include "measure/judge.hpp"
#include "measure/metric.hpp"
#include "report/comparison.hpp"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// Tables and sentences of the report as text, before they become Markdown or HTML. A sentence is
// left out if the comparison lacks the rows it needs.
namespace catoptric::report {

struct TableColumn {
    TableColumn(std::string title) : name(std::move(title)) {}
    TableColumn(const char* title) : name(title) {}
    std::string name;
    bool is_number = true; ///< the column's cells are right-aligned
};
TableColumn text_column(const char* title);

struct ReportTable {
    std::string title;
    std::vector<TableColumn> columns;
    std::string note; ///< meaning of the columns; may be empty
    std::vector<std::vector<std::string>> rows = {};
    std::vector<bool> marked = {}; ///< rows to highlight; empty or one entry a row
};

/// `decimals`: that of times in the table.
std::string format_metric_number(double value, const measure::MetricColumn& column,
                                 int decimals = 0);
/// Returns a pipe table under its title. Its columns also line up as plain text. Empty if the table
/// has no rows.
std::string to_markdown(const ReportTable& table);

/// Returns the seed report's Table 1 beside our measurements.
ReportTable seed_table(const Comparison& comparison);
/// Returns the table of all rows with all its metrics. Rows on the Pareto front are marked.
ReportTable rows_table(const Comparison& comparison);
/// A column of the table of all rows as numbers, for charts. Values that are missing are NaN.
struct RowMetricColumn {
    std::string name;           ///< the column's title, with the mask of its pixels
    std::vector<double> values; ///< one for each row; the median of a list of times
    /// 95 % intervals of the values, one for each row.
    std::vector<measure::Interval> intervals;
};
/// Returns the columns of the table of all rows that hold numbers, without the time by which the
/// rows are ranked. The first is FLIP over the mirrors.
std::vector<RowMetricColumn> row_metric_columns(const Comparison& comparison);
/// Returns the 95 % interval of a row's rmse over the mirrors against a reference with noise.
/// Unknown for a reference without noise.
measure::Interval find_rmse_interval(const Row& row);
/// Returns the places of a row in the order of time, as "3" or "3–5"; "–" for a row without a time.
std::string format_time_places(const measure::RankRange& places);
/// Returns the technique of each mirror, for rows that are plans. Without such rows the table is
/// empty.
ReportTable plan_table(const Comparison& comparison);
/// Returns the technique as the user would write it. Knobs with default values are left out.
std::string format_technique(const PlanEntry& entry);
/// Returns FLIP of each mirror.
ReportTable mirror_table(const Comparison& comparison);
/// Returns the errors of looked-up directions, for rows that search. Without such rows the table is
/// empty.
ReportTable lookup_table(const Comparison& comparison);
/// Empty if the scene file has no unsupported feature.
ReportTable unsupported_table(const SceneFacts& scene);
/// Returns a text that says how an unsupported feature is left out, approximated or replaced. Empty
/// for an unknown id.
std::string describe_feature(const std::string& id);
/// Returns the error by cause with four lines a row. Empty if no row has causes.
ReportTable cause_table(const Comparison& comparison);
/// Returns each row's metrics over the mirrors in drawn views, as median and interval, and its
/// worst view. Empty if no views were drawn.
ReportTable views_table(const Comparison& comparison);
/// Returns the lag of each row at each speed. Empty if no lag was measured.
ReportTable lag_table(const Comparison& comparison);
/// Returns the table of how many frames after a cut pass until the picture equals the still
/// picture. Empty if no lag was measured.
ReportTable settling_table(const Comparison& comparison);

/// Colour in which pictures show a cause.
struct CauseColour {
    std::string_view cause, name;
    vec3 colour; ///< display space
};

/// Returns the colours of all causes, in the order of Causes::list, which may lack some.
/// Colour-blind readers can tell those of perfect mirrors apart, too (Okabe, Ito).
std::span<const CauseColour> cause_colours();
/// Returns the colours of the causes that some row has.
std::vector<CauseColour> found_cause_colours(const Comparison& comparison);

/// Returns the row's picture, dark and grey. Each mirror pixel that is off has the colour of the
/// cause with the largest part of its squared error. The row must have `causes`.
measure::Picture cause_picture(const Row& row);

/// A line at the head of a report, such as "Device": name and value.
struct ReportHeaderLine {
    std::string name;
    std::string value;
};
std::vector<ReportHeaderLine> list_facts(const Comparison& comparison);
/// Returns the set-up costs in one line, which stands above the rows.
std::string describe_setup(const SetupFacts& setup);
/// Returns cautions for the reader: a processor as device, a run cut short, rows measured together,
/// warnings.
std::vector<std::string> list_cautions(const Comparison& comparison);

/// Returns a sentence on how far a reference is from path tracing, or on how to find out. `rows`:
/// rows that are judged by the reference, of which the sentence counts those with less FLIP.
std::string describe_path_distance(const measure::PathDistance& distance,
                                   const std::vector<Row>& rows);

/// Returns the findings of a run. For the seed report's scene they include its statements about its
/// Table 1 and figures 5 and 7.
std::vector<std::string> list_findings(const Comparison& comparison);
std::string findings_title(const Comparison& comparison);

/// Returns sentences that answer the budgets of the comparison: the best row on this device, rows
/// that tie with it, or the rows that come nearest. Empty if the comparison has no budget.
std::string describe_budget(const Comparison& comparison);
/// Returns one sentence that names the device and says whether ray tracing beats the other rows on
/// it. If all rows are of one kind, it names the fastest and the closest row.
std::string summarise_verdict(const Comparison& comparison);
/// Returns the sentence on whether ray tracing beats the other rows. The given words replace "on
/// this device, NAME" at its beginning.
std::string summarise_verdict(const Comparison& comparison, const std::string& where);

/// Returns sentences that compare the measured lag with the seed report's statement that parts one
/// and two show no difference, and which rows have no lag.
std::optional<std::string> describe_lag(const Comparison& comparison);
/// Returns the order of the rows over drawn views by each headline metric, and which of them tie.
std::vector<std::string> describe_drawn_views(const Comparison& comparison);

/// Returns the Pareto front in words: the rows on it, and which row beats each of the others.
std::vector<std::string> describe_front(const Comparison& comparison);

} // namespace catoptric::report
