#pragma once

#include "core/frame_facts.hpp"

#include <string>
#include <vector>

namespace catoptric::app {

/// A technique with all its settings, as `parse_technique` reads it from "name[:knob=value,...]".
/// For an unknown name, `parse_technique` throws `Failure::usage` with the nearest name.
struct TechniqueChoice {
    std::string technique, label, file_name;
    std::vector<Setting> settings; ///< values of all knobs
};
TechniqueChoice parse_technique(const std::string& text);

} // namespace catoptric::app
