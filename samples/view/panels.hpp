#pragma once

#include "state.hpp"
#include "viewer.hpp"

namespace catoptric::view {

/// Data that panels show in addition to the state.
struct PanelData {
    const scene::Scene& scene;
    const SceneViewer& viewer;
    const std::vector<PlanEntry>& entries; ///< entries of the plan as the user typed it
    double period = 0; ///< period of the scene's motion, seconds; 0: nothing moves
    const study::PlanAudit* audit = nullptr; ///< audit of the shown plan; null: no plan is audited
};

/// Requests from the buttons of the panels.
struct PanelRequests {
    bool copies = false, writes = false, saves_plan = false, cuts = false;
    std::optional<std::size_t> camera; ///< index of a camera in the scene
};

/// Draws the controls at the right of the window and edits the state. Call between
/// ImGuiControls::begin and end.
void draw_panels(ViewState& state, const PanelData& data, uvec2 window, PanelRequests& requests);

// Parts of draw_panels, one file each.
/// `entries` are those of the plan as the user typed it. `scene` is the scene without changes of
/// roughness.
void draw_plan_controls(ViewState& state, const scene::Scene& scene,
                        const std::vector<PlanEntry>& entries);
void draw_frame_times(const SceneViewer& viewer);
void draw_scene_facts(const scene::Scene& scene, PanelRequests& requests);

} // namespace catoptric::view
