#pragma once

#include "scene/scene.hpp"

#include <cstdint>

namespace catoptric::render {

/// How much of everything a scene takes: vertices and triangles as they are stored, so those of a
/// mesh whose copies share them count once (own_space.hpp).
struct Amounts {
    std::uint64_t vertices = 0, triangles = 0, objects = 0, mirrors = 0;
    std::uint64_t environment_texels = 0;
};
/// Costs what shared_objects does.
Amounts amounts_of(const scene::Scene& scene);

/// What a device can hold.
struct Limits {
    std::uint64_t texels = 0;        ///< of a texel buffer, 16 bytes each
    std::uint64_t storage_bytes = 0; ///< of a storage buffer that shaders see
    std::uint64_t piece_bytes = 0;   ///< of one allocation
    std::uint64_t memory_bytes = 0;  ///< in all
};

/// Throws `exhausted` with what the scene wants and what there is, before anything is made. Counts
/// the least that a scene takes, so that nothing is refused that would have gone in.
void check_limits(const std::string& scene, const Amounts& amounts, const Limits& limits);

} // namespace catoptric::render
