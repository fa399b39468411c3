#include "session/scene_facts.hpp"

#include "bvh/closest_hit.hpp"
#include "render/views.hpp"
#include "scene/built_in.hpp"
#include "scene/hash.hpp"
#include "scene/light.hpp"
#include "scene/light_kind.hpp"
#include "scene/pose.hpp"
#include "session/coverage.hpp"
#include "session/rays.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>

namespace catoptric::session {

measure::CameraFacts make_camera_facts(const scene::Camera& moving, double seconds) {
    const scene::Camera camera = scene::camera_at(moving, seconds);
    return {camera.name,
            camera.eye,
            camera.target,
            camera.up,
            camera.vertical_fov_degrees,
            camera.orthographic_height};
}

uvec2 thumbnail_size(uvec2 size) {
    constexpr double kMaxThumbnailSide = 128;
    const double longest = std::max(size.x, size.y);
    const auto side = [&](std::uint32_t pixels) {
        return static_cast<std::uint32_t>(
            std::max(1L, std::lround(kMaxThumbnailSide * pixels / longest)));
    };
    return {side(size.x), side(size.y)};
}

std::vector<int> find_visible_objects(const Request& request, uvec2 size) {
    const scene::SceneAtTime at_time(request.scene, request.time);
    const scene::Scene& now = *at_time;
    const render::SceneUnits space = render::make_scene_units(request.scene);
    const render::FrameGeometry geometry = render::make_geometry(now, space);
    const shared::View view = render::make_camera_view(
        scene::camera_at(request.camera, request.time), space, size, 0);
    // With more tests than this, building a BVH would be faster.
    const std::uint64_t most_tests = std::max<std::uint64_t>(std::uint64_t{1} << 24,
                                                             16 * (geometry.indices.size() / 3));
    if (auto covering = find_first_objects(geometry, view, size, most_tests)) return *covering;
    const bvh::Bvh hierarchy = build_bvh_without(geometry, geometry.ranges.size());
    std::vector<int> seen;
    for (std::size_t pixel = 0; pixel < std::size_t{size.x} * size.y; ++pixel) {
        const auto hit = bvh::find_closest_hit<float>(
            hierarchy, make_camera_ray(view, size, pixel), std::numeric_limits<float>::max(),
            bvh::kHiddenFromCameraFlag | bvh::kOneSidedFlag);
        seen.push_back(hit ? static_cast<int>(hit->object) : -1);
    }
    return seen;
}

double pixel_share(const std::vector<int>& seen, const scene::Scene& scene,
                   const std::vector<std::size_t>& materials) {
    std::vector<bool> counts(scene.materials.size());
    for (const std::size_t material : materials) counts[material] = true;
    const auto shows = [&](int object) {
        return object >= 0 && counts[scene.objects[static_cast<std::size_t>(object)].material];
    };
    return static_cast<double>(std::ranges::count_if(seen, shows)) /
           static_cast<double>(std::max<std::size_t>(1, seen.size()));
}

std::vector<measure::UnsupportedFeatureFacts> unsupported_features(const scene::Scene& scene,
                                                                   const std::vector<int>& seen) {
    std::vector<measure::UnsupportedFeatureFacts> facts;
    for (const scene::UnsupportedFeature& gap : scene.unsupported) {
        facts.push_back({gap.id, gap.count, gap.first, {}});
        if (!gap.materials.empty())
            facts.back().pixel_share = pixel_share(seen, scene, gap.materials);
    }
    // Features without a share (-1) come last. Equal shares keep their order.
    std::ranges::stable_sort(
        facts, std::greater<>(),
        [](const measure::UnsupportedFeatureFacts& gap) { return gap.pixel_share.value_or(-1); });
    return facts;
}

std::vector<measure::LightFacts> light_facts(const scene::Scene& scene) {
    const std::vector<scene::PointLight> lights = scene::list_lights(scene);
    const std::size_t first_without = lights.size() - scene.punctual.size();
    std::vector<measure::LightFacts> facts;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const scene::PointLight& light = lights[i];
        measure::LightFacts one{.kind = "mesh",
                                .name = "",
                                .position = light.position,
                                .direction = light.normal,
                                .emission = dvec3(light.emission),
                                .area = light.area};
        if (i >= first_without) {
            const scene::PunctualLight& punctual = scene.punctual[i - first_without];
            one.kind = scene::find_light_kind(punctual.kind).name,
            one.is_parallel = light.directional;
            one.name = punctual.name, one.direction = light.axis, one.area = 0;
        }
        facts.push_back(one);
    }
    return facts;
}

std::optional<measure::EnvironmentFacts> make_environment_facts(const scene::Scene& scene) {
    if (!scene.environment) return std::nullopt;
    return measure::EnvironmentFacts{scene.environment->name, scene.environment->scale,
                                     scene.environment->rotation_degrees};
}

measure::SceneFacts make_scene_facts(const Request& request, const std::vector<int>& seen) {
    const scene::Scene& scene = request.scene;
    measure::SceneFacts facts{scene.name,
                              scene::triangle_count(scene),
                              scene::mirrors(scene).size(),
                              scene::hash_scene(scene),
                              scene::hash_scene(scene) == scene::hash_scene(scene::make_cornell()),
                              make_camera_facts(request.camera, request.time)};
    facts.contents = std::make_shared<measure::SceneContents>(measure::SceneContents{
        light_facts(scene), make_environment_facts(scene), unsupported_features(scene, seen)});
    return facts;
}

measure::SceneFacts make_scene_facts(const Request& request) {
    const bool has_shares = std::ranges::any_of(
        request.scene.unsupported,
        [](const scene::UnsupportedFeature& gap) { return !gap.materials.empty(); });
    return make_scene_facts(request,
                            has_shares ? find_visible_objects(request, thumbnail_size(request.size))
                                       : std::vector<int>());
}

} // namespace catoptric::session
