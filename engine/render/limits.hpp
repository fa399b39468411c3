#pragma once

#include "scene/scene.hpp"

#include <cstdint>

namespace catoptric::render {

/// The amounts of data that a scene needs. Vertices and triangles count as stored: a mesh shared by
/// several copies counts once (object_space.hpp).
struct SceneAmounts {
    std::uint64_t vertices = 0, triangles = 0, objects = 0, mirrors = 0;
    std::uint64_t environment_texels = 0;
};
/// Costs as much as find_sharing_objects.
SceneAmounts count_amounts(const scene::Scene& scene);

struct GeometryLimits {
    std::uint64_t texels = 0;        ///< most texels of a texel buffer, 16 bytes each
    std::uint64_t storage_bytes = 0; ///< most bytes of a storage buffer that shaders see
    std::uint64_t piece_bytes = 0;   ///< most bytes of one allocation
    std::uint64_t memory_bytes = 0;  ///< bytes of memory in total
};

/// Throws `exhausted` with the amount that the scene needs and the device's limit, before anything
/// is created. Counts the least that a scene needs, so it never refuses a scene that would fit.
void check_limits(const std::string& scene, const SceneAmounts& amounts,
                  const GeometryLimits& limits);

} // namespace catoptric::render
