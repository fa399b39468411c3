#pragma once

#include "reflect/plan.hpp"
#include "scene/scene.hpp"

#include <string>

namespace catoptric::app {

/// A plan as a row asks for it: what reflect::parse_plan reads, or "plan:FILE". The file is JSON of
/// at most 16 MiB: a list of rules, or an object with such a list as `plan`, as a report's row has
/// it. A rule is {"mirror": number or pattern, "technique": "name[:knob=value,...]", "settings":
/// {knob: value}}; `name` and `why` of a report are passed over, `settings` may be left out. Throws
/// `missing_input`, `io`, `bad_data` with place, wanted and found, and `usage` as parse_plan does.
reflect::Plan read_plan(const std::string& text);

/// Names of the scene's mirrors, in their order.
std::vector<std::string> mirror_names(const scene::Scene& scene);

} // namespace catoptric::app
