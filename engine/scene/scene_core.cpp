#include "scene/scene_core.hpp"

#include "scene/transform.hpp"

#include <algorithm>
#include <numeric>

namespace catoptric::scene {

namespace {

constexpr double kMinCoreGap = 8; // factor between the core's reach and the nearest object outside
constexpr std::size_t kMaxSampledTriangles = 20'000, kMaxSamplesPerObject = 64;

struct WeightedCorner {
    dvec3 place{0};
    double weight = 0;
    std::size_t object = 0;
};

/// Returns corners of some triangles of every object, spread over its list. The weights of each
/// object's corners add up to 1.
std::vector<WeightedCorner> sample_corners(const Scene& scene) {
    std::vector<WeightedCorner> corners;
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
                corners.push_back(
                    {transform_point(object.world_from_object, mesh.positions[triangle[corner]]),
                     1.0 / (3.0 * static_cast<double>(count)), i});
        }
    }
    return corners;
}

/// Sorts the corners by `number(corner)`. Returns the first index at which half of the weight is
/// reached.
template <typename Number>
std::size_t half_weight_index(std::vector<WeightedCorner>& corners, Number&& number) {
    std::ranges::sort(corners, {}, number);
    const double whole = std::accumulate(
        corners.begin(), corners.end(), 0.0,
        [](double sum, const WeightedCorner& corner) { return sum + corner.weight; });
    double sum = 0;
    std::size_t i = 0;
    // The weights are rounded, so the limit is a millionth below one half.
    while ((sum += corners[i].weight) < whole * (.5 - 1e-6)) ++i;
    return i;
}

dvec3 median_corner(std::vector<WeightedCorner>& corners) {
    dvec3 median;
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t half = half_weight_index(
            corners, [axis](const WeightedCorner& c) { return c.place[axis]; });
        median[axis] = corners[half].place[axis];
    }
    return median;
}

double max_distance(const dvec3& from, const dvec3& to) {
    const dvec3 apart = glm::abs(to - from);
    return std::max({apart.x, apart.y, apart.z});
}

double max_distance(const dvec3& from, const Bounds<double>& box) {
    return std::max(max_distance(from, box.lo), max_distance(from, box.hi));
}

} // namespace

Bounds<double> core_bounds(const Scene& scene) {
    const Bounds<double> everything = bounds(scene);
    std::vector<WeightedCorner> corners = sample_corners(scene);
    if (corners.empty()) return everything;
    const dvec3 middle = median_corner(corners);
    const auto far = [&](const WeightedCorner& corner) {
        return max_distance(middle, corner.place);
    };
    std::size_t last = half_weight_index(corners, far);
    while (last + 1 < corners.size() && far(corners[last + 1]) <= kMinCoreGap * far(corners[last]))
        ++last;
    const double limit = kMinCoreGap * far(corners[last]);
    if (!(limit > 0) || max_distance(middle, everything) <= limit) return everything;

    Bounds<double> core;
    std::vector<bool> whole(scene.objects.size());
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const Bounds<double> box = bounds(scene, scene.objects[i]);
        whole[i] = box.empty() || max_distance(middle, box) <= limit;
        if (whole[i]) core.add(box);
    }
    for (std::size_t i = 0; i <= last; ++i)
        if (!whole[corners[i].object]) core.add(corners[i].place);
    return core;
}

std::vector<std::string> remove_distant_objects(Scene& scene) {
    const Bounds<double> core = core_bounds(scene);
    const dvec3 extent = core.empty() ? dvec3(0) : core.extent();
    const double most = kMaxSceneRadius * std::max({extent.x, extent.y, extent.z});
    std::vector<std::string> names;
    if (!(most > 0)) return names;
    std::erase_if(scene.objects, [&](const Object& object) {
        const Bounds<double> box = bounds(scene, object);
        if (box.empty() || max_distance(core.centre(), box) <= most) return false;
        names.push_back(object.name);
        return true;
    });
    return names;
}

} // namespace catoptric::scene
