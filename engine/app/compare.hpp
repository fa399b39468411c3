#pragma once

#include "app/run.hpp"
#include "app/watcher.hpp"
#include "report/comparison.hpp"

namespace catoptric::app {

inline constexpr const char* kReference = "raytrace:depth=16";

struct CompareRequest {
    Request base; ///< its `techniques` are the rows; empty = default_techniques()
    std::string reference = kReference;
    bool together = false; ///< all rows in one frame
    bool causes = false;   ///< split each row's error by cause; only against the default reference
    bool lag = false; ///< also how far rows are behind a moving scene (app/lag.hpp): minutes a row
    std::vector<std::string> command; ///< for the record
    Watcher watcher;
    /// Called after each row, and each row of the lag, with what there is so far, not `complete`;
    /// may be empty.
    std::function<void(const report::Comparison&)> on_finished_row;
};

/// The rows that each technique of the table names for itself (reflect::Technique::compared).
std::vector<std::string> default_techniques();
/// Throws `bad_data`, saying how to make one, where a scene has no mirror.
void check_has_mirror(const scene::Scene& scene);

/// Throws `usage` for rows that are unknown or, with the same settings, asked for twice.
void check_rows(const std::vector<std::string>& techniques);

/// Renders every row and the reference, measures speed and error. A row with `samples` is judged
/// against the reference at as many samples. What ends the run early (a signal, a lost device, no
/// memory, `on_finished_row`) is in `stopped` of the rows so far, or thrown where there is none and
/// it was no signal.
report::Comparison compare(Engine& engine, const CompareRequest& request);

} // namespace catoptric::app
