#pragma once

#include "inputs.hpp"
#include "options.hpp"
#include "viewer.hpp"

#include <functional>

namespace catoptric::view {

/// What a test looks at, after each frame.
struct Report {
    std::size_t frame = 0; ///< from 1
    const State& state;
    const Viewer& viewer;
    std::string command; ///< that renders the picture without a window
};

/// Takes the user's place in a test: what it writes comes after what the window says.
struct Driver {
    std::function<void(std::size_t frame, Inputs&, State&, Window&)> before = {};
    std::function<void(const Report&)> after = {};
};

/// The window, from its opening to its end. Returns the exit code; throws as its parts do.
int run(const Options& options, const Driver& driver = {});

/// All of `main`: errors become exit codes. Once a process.
int run_view(int argc, char** argv);

} // namespace catoptric::view
