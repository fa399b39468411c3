#pragma once

#include "../core/math.hpp"

#include <string>
#include <vector>

namespace catoptric::scene {

/// Picture around the scene, seen by every ray that leaves the scene: radiance by direction. The
/// picture is equirectangular: row 0 is at +y, the middle column at -z, and +x lies to its right.
/// Lookups are bilinear; they wrap horizontally and clamp at the poles.
struct Environment {
    std::string name; ///< file name; "studio" for the built-in environment, which has no texels
    bool studio = false;
    uvec2 size{0};
    std::vector<vec3> texels; ///< row-major, linear
    double scale = 1;
    double rotation_degrees = 0; ///< moves azimuth A to A + this; azimuth grows from -z to +x
};

} // namespace catoptric::scene
