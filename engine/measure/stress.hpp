#pragma once

#include "measure/comparison.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// Results of `stress`: one row for each property of rendering at the extremes.
namespace catoptric::measure {

/// Verdict on a property. `unsupported` means not judged, because the device does not allow
/// something the property needs; the remark names it.
enum class StressVerdict { pass, fail, quality_warning, unsupported, waived };
std::string verdict_name(StressVerdict verdict);

/// Part of a property that could not be run, and the reason. It has no measured value.
struct SkippedPart {
    std::string what, why;
};

/// One measured value of a property. The case holds if `measured` is a number and at most `limit`.
struct StressCase {
    std::string what;
    double measured = 0;
    double limit = 0;
    bool is_quality = false; ///< whether a picture beyond the limit looks worse but is not wrong
    std::string seen = {};   ///< what a user sees then
    bool is_within_limit() const { return measured <= limit; }
};

struct StressPicture {
    std::string name; ///< name that is valid as a file name
    int width = 0, height = 0;
    std::string png; ///< the picture as displayed, encoded once
};

struct StressRow {
    std::string id, stimulus, property;
    StressVerdict verdict = StressVerdict::pass;
    /// Reason if the property was not judged. Otherwise the part that is not covered, or empty.
    std::string remark;
    std::vector<StressCase> cases;       ///< empty if the property was not judged
    std::vector<StressPicture> pictures; ///< pictures of cases that do not hold
    double seconds = 0;
    std::vector<SkippedPart> not_run;
    /// Rule of tests/mutations: the wrong code that this property must notice.
    std::string turned_red_by;
    /// Returns the case whose measured value is nearest to its limit, or furthest beyond it. Wrong
    /// pictures precede pictures that only look worse. Returns null if the property has no case.
    const StressCase* worst_case() const;
};

struct StressResults {
    std::string version, commit;
    std::vector<std::string> command;
    /// False if the run goes on or was stopped: `rows` are the rows so far.
    bool complete = true;
    std::size_t asked = 0;        ///< number of rows that were asked for
    std::optional<Error> stopped; ///< the error that ended the run early
    DeviceFacts device;
    int width = 0, height = 0;
    std::uint64_t seed = 1;
    std::vector<StressRow> rows;
    bool has_failed_row() const;
    /// Returns "C9: why" for each row, and "L2, what: why" for each part of a row, that could not
    /// be run.
    std::vector<std::string> parts_not_run() const;
};

} // namespace catoptric::measure
