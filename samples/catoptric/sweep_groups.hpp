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
std::vector<SweepGroup> group_results(const std::filesystem::path& folder, const SweepPlan& plan);

/// Mean, median and largest of some values, and the 95 % interval of the median.
struct SweepSummary {
    std::size_t count = 0;
    double mean = NAN, median = NAN, least = NAN, largest = NAN;
    measure::Interval ci95; ///< unknown for fewer values than measure::kMinIntervalSamples
};

/// Returns the summary of all values that are not NaN.
SweepSummary summarise(std::vector<double> values);

/// A table as a CSV file by RFC 4180.
class CsvTable {
public:
    void add_line(const std::vector<std::string>& fields);
    const std::string& text() const { return text_; }

private:
    std::string text_;
};

/// Returns the options of the sweep that differ between groups of results.
std::vector<std::string> list_axis_names(const std::vector<SweepGroup>& groups);

/// Returns the table cells that tell groups apart: the scene, then a value for each axis.
std::vector<std::string> make_scene_and_axis_fields(const SweepGroup& group,
                                                    const std::vector<std::string>& axes);

/// Returns the first line of a table: scene, axes, then `names`.
std::vector<std::string> make_header(const std::vector<std::string>& axes,
                                     std::initializer_list<const char*> names);

} // namespace catoptric::cli
