#pragma once

#include "measure/interval.hpp"
#include "sweep_plan.hpp"

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

namespace catoptric::cli {

/// The results of all pieces of a sweep that have the same scene and options, in the order of the
/// plan.
struct SweepGroup {
    SweepJson scene, options;
    std::vector<std::string> labels;
    std::vector<const SweepPiece*> picture_pieces, timing_pieces;
    std::vector<SweepJson> pictures, timings; ///< results of these pieces
};

/// Reads the results of all pieces. Throws if a result is missing or broken.
std::vector<SweepGroup> read_groups(const std::filesystem::path& folder, const SweepPlan& plan);

/// Mean, median and largest of some values, and the 95 % interval of the median.
struct SweepSummary {
    std::size_t count = 0;
    double mean = NAN, median = NAN, least = NAN, largest = NAN;
    measure::Interval ci95; ///< unknown for fewer values than measure::kMinIntervalSamples
};

/// Returns the summary of all values that are not NaN.
SweepSummary summarise(std::vector<double> values);

/// Returns a metric of a row over its mirrors, one value for each view. Views without a value have
/// NaN.
std::vector<double> metric_values(const SweepGroup& group, std::size_t row,
                                  const std::string& metric);

/// Returns the number of different instants of the group's views; 1 for a single view.
std::size_t count_instants(const SweepGroup& group);

/// Returns whether several views share an instant because the sweep asked for it. In a scene
/// without motion all views have the same instant, but they count as independent.
bool has_dependent_views(const SweepGroup& group);

/// Returns the summary of a metric of a row over the views of its group. The interval counts views,
/// or instants if views share them.
SweepSummary summarise_metric(const SweepGroup& group, const std::vector<double>& values);

/// A table as a CSV file by RFC 4180.
class CsvTable {
public:
    void add_line(const std::vector<std::string>& fields);
    const std::string& text() const { return text_; }

private:
    std::string text_;
};

/// Returns the options of the sweep that differ between groups of results.
std::vector<std::string> axis_names(const std::vector<SweepGroup>& groups);

/// Returns the table cells that tell groups apart: the scene, then a value for each axis.
std::vector<std::string> group_fields(const SweepGroup& group,
                                      const std::vector<std::string>& axes);

/// Returns the first line of a table: scene, axes, then `names`.
std::vector<std::string> make_header(const std::vector<std::string>& axes,
                                     std::initializer_list<const char*> names);

} // namespace catoptric::cli
