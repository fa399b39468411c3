#pragma once

#include "app/session.hpp"
#include "reflect/plan.hpp"

/// The technique `auto`.
namespace catoptric::app {

/// A plan that is_auto as require::suggest has it for this picture, with a reason for each mirror;
/// any other as it is. `scene`: at rest. Costs what require::suggest does.
reflect::Plan resolve_auto(reflect::Plan plan, const scene::Scene& scene, const FrameSpec& spec);

} // namespace catoptric::app
