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
enum class WorkKind : std::uint8_t {
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

struct WorkKindInfo {
    std::string_view name; ///< plural noun, as in JSON
    std::string_view help; ///< what one unit is
};
inline constexpr WorkKindInfo kWorkKinds[] = {
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
inline constexpr std::size_t kWorkKindCount = std::size(kWorkKinds);
static_assert(static_cast<std::size_t>(WorkKind::bytes) + 1 == kWorkKindCount);
static_assert(static_cast<std::size_t>(WorkKind::lights) + 1 == shared::kShaderWorkKindCount);

/// Counts by kind. A kind that the device cannot count has no value.
struct WorkCounts {
    std::array<std::optional<std::uint64_t>, kWorkKindCount> values{};

    std::optional<std::uint64_t>& operator[](WorkKind kind) {
        return values[static_cast<std::size_t>(kind)];
    }
    const std::optional<std::uint64_t>& operator[](WorkKind kind) const {
        return values[static_cast<std::size_t>(kind)];
    }
    void add(WorkKind kind, std::uint64_t count) {
        std::optional<std::uint64_t>& value = (*this)[kind];
        value = value.value_or(0) + count;
    }
    WorkCounts& operator+=(const WorkCounts& other) {
        for (std::size_t i = 0; i < kWorkKindCount; ++i)
            if (other.values[i]) values[i] = values[i].value_or(0) + *other.values[i];
        return *this;
    }
    bool operator==(const WorkCounts&) const = default;
};

struct PassWork {
    std::string name;
    WorkCounts counts;
    bool operator==(const PassWork&) const = default;
};

/// Returns the sum over all passes whose name begins with `prefix`.
inline WorkCounts sum_work(const std::vector<PassWork>& passes, std::string_view prefix = {}) {
    WorkCounts sum;
    for (const PassWork& pass : passes)
        if (pass.name.starts_with(prefix)) sum += pass.counts;
    return sum;
}

} // namespace catoptric
