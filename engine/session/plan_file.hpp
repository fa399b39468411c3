#pragma once

#include "reflect/plan.hpp"
#include "scene/scene.hpp"

#include <string>

namespace catoptric::session {

/// Reads the plan that a row asks for: text for reflect::parse_plan, or "plan:FILE". The file is
/// JSON of at most 16 MiB: a list of rules, or an object with such a list as `plan`, as a report's
/// row has it. A rule is {"mirror": number or pattern, "technique": "name[:knob=value,...]",
/// "settings": {knob: value}}. `settings` is optional; a report's `name` and `why` are ignored.
/// The single rule {"mirror": "*", "technique": "auto"} is the plan `auto`.
/// Throws `missing_input`, `io` and `bad_data` with the place, the wanted and the found value, and
/// `usage` as parse_plan does.
reflect::TechniquePlan read_plan(const std::string& text);

/// Returns the names of the scene's mirrors, in their order.
std::vector<std::string> mirror_names(const scene::Scene& scene);

} // namespace catoptric::session
