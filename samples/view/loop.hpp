#pragma once

#include "inputs.hpp"
#include "options.hpp"
#include "viewer.hpp"

#include <functional>

namespace catoptric::view {

/// State that a test can inspect after each frame.
struct Report {
    std::size_t frame = 0; ///< number of the frame, from 1
    const State& state;
    const Viewer& viewer;
    std::string command; ///< command that renders the picture without a window
};

/// Simulates the user in a test. `before` may change the inputs after the window has set them.
struct Driver {
    std::function<void(std::size_t frame, Inputs&, State&, Window&)> before = {};
    std::function<void(const Report&)> after = {};
};

/// Runs the window from opening to closing. Returns the exit code. Throws as its parts do.
int run(const ViewOptions& options, const Driver& driver = {});

/// Runs the whole program and turns errors into exit codes. May be called once per process.
int run_view(int argc, char** argv);

} // namespace catoptric::view
