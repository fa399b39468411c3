#pragma once

#include "app/run.hpp"
#include "app/watcher.hpp"
#include "report/stress.hpp"

namespace catoptric::stress {

struct StressRequest {
    std::vector<std::string> only; ///< ids; empty = every property
    uvec2 size{256, 256};
    std::uint64_t seed = 1; ///< of the scenes, which are made for the run
    std::vector<std::string> command;
    app::Watcher watcher; ///< a property is a row
    /// Called after each with what there is so far, not `complete`; may be empty.
    std::function<void(const report::Stress&)> on_finished_row;
};

/// Judges every property, in minutes at 256x256. An error that a property did not ask for makes its
/// row fail, with the error's text; one that says what the device allows makes it unsupported, with
/// that text and no figure. What ends the run itself (a signal, the device is gone, no
/// memory, `on_finished_row`) is in `stopped` of the rows so far, or thrown where there is none and
/// it was no signal. Throws `usage` for an unknown id.
report::Stress run(app::Engine& engine, const StressRequest& request);

} // namespace catoptric::stress
