#pragma once

#include "../core/math.hpp"

#include <string>
#include <vector>

namespace catoptric::scene {

/// What is seen where the scene ends: radiance by direction. Equirectangular, row 0 at +y, the
/// middle along -z, +x to its right; bilinear, wraps across and clamps at the poles.
struct Environment {
    std::string name; ///< of its file; "studio": the built-in one, without texels
    bool studio = false;
    uvec2 size{0};
    std::vector<vec3> texels; ///< row-major, linear
    double scale = 1;
    double rotation_degrees = 0; ///< what is seen at azimuth A moves to A + this, -z towards +x
};

} // namespace catoptric::scene
