#pragma once

#include "measure/comparison.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// What `stress` found: one row for each property of rendering at the extremes.
namespace catoptric::measure {

/// unsupported: not judged, since the device does not allow what it needs; the remark says which.
enum class Verdict { pass, fail, quality_warning, unsupported, waived };
std::string name_of(Verdict verdict);

/// What of a property could not be run, and why: it has no figure.
struct NotRun {
    std::string what, why;
};

/// One figure of a property; holds when `measured` is a number and at most `limit`.
struct StressCase {
    std::string what;
    double measured = 0;
    double limit = 0;
    bool is_quality = false; ///< beyond its limit it looks worse but is not wrong
    bool holds() const { return measured <= limit; }
};

struct StressPicture {
    std::string name; ///< fit for a file
    int width = 0, height = 0;
    std::string png; ///< the picture as shown, encoded once
};

struct StressRow {
    std::string id, stimulus, property;
    Verdict verdict = Verdict::pass;
    std::string remark; ///< why not, where it was not judged; else what is not covered, or empty
    std::vector<StressCase> cases;       ///< none where it was not judged
    std::vector<StressPicture> pictures; ///< of cases that do not hold
    double seconds = 0;
    std::vector<NotRun> not_run;
    std::string turned_red_by; ///< rule of tests/mutations for wrong code that it must notice
    /// The case nearest to or furthest beyond its limit, one that is wrong before all that look
    /// worse; null when there is none.
    const StressCase* worst() const;
};

struct Stress {
    std::string version, commit;
    std::vector<std::string> command;
    bool complete = true;         ///< false: the rows so far, of a run that goes on or was stopped
    std::size_t asked = 0;        ///< rows that it is to have
    std::optional<Error> stopped; ///< what ended it early
    DeviceFacts device;
    int width = 0, height = 0;
    std::uint64_t seed = 1;
    std::vector<StressRow> rows;
    bool failed() const; ///< some row did
    /// "C9: why" for each row, and "L2, what: why" for each part of one, that could not be run.
    std::vector<std::string> not_run() const;
};

} // namespace catoptric::measure
