#pragma once

#include "report/comparison.hpp"

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

// Functions that compare a comparison with the report.json of an earlier one. A build pipeline uses
// the result to stop after a loss of quality or speed.
namespace catoptric::report {

struct BaselineLimits {
    double max_flip_rise = .02;  ///< largest rise of a row's FLIP, as a share of the earlier FLIP
    double max_time_ratio = 1.1; ///< largest time of a row or pass, divided by the earlier time
};

enum class BaselineVerdict : std::uint8_t {
    kept,     ///< within the limit
    worse,    ///< the row is above the limit, with 95 % confidence where times are compared
    unknown,  ///< cannot be told from these measurements
    missing,  ///< the comparison lacks this row of the baseline
    replaced, ///< as `missing`, but a new row of the same technique and model errs no more
    added,    ///< the baseline lacks this row, so nothing of it is judged
};
const char* verdict_name(BaselineVerdict verdict);

/// The verdict on one quantity of one row, with its earlier and its present value.
struct BaselineFinding {
    std::string row;      ///< label, with ", model=required" if the row has that model
    std::string quantity; ///< "flip", "ms", "ms of NAME" for a pass, "work: KIND", or "row"
    BaselineVerdict verdict = BaselineVerdict::kept;
    double before = std::numeric_limits<double>::quiet_NaN(), now = before;
    std::string says; ///< a sentence without the row's name
};
/// Returns whether the finding makes the gate fail: `worse` and `missing`.
bool is_failure(const BaselineFinding& finding);

/// Throws `bad_data` if the baseline is no report, is incomplete, has a member of a wrong kind, or
/// shows another scene, camera, instant, size, exposure, ambient light, way of timing or reference.
/// An exposure that is NaN in the comparison is not compared. `json` is a report.json of
/// one scene or of several; `file` names it in messages. The comparison may be unfinished.
void check_baseline(const Comparison& comparison, const std::string& json, const std::string& file);

/// Judges each row of the baseline against the row with the same label and model. A row that only
/// one of them has is said apart. The time by which the comparison judges its rows, and device
/// times of passes with at least a twentieth of their row's time, are `worse` only if the 95 %
/// interval of the ratio of both medians lies above the limit as a whole. Clearing the cube maps is
/// constant work. If its time has risen with confidence, the machine is slower, and all times are
/// divided by the same ratio. Times are `unknown` on another device, if a row was noisy, or if the
/// interval contains the limit. Counted work, if both reports have it, must not grow by more than
/// the same factor. A rise of FLIP below the noise of the reference counts as kept. Throws as
/// check_baseline does.
std::vector<BaselineFinding> judge_comparison(const Comparison& comparison, const std::string& json,
                                              const std::string& file,
                                              const BaselineLimits& limits);

/// Returns one line for each quantity that is worse or unknown, and a last line with the number of
/// each verdict.
std::string format_findings(const std::vector<BaselineFinding>& findings);
/// Returns a Markdown table of the quantities that are worse or unknown, under a heading with the
/// verdict.
std::string to_markdown(const std::vector<BaselineFinding>& findings, const std::string& scene);
/// Returns JUnit XML: a test suite for the scene, with a test case for each quantity. A test case
/// fails if its quantity is worse, and is skipped if the verdict is unknown.
std::string to_junit(const std::vector<BaselineFinding>& findings, const std::string& scene);

} // namespace catoptric::report
