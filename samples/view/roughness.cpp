#include "roughness.hpp"

#include "scene/scene_overrides.hpp"

#include <fmt/format.h>

namespace catoptric::view {

namespace {

const scene::Object& find_mirror_object(const scene::Scene& scene, std::uint32_t mirror) {
    return scene.objects[scene::mirrors(scene)[mirror - 1]];
}

/// Returns the option that gives a material its reflectance and roughness.
scene::MirrorOverride make_mirror_override(const scene::Material& material) {
    if (material.mirror) return {.reflectance = material.reflectance};
    return {.reflectance = material.albedo, .roughness = material.roughness};
}

} // namespace

void separate_materials(scene::Scene& scene) {
    std::vector<std::size_t> uses(scene.materials.size());
    for (const scene::Object& object : scene.objects) ++uses[object.material];
    for (const std::size_t mirror : scene::mirrors(scene)) {
        scene.objects[mirror].mirror = true; // the object is a mirror also as rough metal
        std::size_t& material = scene.objects[mirror].material;
        if (uses[material]-- < 2) continue;
        scene.materials.push_back(scene::Material(scene.materials[material]));
        material = scene.materials.size() - 1;
    }
}

std::optional<float> find_editable_roughness(const scene::Scene& scene, std::uint32_t mirror) {
    const scene::Object& object = find_mirror_object(scene, mirror);
    const scene::Material& material = scene.materials[object.material];
    const scene::MirrorOverride described = make_mirror_override(material);
    if (material != scene::make_mirror_material(material.name, described) ||
        !scene.meshes[object.mesh].colours.empty())
        return std::nullopt;
    return described.roughness;
}

scene::Material change_roughness(const scene::Scene& scene, std::uint32_t mirror, float roughness) {
    const scene::Material& material = scene.materials[find_mirror_object(scene, mirror).material];
    scene::MirrorOverride described = make_mirror_override(material);
    described.roughness = roughness;
    return scene::make_mirror_material(material.name, described);
}

std::vector<std::string> roughness_words(const scene::Scene& scene,
                                         const MirrorRoughness& roughness) {
    std::vector<std::string> words;
    for (const auto& [mirror, value] : roughness) {
        const scene::Object& object = find_mirror_object(scene, mirror);
        const vec3 reflectance = make_mirror_override(scene.materials[object.material]).reflectance;
        std::string pattern = scene::mirror_pattern(object.name);
        if (object.name.find('=') != std::string::npos && pattern.ends_with("=1"))
            pattern.resize(pattern.size() - 2);
        words.insert(words.end(),
                     {"--mirror", fmt::format("{}={},{},{},roughness={}", pattern, reflectance.x,
                                              reflectance.y, reflectance.z, value)});
    }
    return words;
}

} // namespace catoptric::view
