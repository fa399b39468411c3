#pragma once

#include "state.hpp"
#include "viewer.hpp"

namespace catoptric::view {

/// What panels show beside the state.
struct Seen {
    const scene::Scene& scene;
    const Viewer& viewer;
    const std::vector<PlanEntry>& entries; ///< of the plan as it was typed
    double period = 0;                     ///< of the scene's motion, seconds; 0: nothing moves
};

/// What a panel's button asks for.
struct Wants {
    bool copies = false, writes = false, saves_plan = false, cuts = false;
    std::optional<std::size_t> camera; ///< of the scene
};

/// The controls at the right of the window; edits the state. Within Controls::begin and end.
void draw_panels(State& state, const Seen& seen, uvec2 window, Wants& wants);

// Its parts, one file each.
/// `entries`: of the plan as it was typed.
void draw_plan(State& state, const scene::Scene& scene, const std::vector<PlanEntry>& entries);
void draw_times(const Viewer& viewer);
void draw_scene(const Seen& seen, Wants& wants);

} // namespace catoptric::view
