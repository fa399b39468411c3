#include "render/space.hpp"

#include "core/error.hpp"
#include "core/shader_math.hpp"
#include "scene/core.hpp"

#include <algorithm>
#include <cmath>

namespace catoptric::render {

namespace {

double largest(const dvec3& v) { return std::max({v.x, v.y, v.z}); }

/// The bounds of mirrors that would lose half of a float's digits to their distance; may be empty.
Bounds<double> small_mirrors(const scene::Scene& scene, const dvec3& origin) {
    Bounds<double> small;
    for (const std::size_t mirror : scene::mirrors(scene)) {
        const Bounds<double> box = scene::bounds(scene, scene.objects[mirror]);
        if (box.empty()) continue;
        const double distance = largest(
            glm::max(glm::abs(box.lo - origin), glm::abs(box.hi - origin)));
        if (largest(box.extent()) < kSmallPart * distance) small.add(box);
    }
    return small;
}

} // namespace

Space space_of(const scene::Scene& scene) {
    const Bounds<double> core = scene::core_bounds(scene);
    if (core.empty()) return {};
    Space space;
    space.origin_world = core.centre();
    if (const double extent = largest(core.extent()); extent > 0)
        space.scale = std::exp2(-std::ceil(std::log2(extent)));
    const Bounds<double> small = small_mirrors(scene, space.origin_world);
    if (!small.empty()) space.origin_world = small.centre();
    space.core = {space.point(core.lo), space.point(core.hi)};
    return space;
}

void check_reach(const Bounds<float>& box, const std::string& object) {
    const float farthest = f32::largest(max(abs(box.lo), abs(box.hi)));
    // Written so that infinity and NaN are refused too; an empty box is no place.
    check(box.empty() || farthest <= scene::kFarthestReach, Failure::exhausted, "object '", object,
          "': wanted every corner within ", scene::kFarthestReach,
          " sizes of the scene's core, found one at ", farthest,
          "; floats cannot square such a distance");
}

} // namespace catoptric::render
