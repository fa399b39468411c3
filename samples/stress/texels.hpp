#pragma once

#include "core/shader_math.hpp"

#include <cstdint>

namespace catoptric::stress {

/// Calls look(direction, face, x, y) for the centre of each texel of a cube map with faces of
/// `edge` texels. The largest component of the direction is 1.
template <typename Look>
void for_each_texel(std::uint32_t edge, const Look& look) {
    for (int face = 0; face < 6; ++face)
        for (std::uint32_t y = 0; y < edge; ++y)
            for (std::uint32_t x = 0; x < edge; ++x) {
                const double s = (2 * x + 1.0) / edge - 1, t = (2 * y + 1.0) / edge - 1;
                look(f64::cube_direction(face, dvec3(s, t, 1)), face, x, y);
            }
}

} // namespace catoptric::stress
