#include "scene/capture_centre.hpp"

#include "scene/topology.hpp"
#include "scene/transform.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace catoptric::scene {

namespace {

bool contains(const Bounds<double>& outer, const dvec3& point) {
    return all(lessThan(outer.lo, point)) && all(lessThan(point, outer.hi));
}

/// Returns whether the object's mesh winds around a point of the world.
bool encloses(const Scene& scene, const Object& object, const dvec3& point) {
    constexpr double kMinInsideWinding = .75;
    if (!contains(bounds(scene, object), point)) return false;
    const Mesh& mesh = scene.meshes[object.mesh];
    const dvec3 at = transform_point(glm::inverse(object.world_from_object), point);
    return std::abs(winding_number(mesh.positions, mesh.triangles, at)) > kMinInsideWinding;
}

} // namespace

std::vector<std::size_t> objects_within(std::span<const Bounds<double>> bounds,
                                        std::size_t object) {
    std::vector<std::size_t> within;
    const Bounds<double>& outer = bounds[object];
    for (std::size_t i = 0; i < bounds.size(); ++i)
        if (i != object && !bounds[i].empty() && all(lessThan(bounds[i].lo, outer.hi)) &&
            all(lessThan(outer.lo, bounds[i].hi)) &&
            !(all(lessThanEqual(bounds[i].lo, outer.lo)) &&
              all(greaterThanEqual(bounds[i].hi, outer.hi))))
            within.push_back(i);
    return within;
}

dvec3 capture_centre(const Scene& scene, std::size_t mirror, std::span<const std::size_t> within) {
    const Bounds<double> box = bounds(scene, scene.objects[mirror]);
    const auto is_enclosed = [&](const dvec3& place) {
        return std::ranges::any_of(
            within, [&](std::size_t i) { return encloses(scene, scene.objects[i], place); });
    };
    if (within.empty() || !is_enclosed(box.centre())) return box.centre();
    // Viewers are more often before and beside a thing than below it.
    constexpr std::array<std::array<int, 3>, 14> kSides{{{0, 0, 1},
                                                         {1, 0, 0},
                                                         {-1, 0, 0},
                                                         {0, 0, -1},
                                                         {0, 1, 0},
                                                         {0, -1, 0},
                                                         {1, 1, 1},
                                                         {-1, 1, 1},
                                                         {1, 1, -1},
                                                         {-1, 1, -1},
                                                         {1, -1, 1},
                                                         {-1, -1, 1},
                                                         {1, -1, -1},
                                                         {-1, -1, -1}}};
    constexpr int kSteps = 16;
    const auto place_at = [&](const std::array<int, 3>& side, double step) {
        return box.centre() +
               dvec3(side[0], side[1], side[2]) * box.extent() * (.5 * step / kSteps);
    };
    for (int first = 1; first < kSteps; ++first)
        for (const std::array<int, 3>& side : kSides) {
            int end = first;
            while (end < kSteps && !is_enclosed(place_at(side, end))) ++end;
            if (end > first) return place_at(side, (first + end) / 2.);
        }
    return box.centre();
}

std::vector<dvec3> capture_centres(const Scene& scene) {
    std::vector<Bounds<double>> of_objects;
    for (const Object& object : scene.objects) of_objects.push_back(bounds(scene, object));
    std::vector<dvec3> centres;
    for (const std::size_t mirror : mirrors(scene))
        centres.push_back(capture_centre(scene, mirror, objects_within(of_objects, mirror)));
    return centres;
}

} // namespace catoptric::scene
