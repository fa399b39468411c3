#pragma once

#include "core/format.hpp"
#include "render/space.hpp"

#include <cstddef>
#include <vector>

namespace catoptric::render {

/// Cube captures of every mirror of a scene, as numbers. Faces +X -X +Y -Y +Z -Z, texel (0, 0) top
/// left.
struct Captured {
    std::uint32_t face = 0; ///< edge in texels
    std::vector<std::byte> colour_bytes, distance_bytes;
    Space space;

    /// Texel (x, y) of face 0..5 of a mirror from 0.
    vec3 colour(std::uint32_t mirror, int cube_face, std::uint32_t x, std::uint32_t y) const;
    /// As stored in this format: scene units from the centre, or the share of the range for
    /// r8_unorm.
    float distance(std::uint32_t mirror, int cube_face, std::uint32_t x, std::uint32_t y,
                   Format format) const;

private:
    std::size_t index(std::uint32_t mirror, int cube_face, std::uint32_t x, std::uint32_t y) const;
};

} // namespace catoptric::render
