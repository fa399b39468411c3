#pragma once

#include "reflect/plan.hpp"
#include "require/unit_costs.hpp"
#include "session/session.hpp"

/// Resolves the technique `auto`.
namespace catoptric::session {

/// Replaces a plan with `is_auto` by the plan that require::suggest_plan chooses for this
/// picture and unit costs, with a reason for each mirror. Returns any other plan unchanged.
/// `scene`: at rest. Costs what require::suggest_plan does.
reflect::TechniquePlan resolve_auto_plan(reflect::TechniquePlan plan, const scene::Scene& scene,
                                         const FrameSpec& spec, const require::UnitCosts& costs);

} // namespace catoptric::session
