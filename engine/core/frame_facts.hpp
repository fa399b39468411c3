#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace catoptric {
struct TechniqueTraits; // internal

/// One knob of a technique with its value as text. `number` is empty for a choice and for a special
/// word ("auto").
struct Setting {
    std::string name;
    std::string text; ///< value of the knob as the user types it
    std::optional<double> number;
    bool changed = false; ///< whether it differs from the knob's default
    bool operator==(const Setting&) const = default;
};

/// The technique that drew one mirror, and the rule of the plan that chose the technique.
struct PlanEntry {
    std::uint32_t mirror = 0; ///< number of the mirror, from 1
    std::string name, technique;
    std::vector<Setting> settings; ///< all knobs
    std::string why;
};

/// Work that was left out because the picture does not need it, described for the user.
struct CulledWork {
    std::string what, why, saves;
    double error = 0; ///< largest change of a displayed pixel: always 0, for readers of the JSON
};

/// Cube edges that face=auto chose.
struct AutoFace {
    std::uint32_t edge = 0; ///< edge of each mirror's capture, texels
    /// Entry n-1: edge that mirror n alone needs, texels; 0 if it is not in view.
    std::vector<double> needs;
};

/// Host work for a frame before the device can begin, in milliseconds.
struct HostTimes {
    double update = 0;    ///< scene updates: buffers written, views and lights computed
    double hierarchy = 0; ///< BVHs built or refitted
    double compile = 0;   ///< passes declared, and planned if the graph's shape is new
    double record = 0;    ///< filling the command buffer
    double sum() const { return update + hierarchy + compile + record; }
};

/// Rays of one frame.
struct RayCounts {
    std::uint64_t primary = 0, mirror = 0, shadow = 0;
    std::uint32_t longest_walk = 0; ///< BVH steps of the busiest invocation
};

} // namespace catoptric
