#pragma once

#include "core/math.hpp"

namespace catoptric {

/// Of linear light, by Rec. 709.
inline double luminance(const dvec3& colour) {
    return .2126 * colour.x + .7152 * colour.y + .0722 * colour.z;
}

} // namespace catoptric
