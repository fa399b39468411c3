#include "session/scene_info.hpp"

#include "scene/capture_centre.hpp"
#include "scene/classify.hpp"
#include "scene/material_facts.hpp"
#include "scene/pose.hpp"
#include "session/candidates.hpp"
#include "session/scene_facts.hpp"
#include "shared.h"

#include <algorithm>
#include <map>
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

} // namespace catoptric::session
