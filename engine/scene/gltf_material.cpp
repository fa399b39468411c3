#include "scene/gltf_model.hpp"
#include "scene/repair.hpp"

#include <numbers>

namespace catoptric::scene::gltf {

namespace {

dvec3 colour(const std::vector<double>& factor) { return {factor[0], factor[1], factor[2]}; }

double emissive_strength(const tinygltf::Material& material) {
    const auto at = material.extensions.find(std::string(kEmissiveStrength));
    const bool is_given = at != material.extensions.end() && at->second.Has("emissiveStrength");
    return is_given ? at->second.Get("emissiveStrength").GetNumberAsDouble() : 1;
}

Material material_of(const tinygltf::Material& from, const std::string& label,
                     const Context& context) {
    Material material{.name = from.name};
    const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
    material.mirror = pbr.metallicFactor == 1 && pbr.roughnessFactor == 0;
    if (!material.mirror && !(pbr.metallicFactor == 0 && pbr.roughnessFactor == 1))
        context.notes.add("materials neither a perfect mirror (metallic 1, roughness 0) nor "
                          "diffuse (metallic 0, roughness 1), drawn as diffuse",
                          label);
    const dvec3 base = glm::clamp(colour(pbr.baseColorFactor), 0.0, 1.0);
    (material.mirror ? material.reflectance : material.albedo) = vec3(base);
    material.emission = vec3(emissive_strength(from) * colour(from.emissiveFactor));
    material.two_sided = from.doubleSided && material.emission != vec3(0);
    check(is_radiance(material.emission), Failure::bad_data, context.document.file, ": ", label,
          ": wanted an emission of at least 0 that fits a float, found another");
    return material;
}

} // namespace

std::vector<Material> read_materials(const Context& context) {
    std::vector<Material> materials;
    for (const tinygltf::Material& from : context.document.model.materials)
        materials.push_back(
            material_of(from, label_of("materials", materials.size(), from.name), context));
    return materials;
}

std::vector<std::optional<Camera>> read_cameras(const Document& document) {
    std::vector<std::optional<Camera>> cameras;
    for (const tinygltf::Camera& from : document.model.cameras) {
        cameras.emplace_back();
        if (from.type == "orthographic") continue;
        const double fov = from.perspective.yfov;
        check(fov > 0 && fov < std::numbers::pi, Failure::bad_data, document.file, ": ",
              label_of("cameras", cameras.size() - 1, from.name),
              ": perspective: yfov: wanted an angle between 0 and pi, found ", fov);
        cameras.back() = Camera{.name = from.name, .vertical_fov_degrees = glm::degrees(fov)};
    }
    return cameras;
}

} // namespace catoptric::scene::gltf
