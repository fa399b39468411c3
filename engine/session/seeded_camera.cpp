#include "session/seeded_camera.hpp"

#include "bvh/closest_hit.hpp"
#include "core/error.hpp"
#include "render/views.hpp"
#include "session/rays.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <random>

namespace catoptric::session {

namespace {

constexpr int kMaxAttempts = 1000;
constexpr uvec2 kRayGridSize{32, 32}; // rays through the picture
// Least number of the grid's 1024 rays that meet a target.
constexpr std::size_t kMinTargetRays = 11;
constexpr double kMaxUpComponent = .99; // component of the view's direction along the up axis
constexpr double kMinTargetDistance = 1.5, kMinFovDegrees = 25, kMaxFovDegrees = 60;

/// Returns a uniform number in [low, high). Distributions of standard libraries differ from each
/// other.
double draw_number(std::mt19937_64& random, double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
}

dvec3 draw_direction(std::mt19937_64& random) {
    const double y = draw_number(random, -1, 1),
                 turn = draw_number(random, 0, 2 * std::numbers::pi), r = std::sqrt(1 - y * y);
    return {r * std::cos(turn), y, r * std::sin(turn)};
}

/// Appends a number to `text` with `decimals` decimals, and returns the number that this text
/// stands for.
double append_rounded(double value, int decimals, std::string& text) {
    std::array<char, 400> digits; // the longest double has 309 before the point
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                   std::chars_format::fixed, decimals)
                         .ptr;
    text.append(digits.data(), end);
    std::from_chars(digits.data(), end, value);
    return value;
}

dvec3 append_rounded(const dvec3& point, int decimals, std::string& text) {
    dvec3 result;
    for (int axis = 0; axis < 3; ++axis) {
        if (axis > 0) text += ',';
        result[axis] = append_rounded(point[axis], decimals, text);
    }
    return result;
}

/// Returns the objects that a camera may aim at: the scene's mirrors, or all objects.
std::vector<std::size_t> camera_targets(const scene::Scene& now) {
    std::vector<std::size_t> aims = scene::mirrors(now);
    if (aims.empty())
        for (std::size_t i = 0; i < now.objects.size(); ++i) aims.push_back(i);
    std::erase_if(aims, [&](std::size_t i) {
        const Bounds<double> bounds = scene::bounds(now, now.objects[i]);
        return !now.objects[i].seen_by_camera || bounds.empty() ||
               !(glm::length(bounds.extent()) > 0);
    });
    return aims;
}

scene::Camera draw_random_camera(std::mt19937_64& random, const Bounds<double>& aim,
                                 const Bounds<double>& everything) {
    const double nearest = kMinTargetDistance * glm::length(aim.extent()) / 2,
                 farthest = std::max(glm::length(everything.extent()), nearest);
    scene::Camera camera;
    for (int axis = 0; axis < 3; ++axis)
        camera.target[axis] = draw_number(random, aim.lo[axis], aim.hi[axis]);
    const double distance = nearest * std::pow(farthest / nearest, draw_number(random, 0, 1));
    camera.eye = camera.target + distance * draw_direction(random);
    const int decimals = std::clamp(
        3 - static_cast<int>(std::floor(std::log10(glm::length(everything.extent())))), 0, 300);
    camera.eye = append_rounded(camera.eye, decimals, camera.name);
    camera.name += ':';
    camera.target = append_rounded(camera.target, decimals, camera.name);
    camera.name += ':';
    camera.vertical_fov_degrees = append_rounded(
        draw_number(random, kMinFovDegrees, kMaxFovDegrees), 1, camera.name);
    return camera;
}

/// Counts the rays of the grid that first meet the front of one of the aims.
std::size_t count_target_rays(const render::FrameGeometry& geometry, const bvh::Bvh& hierarchy,
                              const shared::View& view, const std::vector<std::size_t>& aims) {
    std::size_t seen = 0;
    for (std::size_t pixel = 0; pixel < std::size_t{kRayGridSize.x} * kRayGridSize.y; ++pixel) {
        const f32::Ray ray = make_camera_ray(view, kRayGridSize, pixel);
        const auto hit = bvh::find_closest_hit<float>(
            hierarchy, ray, std::numeric_limits<float>::max(),
            bvh::kHiddenFromCameraFlag | bvh::kOneSidedFlag);
        if (!hit || !std::ranges::binary_search(aims, std::size_t{hit->object})) continue;
        const auto normal = [&](std::uint32_t j) {
            return geometry.vertices[geometry.indices[3 * hit->triangle + j]].normal;
        };
        seen += dot(normal(0) + normal(1) + normal(2), ray.direction) < 0;
    }
    return seen;
}

/// A scene at an instant, prepared for rays.
struct Stage {
    explicit Stage(const scene::Scene& scene, double seconds)
        : now(scene::scene_at(scene, seconds)), space(render::make_scene_units(scene)),
          geometry(render::make_geometry(now, space)),
          hierarchy(build_bvh_without(geometry, geometry.ranges.size())),
          aims(camera_targets(now)) {}

    bool sees_target(const scene::Camera& camera) const {
        return count_target_rays(geometry, hierarchy,
                                 render::make_camera_view(camera, space, kRayGridSize, 0),
                                 aims) >= kMinTargetRays;
    }

    scene::Scene now;
    render::SceneUnits space;
    render::FrameGeometry geometry;
    bvh::Bvh hierarchy;
    std::vector<std::size_t> aims;
};

scene::Camera draw_camera(const Stage& stage, std::uint64_t seed) {
    const Bounds<double> everything = scene::bounds(stage.now);
    std::mt19937_64 random(seed);
    for (int i = 0; i < kMaxAttempts && !stage.aims.empty(); ++i) {
        const scene::Object& aim = stage.now.objects[stage.aims[random() % stage.aims.size()]];
        scene::Camera camera = draw_random_camera(random, scene::bounds(stage.now, aim),
                                                  everything);
        const dvec3 along = camera.target - camera.eye;
        if (!(std::abs(along.y) <= kMaxUpComponent * glm::length(along)) || along == dvec3(0))
            continue;
        if (stage.sees_target(camera)) return camera;
    }
    fail(Failure::usage, "seeded camera: wanted one that sees a mirror of '", stage.now.name,
         "', found none in ", kMaxAttempts, " draws from seed ", seed);
}

} // namespace

std::vector<scene::Camera> make_seeded_cameras(const scene::Scene& scene, double seconds,
                                               std::span<const std::uint64_t> seeds) {
    const Stage stage(scene, seconds);
    std::vector<scene::Camera> cameras;
    for (const std::uint64_t seed : seeds) cameras.push_back(draw_camera(stage, seed));
    return cameras;
}

scene::Camera make_seeded_camera(const scene::Scene& scene, double seconds, std::uint64_t seed) {
    return make_seeded_cameras(scene, seconds, std::span(&seed, 1)).front();
}

} // namespace catoptric::session
