#include "session/resolve_auto.hpp"

#include "require/suggest.hpp"
#include "scene/pose.hpp"

#include <utility>

namespace catoptric::session {

reflect::TechniquePlan resolve_auto_plan(reflect::TechniquePlan plan, const scene::Scene& scene,
                                         const FrameSpec& spec, const require::UnitCosts& costs) {
    if (!plan.is_auto) return plan;
    const scene::SceneAtTime at_time(scene, spec.time);
    const scene::Scene& now = *at_time;
    const scene::Camera camera = scene::camera_at(spec.camera, spec.time);
    const require::PlanSuggestion suggestion = require::suggest_plan(
        {.now = now, .camera = camera, .size = spec.size}, costs);
    reflect::TechniquePlan made = reflect::parse_plan(suggestion.plan);
    plan.rules = std::move(made.rules);
    plan.reasons = suggestion.reasons;
    // A plan with the same technique for all mirrors is drawn as this technique, which may draw the
    // whole picture itself and needs no mirror.
    plan.is_technique = made.is_technique;
    return plan;
}

} // namespace catoptric::session
