#pragma once

#include "setting.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace catoptric {

/// How one mirror was drawn.
struct PlanEntry {
    std::uint32_t mirror = 0; ///< its number, from 1
    std::string name, technique;
    std::vector<Setting> settings; ///< all knobs
    std::string why;               ///< what decided so
};

} // namespace catoptric
