#pragma once

#include "core/frame_facts.hpp"
#include "reflect/technique.hpp"

#include <string>
#include <vector>

namespace catoptric::app {

/// Returns all knobs of a technique, with their values.
std::vector<Setting> settings_of(const reflect::Choice& choice);

} // namespace catoptric::app
