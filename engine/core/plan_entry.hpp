#pragma once

#include "setting.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace catoptric {

/// The technique that drew one mirror, and the rule of the plan that chose the technique.
struct PlanEntry {
    std::uint32_t mirror = 0; ///< number of the mirror, from 1
    std::string name, technique;
    std::vector<Setting> settings; ///< all knobs
    std::string why;               ///< the reason for this choice
};

} // namespace catoptric
