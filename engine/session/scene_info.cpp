#include "session/scene_info.hpp"

#include "bvh/closest_hit.hpp"
#include "render/views.hpp"
#include "scene/built_in.hpp"
#include "scene/capture_centre.hpp"
#include "scene/classify.hpp"
#include "scene/hash.hpp"
#include "scene/light.hpp"
#include "scene/light_kind.hpp"
#include "scene/material_facts.hpp"
#include "scene/pose.hpp"
#include "session/candidates.hpp"
#include "session/coverage.hpp"
#include "session/rays.hpp"
#include "shared.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <system_error>

namespace catoptric::session {

namespace {

template <typename Item>
std::uint64_t bytes_of(const std::vector<Item>& list) {
    return list.size() * sizeof(Item);
}

std::string classify_material(const scene::Material& material,
                              const scene::SurfaceShares& surface) {
    if (material.mirror) return "mirror";
    if (material.unlit) return "unlit";
    if (scene::is_glass(material)) return "glass";
    if (surface.mirror >= scene::kMinMirrorShare)
        return surface.smoothest > shared::kMaxSharpRoughness ? "rough mirror" : "sharp";
    if (surface.smooth_dielectric >= scene::kMinMirrorShare) return "smooth dielectric";
    if (surface.rough_metal > 0) return "rough metal";
    return surface.rough_dielectric > 0 ? "rough dielectric" : "diffuse";
}

void texture_info(MaterialInfo& info, const char* what,
                  const std::optional<scene::Texture>& texture) {
    if (!texture) return;
    const uvec2 size = texture->image->size;
    info.textures.push_back(std::string(what) + " " + std::to_string(size.x) + "x" +
                            std::to_string(size.y));
}

std::vector<MaterialInfo> material_infos(const scene::Scene& scene) {
    std::vector<MaterialInfo> infos;
    std::map<std::size_t, std::pair<std::size_t, const scene::Object*>> users; // count and first
    for (const scene::Object& object : scene.objects) {
        auto& [count, first] = users[object.material];
        if (count++ == 0) first = &object;
    }
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const auto user = users.find(i);
        if (user == users.end()) continue;
        const auto& [count, first] = user->second;
        const scene::Material& material = scene.materials[i];
        MaterialInfo info{.name = material.name,
                          .kind = classify_material(material, scene::surface_shares(scene, *first)),
                          .objects = count,
                          .albedo = material.albedo};
        std::ranges::transform(
            scene::kMaterialFactors, info.factors.begin(),
            [&](const scene::MaterialFactor& factor) { return material.*factor.member; });
        info.f0 = material.mirror ? material.reflectance
                                  : scene::compute_f0(material, material.albedo, material.metallic);
        info.light = scene::emitted_radiance(material);
        info.glows = scene::is_visibly_emissive(material),
        info.is_masked = scene::has_alpha_mask(material);
        info.is_blended = material.blended;
        info.is_two_sided = !scene::is_one_sided(material);
        texture_info(info, "base colour", material.albedo_texture);
        texture_info(info, "emission", material.emission_texture);
        texture_info(info, "metallic and roughness", material.roughness_texture);
        texture_info(info, "normal", material.normal_texture);
        infos.push_back(std::move(info));
    }
    return infos;
}

std::vector<MirrorInfo> mirror_infos(const scene::Scene& now, const std::vector<int>& seen) {
    std::vector<MirrorInfo> infos;
    const std::vector<dvec3> centres = scene::capture_centres(now);
    for (const std::size_t index : scene::mirrors(now)) {
        const scene::Object& object = now.objects[index];
        const scene::Material& material = now.materials[object.material];
        MirrorInfo info{.number = infos.size() + 1,
                        .name = object.name,
                        .shape = scene::classify_shape(now, object),
                        .capture_centre = centres[infos.size()],
                        .is_constant = material.mirror};
        info.screen_share = static_cast<double>(std::ranges::count(seen, static_cast<int>(index))) /
                            static_cast<double>(std::max<std::size_t>(1, seen.size()));
        if (material.mirror) {
            info.reflectance = material.reflectance;
        } else {
            const scene::SurfaceShares surface = scene::surface_shares(now, object);
            info.reflectance = surface.mirror > 0 ? surface.mirror_f0
                                                  : scene::compute_f0(material, material.albedo,
                                                                      material.metallic);
        }
        infos.push_back(info);
    }
    return infos;
}

void fill_sizes(SceneInfo& info, const scene::Scene& scene) {
    std::set<std::size_t> shown;
    for (const scene::Object& object : scene.objects) {
        info.instances += !shown.insert(object.mesh).second;
        info.object_names.push_back(object.name);
    }
    info.objects = scene.objects.size(), info.meshes = shown.size();
    for (const std::size_t i : shown) {
        const scene::Mesh& mesh = scene.meshes[i];
        info.stored_triangles += mesh.triangles.size();
        info.geometry_bytes += bytes_of(mesh.positions) + bytes_of(mesh.normals) +
                               bytes_of(mesh.triangles) + bytes_of(mesh.uv[0]) +
                               bytes_of(mesh.uv[1]) + bytes_of(mesh.colours);
    }
    std::set<const scene::Image*> images;
    for (const scene::Material& material : scene.materials)
        for (const auto& texture : {material.albedo_texture, material.emission_texture,
                                    material.roughness_texture, material.normal_texture})
            if (texture && images.insert(texture->image.get()).second)
                info.image_bytes += bytes_of(texture->image->texels);
    for (const std::filesystem::path& file : scene.files) {
        std::error_code gone;
        const std::uintmax_t size = std::filesystem::file_size(file, gone);
        if (!gone) info.file_bytes += size;
    }
}

} // namespace

SceneInfo make_scene_info(const Request& request) {
    const scene::Scene& scene = request.scene;
    const std::vector<int> seen = find_visible_objects(request, thumbnail_size(request.size));
    SceneInfo info{.facts = make_scene_facts(request, seen)};
    fill_sizes(info, scene);
    info.materials = material_infos(scene);
    info.mirrors = mirror_infos(*scene::SceneAtTime(scene, request.time), seen);
    if (info.mirrors.empty()) info.mirror_options = suggest_mirror_options(scene);
    for (const scene::Camera& camera : scene.cameras)
        info.cameras.push_back(make_camera_facts(camera, request.time));
    return info;
}

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
