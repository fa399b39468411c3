#pragma once

#include "core/format.hpp"
#include "render/space.hpp"

#include <cstddef>
#include <vector>

namespace catoptric::render {

/// The cube captures of all mirrors of a scene, read back to the host. Faces are ordered +X -X +Y
/// -Y +Z -Z; texel (0, 0) is the top left one.
struct CapturedCubes {
    std::uint32_t face = 0; ///< edge in texels
    std::vector<std::byte> colour_bytes, distance_bytes;
    SceneUnits space;

    /// Mirrors count from 0, and `cube_face` is 0 to 5.
    vec3 colour(std::uint32_t mirror, int cube_face, std::uint32_t x, std::uint32_t y) const;
    /// Returns the stored distance, decoded from `format`: scene units from the centre, or the
    /// fraction of the range for r8_unorm.
    float distance(std::uint32_t mirror, int cube_face, std::uint32_t x, std::uint32_t y,
                   TexelFormat format) const;

private:
    std::size_t index(std::uint32_t mirror, int cube_face, std::uint32_t x, std::uint32_t y) const;
};

} // namespace catoptric::render
