#pragma once

#include "core/frame_facts.hpp"
#include "core/technique_traits.hpp"

#include <string>
#include <vector>

namespace catoptric::session {

/// A technique with all its settings, as `parse_technique` reads it from "name[:knob=value,...]".
/// For an unknown name, `parse_technique` throws `Failure::usage` with the nearest name.
struct ParsedTechnique {
    std::string technique, label, file_name;
    std::vector<Setting> settings;                 ///< values of all knobs
    const TechniqueTraits* of_technique = nullptr; ///< null: a plan
    /// Returns the defaults for a plan.
    const TechniqueTraits& traits() const;
};
ParsedTechnique parse_technique(const std::string& text);

} // namespace catoptric::session
