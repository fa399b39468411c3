#pragma once

#include "inputs.hpp"
#include "options.hpp"
#include "viewer.hpp"

#include <functional>

namespace catoptric::view {

/// State that a test can inspect after each frame.
struct ViewReport {
    std::size_t frame = 0; ///< number of the frame, from 1
    const ViewState& state;
    const SceneViewer& viewer;
    std::string command; ///< command that renders the picture without a window
};

/// Simulates the user in a test. `before` may change the inputs after the window has set them.
struct SimulatedUser {
    std::function<void(std::size_t frame, UserInput&, ViewState&, ViewWindow&)> before = {};
    std::function<void(const ViewReport&)> after = {};
};

/// Runs the window from opening to closing. Returns the exit code. Throws as its parts do.
int run_window(const ViewOptions& options, const SimulatedUser& driver = {});

/// Runs the whole program and turns errors into exit codes. May be called once per process.
int run_program(int argc, char** argv);

} // namespace catoptric::view
