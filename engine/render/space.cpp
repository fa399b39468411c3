#include "render/space.hpp"

#include "core/error.hpp"
#include "core/shader_math.hpp"
#include "require/content_hashes.hpp"
#include "scene/scene_core.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace catoptric::render {

namespace {

bool is_box_in_core(const Bounds<double>& box, const Bounds<double>& core) {
    return all(lessThanEqual(core.lo, box.lo)) && all(lessThanEqual(box.hi, core.hi));
}

dvec3 choose_origin(const scene::Scene& scene, const Bounds<double>& core) {
    std::vector<Bounds<double>> small;
    Bounds<double> around;
    for (const std::size_t mirror : scene::mirrors(scene)) {
        const Bounds<double> box = scene::bounds(scene, scene.objects[mirror]);
        if (!is_box_in_core(box, core) || !is_small_for_distance(box, core.centre())) continue;
        small.push_back(box), around.add(box);
    }
    const dvec3 theirs = around.centre();
    const bool helps = !small.empty() && std::ranges::none_of(small, [&](const auto& box) {
        return is_small_for_distance(box, theirs);
    });
    return helps ? theirs : core.centre();
}

} // namespace

bool is_small_for_distance(const Bounds<double>& box, const dvec3& origin) {
    if (box.empty()) return false;
    const double size = largest_component(box.extent()),
                 distance = largest_component(
                     glm::max(glm::abs(box.lo - origin), glm::abs(box.hi - origin)));
    return size > 0 && size < require::kSmallObjectRatio * distance;
}

SceneUnits make_scene_units(const scene::Scene& scene) {
    const Bounds<double> core = scene::core_bounds(scene);
    if (core.empty()) return {};
    SceneUnits space;
    space.origin = choose_origin(scene, core);
    if (const double extent = largest_component(core.extent()); extent > 0)
        space.scale = std::exp2(-std::ceil(std::log2(extent)));
    space.core = {space.to_scene_point(core.lo), space.to_scene_point(core.hi)};
    return space;
}

void check_object_distance(const Bounds<float>& box, const std::string& object) {
    const float farthest = f32::largest_vector_component(max(abs(box.lo), abs(box.hi)));
    // The comparison is written so that infinity and NaN fail, too. An empty box has no position
    // and passes.
    check(box.empty() || farthest <= scene::kMaxSceneRadius, Failure::exhausted, "object '", object,
          "': wanted every corner within ", scene::kMaxSceneRadius,
          " sizes of the scene's core, found one at ", farthest,
          "; floats cannot square such a distance");
}

} // namespace catoptric::render
