#pragma once

#include "core/frame_facts.hpp"
#include "reflect/technique.hpp"

#include <string>
#include <vector>

namespace catoptric::session {

/// Returns all knobs of a technique, with their values.
std::vector<Setting> knob_settings(const reflect::TechniqueChoice& choice);

} // namespace catoptric::session
