#pragma once

#include "report/stress.hpp"
#include "session/run.hpp"
#include "session/watcher.hpp"

namespace catoptric::stress {

struct StressRequest {
    std::vector<std::string> only; ///< ids; empty means all properties
    uvec2 size{256, 256};
    std::uint64_t seed = 1; ///< seed of the scenes, which are made for the run
    std::vector<std::string> command;
    session::Watcher watcher; ///< receives progress; a property counts as a row
    /// Called after each property with the results so far, which are not `complete`. May be empty.
    std::function<void(const report::StressResults&)> on_finished_row;
};

/// Judges the properties, in minutes at 256x256. An unexpected error makes its row fail and gives
/// it the error's text. An error that says what the device allows makes the row unsupported, with
/// that text and no measured value. An error that ends the run (a signal, a lost device, no memory,
/// `on_finished_row`) is stored in `stopped` of the rows so far. Without any row such an error is
/// thrown unless it was a signal. Throws `usage` for an unknown id.
report::StressResults run_properties(session::Engine& engine, const StressRequest& request);

} // namespace catoptric::stress
