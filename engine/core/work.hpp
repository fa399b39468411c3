#pragma once

#include "shared.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Counted work of a frame. Unlike times, counts repeat to the last digit on the same device, and a
/// count times the cost of its unit predicts the time on another device (measure/costs.hpp).
namespace catoptric {

/// Kinds of work. The first kinds are counted by shaders, in the order of shared::kWork....
enum class CountedWorkKind : std::uint8_t {
    camera_rays,
    mirror_rays,
    shadow_rays,
    nodes,
    triangles,
    node_lanes,
    triangle_lanes,
    shadow_lookups,
    colour_lookups,
    distance_lookups,
    colour_lanes,
    distance_lanes,
    search_lanes,
    texture_lookups,
    materials,
    lights,
    vertices,
    primitives,
    fragments,
    invocations,
    frames,
    passes,
    draws,
    dispatches,
    bytes,
};

struct CountedWorkKindInfo {
    std::string_view name; ///< plural noun, as in JSON
    std::string_view help; ///< what one unit is
};
inline constexpr CountedWorkKindInfo kCountedWorkKinds[] = {
    {"camera_rays", "rays from the camera that walked through the BVH"},
    {"mirror_rays", "rays that left a mirror"},
    {"shadow_rays", "rays to a light"},
    {"nodes", "nodes of the BVH that rays visited"},
    {"triangles", "triangles and spheres that rays were tested against"},
    {"node_lanes", "node visits that subgroups executed; nodes / node_lanes lanes were live"},
    {"triangle_lanes", "triangle tests that subgroups executed"},
    {"shadow_lookups", "look-ups in shadow maps, of four texels each"},
    {"colour_lookups", "look-ups of colours, objects and normals in captures and mirrored views"},
    {"distance_lookups", "look-ups of distances in captures, and of bounds in a pyramid"},
    {"colour_lanes", "look-ups of colours, objects and normals that subgroups executed"},
    {"distance_lanes", "look-ups of distances that subgroups executed"},
    {"search_lanes", "steps of searches that subgroups executed"},
    {"texture_lookups", "look-ups in textures of materials and in the environment"},
    {"materials",
     "evaluations of a material at a point, in scenes whose materials vary or reflect"},
    {"lights", "evaluations of a light at a point, without its shadow"},
    {"vertices", "invocations of vertex shaders"},
    {"primitives", "triangles that clipping put out"},
    {"fragments", "invocations of fragment shaders, as the device counts them"},
    {"invocations", "invocations of compute shaders"},
    {"frames", "frames: always 1; its cost is what a frame costs that does nothing"},
    {"passes", "passes of the frame"},
    {"draws", "draw commands"},
    {"dispatches", "dispatch commands"},
    {"bytes", "bytes of attachments that passes load, clear and store, and bytes of copies"},
};
inline constexpr std::size_t kCountedWorkKindCount = std::size(kCountedWorkKinds);
static_assert(static_cast<std::size_t>(CountedWorkKind::bytes) + 1 == kCountedWorkKindCount);
static_assert(static_cast<std::size_t>(CountedWorkKind::lights) + 1 ==
              shared::kShaderWorkKindCount);

/// Counts by kind. A kind that the device cannot count has no value.
struct WorkCountsByKind {
    std::array<std::optional<std::uint64_t>, kCountedWorkKindCount> values{};

    std::optional<std::uint64_t>& operator[](CountedWorkKind kind) {
        return values[static_cast<std::size_t>(kind)];
    }
    const std::optional<std::uint64_t>& operator[](CountedWorkKind kind) const {
        return values[static_cast<std::size_t>(kind)];
    }
    void add_count(CountedWorkKind kind, std::uint64_t count) {
        std::optional<std::uint64_t>& value = (*this)[kind];
        value = value.value_or(0) + count;
    }
    /// Adds all counts of `other`.
    WorkCountsByKind& operator+=(const WorkCountsByKind& other) {
        for (std::size_t i = 0; i < kCountedWorkKindCount; ++i)
            if (other.values[i]) values[i] = values[i].value_or(0) + *other.values[i];
        return *this;
    }
    bool operator==(const WorkCountsByKind&) const = default;
};

/// Work of one pass.
struct PassWorkCounts {
    std::string name;
    WorkCountsByKind counts;
    bool operator==(const PassWorkCounts&) const = default;
};

/// Returns the sum over all passes whose name begins with `prefix`.
inline WorkCountsByKind sum_work_counts_of_passes(const std::vector<PassWorkCounts>& passes,
                                                  std::string_view prefix = {}) {
    WorkCountsByKind sum;
    for (const PassWorkCounts& pass : passes)
        if (pass.name.starts_with(prefix)) sum += pass.counts;
    return sum;
}

} // namespace catoptric
