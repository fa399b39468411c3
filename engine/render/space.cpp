#include "render/space.hpp"

#include <algorithm>
#include <cmath>

namespace catoptric::render {

Space space_of(const scene::Scene& scene) {
    const Bounds<double> bounds = scene::bounds(scene);
    if (bounds.empty()) return {};
    const dvec3 extent = bounds.extent();
    const double largest = std::max({extent.x, extent.y, extent.z});
    Space space;
    space.centre_world = bounds.centre();
    if (largest > 0) space.scale = std::exp2(-std::ceil(std::log2(largest)));
    return space;
}

} // namespace catoptric::render
