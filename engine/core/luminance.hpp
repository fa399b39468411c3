#pragma once

#include "core/math.hpp"

namespace catoptric {

/// Returns the luminance of linear RGB by Rec. 709.
inline double luminance(const dvec3& colour) {
    return .2126 * colour.x + .7152 * colour.y + .0722 * colour.z;
}

} // namespace catoptric
