#pragma once

#include "reflect/plan.hpp"
#include "session/session.hpp"

/// Resolves the technique `auto`.
namespace catoptric::app {

/// Replaces a plan with `is_auto` by the plan that require::suggest_technique_plan chooses for this
/// picture, with a reason for each mirror. Returns any other plan unchanged. `scene`: at rest.
/// Costs what require::suggest_technique_plan does.
reflect::TechniquePlan resolve_auto_plan(reflect::TechniquePlan plan, const scene::Scene& scene,
                                         const FrameSpec& spec);

} // namespace catoptric::app
