#include "scene/scene_core.hpp"

#include "scene/transform.hpp"

#include <algorithm>
#include <numeric>

namespace catoptric::scene {

namespace {

constexpr double kMinGapAroundCoreFactor =
    8; // factor between the core's reach and the nearest object outside
constexpr std::size_t kMaxSampledTriangles = 20'000, kMaxSamplesPerObject = 64;

struct WeightedMeshCorner {
    dvec3 place{0};
    double weight = 0;
    std::size_t object = 0;
};

/// Returns corners of some triangles of every object, spread over its list. The weights of each
/// object's corners add up to 1.
std::vector<WeightedMeshCorner> sample_triangle_corners(const Scene& scene) {
    std::vector<WeightedMeshCorner> corners;
    const std::size_t share = std::clamp(kMaxSampledTriangles /
                                             std::max<std::size_t>(scene.objects.size(), 1),
                                         std::size_t{1}, kMaxSamplesPerObject);
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const Object& object = scene.objects[i];
        const Mesh& mesh = scene.meshes[object.mesh];
        const std::size_t count = std::min(mesh.triangles.size(), share);
        for (std::size_t k = 0; k < count; ++k) {
            const uvec3& triangle = mesh.triangles[k * mesh.triangles.size() / count];
            for (int corner = 0; corner < 3; ++corner)
                corners.push_back({transform_point_to_world(object.world_from_object,
                                                            mesh.positions[triangle[corner]]),
                                   1.0 / (3.0 * static_cast<double>(count)), i});
        }
    }
    return corners;
}

/// Sorts the corners by `number(corner)`. Returns the first index at which half of the weight is
/// reached.
template <typename Number>
std::size_t find_index_at_half_weight(std::vector<WeightedMeshCorner>& corners, Number&& number) {
    std::ranges::sort(corners, {}, number);
    const double whole = std::accumulate(
        corners.begin(), corners.end(), 0.0,
        [](double sum, const WeightedMeshCorner& corner) { return sum + corner.weight; });
    double sum = 0;
    std::size_t i = 0;
    // The weights are rounded, so the limit is a millionth below one half.
    while ((sum += corners[i].weight) < whole * (.5 - 1e-6)) ++i;
    return i;
}

dvec3 find_median_of_corners(std::vector<WeightedMeshCorner>& corners) {
    dvec3 median;
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t half = find_index_at_half_weight(
            corners, [axis](const WeightedMeshCorner& c) { return c.place[axis]; });
        median[axis] = corners[half].place[axis];
    }
    return median;
}

double max_distance_to_point(const dvec3& from, const dvec3& to) {
    const dvec3 apart = glm::abs(to - from);
    return std::max({apart.x, apart.y, apart.z});
}

double max_distance_to_point(const dvec3& from, const Bounds<double>& box) {
    return std::max(max_distance_to_point(from, box.lo), max_distance_to_point(from, box.hi));
}

} // namespace

Bounds<double> compute_core_bounds(const Scene& scene) {
    const Bounds<double> everything = bounds(scene);
    std::vector<WeightedMeshCorner> corners = sample_triangle_corners(scene);
    if (corners.empty()) return everything;
    const dvec3 middle = find_median_of_corners(corners);
    const auto far = [&](const WeightedMeshCorner& corner) {
        return max_distance_to_point(middle, corner.place);
    };
    std::size_t last = find_index_at_half_weight(corners, far);
    while (last + 1 < corners.size() &&
           far(corners[last + 1]) <= kMinGapAroundCoreFactor * far(corners[last]))
        ++last;
    const double limit = kMinGapAroundCoreFactor * far(corners[last]);
    if (!(limit > 0) || max_distance_to_point(middle, everything) <= limit) return everything;

    Bounds<double> core;
    std::vector<bool> whole(scene.objects.size());
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const Bounds<double> box = bounds(scene, scene.objects[i]);
        whole[i] = box.empty() || max_distance_to_point(middle, box) <= limit;
        if (whole[i]) core.add(box);
    }
    for (std::size_t i = 0; i <= last; ++i)
        if (!whole[corners[i].object]) core.add(corners[i].place);
    return core;
}

std::vector<std::string> remove_distant_objects(Scene& scene) {
    const Bounds<double> core = compute_core_bounds(scene);
    const dvec3 extent = core.empty() ? dvec3(0) : core.extent();
    const double most = kMaxSceneRadius * std::max({extent.x, extent.y, extent.z});
    std::vector<std::string> names;
    if (!(most > 0)) return names;
    std::erase_if(scene.objects, [&](const Object& object) {
        const Bounds<double> box = bounds(scene, object);
        if (box.empty() || max_distance_to_point(core.centre(), box) <= most) return false;
        names.push_back(object.name);
        return true;
    });
    return names;
}

} // namespace catoptric::scene
