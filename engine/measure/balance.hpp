#pragma once

#include "measure/costs.hpp"

#include <optional>
#include <string>

namespace catoptric::measure {

/// What a device does well: its costs of a look-up in a capture, of a ray, of a fragment without
/// shading and of a byte of attachments, nanoseconds. NaN: no cost is known.
struct Balance {
    double lookup_ns = 0, ray_ns = 0, fragment_ns = 0, byte_ns = 0;
    /// Whether look-ups and rays are those that a subgroup executes together.
    bool is_of_subgroups = false;

    /// Returns the rays that take as long as one look-up.
    double rays_per_lookup() const { return lookup_ns / ray_ns; }
};

/// Nodes that a ray visits, of which Balance::ray_ns is made if only the cost of nodes is known:
/// mirror rays of the built-in scenes visit 7 to 26.
inline constexpr double kNodesPerRay = 15;
/// Rays that take as long as one look-up, on cards that games run on: by the costs from the
/// literature in docs/costs, with rays in shaders (.004) and by ray-tracing cores (.05), with room.
inline constexpr Interval kGameCardBalance{.001, .1};

/// Returns nothing if the costs of look-ups or of rays are not known. `lanes`: of a subgroup, whose
/// rays count one by one.
std::optional<Balance> find_balance(const DeviceCosts& costs, int lanes = 1);
/// Returns rates per second, and a sentence on whether games run on such devices: "a look-up takes
/// as long as 0.56 rays of 15 nodes: ...".
std::string describe_balance(const Balance& balance);

} // namespace catoptric::measure
