#pragma once

#include "report/comparison.hpp"

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

// Compares a comparison with the report.json of an earlier one, for a pipeline that must stop at a
// loss of quality or speed.
namespace catoptric::report {

struct BaselineLimits {
    double max_flip_rise = .02;  ///< largest rise of a row's FLIP, as a share of the earlier FLIP
    double max_time_ratio = 1.1; ///< largest time of a row or pass, divided by the earlier time
};

enum class BaselineVerdict : std::uint8_t {
    kept,    ///< within the limit
    worse,   ///< above the limit, with 95 % confidence where times are compared
    unknown, ///< cannot be told from these measurements
};
/// Returns "kept", "worse" or "unknown".
const char* baseline_verdict_name(BaselineVerdict verdict);

/// One quantity of one row, then and now.
struct BaselineFinding {
    std::string row;      ///< label, with ", model=required" if the row has that model
    std::string quantity; ///< "flip", "ms", "ms of NAME" for a pass, "work: KIND", or "row"
    BaselineVerdict verdict = BaselineVerdict::kept;
    double before = std::numeric_limits<double>::quiet_NaN(), now = before;
    std::string says; ///< a sentence without the row's name
};

/// Throws `bad_data` if the baseline is no report, is incomplete, or shows another scene, camera,
/// instant, size, exposure, ambient light, way of timing or reference. `json` is a report.json of
/// one scene or of several; `file` names it in messages. The comparison may be unfinished.
void check_baseline_matches_comparison(const Comparison& comparison, const std::string& json,
                                       const std::string& file);

/// Judges each row of the baseline against the row with the same label and model. A row that is
/// missing now is worse. Device times of rows, and of passes with at least a twentieth of their
/// row's time, are `worse` only if the ratio of the two 95 % intervals lies above the limit as a
/// whole. If the time to clear the cubes, a constant work, has risen with confidence, that rise is
/// divided out. Times are `unknown` on another device, if a row was noisy, or if the intervals
/// reach over the limit. Counted work, if both reports have it, is held to the same factor. A rise
/// of FLIP below the noise of the reference is kept. Throws as check_baseline_matches_comparison
/// does.
std::vector<BaselineFinding> judge_comparison_against_baseline(const Comparison& comparison,
                                                               const std::string& json,
                                                               const std::string& file,
                                                               const BaselineLimits& limits);

/// Returns one line for each finding that is not kept, and a last line with the numbers of all.
std::string format_baseline_findings(const std::vector<BaselineFinding>& findings);
/// Returns a Markdown table of the findings that are not kept, under a heading with the verdict.
std::string make_baseline_markdown(const std::vector<BaselineFinding>& findings,
                                   const std::string& scene);
/// Returns JUnit XML: a test suite of the scene with a test case for each finding. `worse` is a
/// failure, and `unknown` is skipped.
std::string make_baseline_junit(const std::vector<BaselineFinding>& findings,
                                const std::string& scene);

} // namespace catoptric::report
