#pragma once

#include "app/engine.hpp"
#include "report/stress.hpp"

namespace catoptric::stress {

struct StressRequest {
    std::vector<std::string> only; ///< ids; empty = every property
    uvec2 size{256, 256};
    std::uint64_t seed = 1; ///< of the scenes, which are made for the run
    std::vector<std::string> command;
    /// Called before each property with its id, number from 0 and the count; may be empty.
    std::function<void(const std::string&, std::size_t, std::size_t)> on_row;
};

/// Judges every property, in minutes at 256x256. An error that a property did not ask for makes its
/// row fail, with the error's text. After a stop signal the rows so far come back with `complete`
/// false. Throws `usage` for an unknown id.
report::Stress run(app::Engine& engine, const StressRequest& request);

} // namespace catoptric::stress
