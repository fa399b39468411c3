#include "import/gltf_check.hpp"
#include "import/gltf_writer.hpp"
#include "import/image_file.hpp"
#include "scene/material_facts.hpp"
#include "scene/number.hpp"

#include <algorithm>
#include <cmath>

namespace catoptric::scene::gltf {

namespace {

using tinygltf::Value;

int filter_code(const Texture& texture) {
    return texture.nearest ? TINYGLTF_TEXTURE_FILTER_NEAREST : TINYGLTF_TEXTURE_FILTER_LINEAR;
}

int wrap_code(Texture::Wrap wrap) {
    if (wrap == Texture::Wrap::clamp) return TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
    return wrap == Texture::Wrap::mirrored ? TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT
                                           : TINYGLTF_TEXTURE_WRAP_REPEAT;
}

/// Returns the value of KHR_texture_transform. The texture's axes must be at right angles.
Value texture_transform(const Texture& texture) {
    const dvec3 u(texture.u_row), v(texture.v_row);
    const double angle = std::atan2(-v.x, u.x), c = std::cos(angle), s = std::sin(angle);
    const double scale_u = c * u.x - s * v.x, scale_v = s * u.y + c * v.y;
    return Value(Value::Object{{"offset", number_list({u.z, v.z})},
                               {"rotation", Value(angle)},
                               {"scale", number_list({scale_u, scale_v})}});
}

/// If the largest component is above 1, that component is written as the strength of
/// KHR_materials_emissive_strength. A largest component of at most 1e-6 needs the extension, too,
/// because tinygltf treats it as black.
void write_emission(Writer& writer, const Material& material, tinygltf::Material& to) {
    const dvec3 emission(material.emission);
    const double largest = std::max({emission.x, emission.y, emission.z});
    if (largest == 0) return;
    const bool is_common = largest <= 1 && largest > 1e-6;
    to.emissiveFactor = to_numbers(is_common ? emission : emission / largest);
    if (material.emission_texture)
        to.emissiveTexture = writer.texture_info(*material.emission_texture);
    if (is_common) return;
    const std::string extension(kEmissiveStrengthExtension);
    to.extensions[extension] = Value(Value::Object{{"emissiveStrength", Value(largest)}});
    writer.use(extension);
}

/// Writes the index of refraction of glass, and F0 and F90 by KHR_materials_specular if they differ
/// from those of a glTF material with this index.
void write_dielectric(Writer& writer, const Material& material, tinygltf::Material& to) {
    const bool has_ior = material.ior != Material().ior;
    if (has_ior) {
        to.extensions["KHR_materials_ior"] = Value(
            Value::Object{{"ior", Value(shortest_double(material.ior))}});
        writer.use("KHR_materials_ior");
    }
    // As in the reader, in double precision.
    const double f0 = has_ior ? f0_from_ior(shortest_double(material.ior)) : .04;
    if (material.dielectric_f0 == vec3(static_cast<float>(f0)) &&
        material.dielectric_f90 == vec3(1))
        return;
    const double strength = material.dielectric_f90.x;
    const dvec3 colour = strength > 0 ? dvec3(material.dielectric_f0) / (f0 * strength) : dvec3(0);
    to.extensions["KHR_materials_specular"] = Value(
        Value::Object{{"specularFactor", Value(strength)},
                      {"specularColorFactor", number_list(to_numbers(colour))}});
    writer.use("KHR_materials_specular");
}

/// Writes the inside of a solid body by KHR_materials_volume.
void write_volume(Writer& writer, const Material& material, tinygltf::Material& to) {
    if (!material.solid) return;
    Value::Object volume{{"thicknessFactor", Value(1.0)}}; // rays find the true thickness
    const dvec3 absorption(material.absorption);
    const double largest = std::max({absorption.x, absorption.y, absorption.z});
    if (largest > 0) {
        volume["attenuationDistance"] = Value(1 / largest);
        volume["attenuationColor"] = number_list(to_numbers(glm::exp(-absorption / largest)));
    }
    to.extensions["KHR_materials_volume"] = Value(std::move(volume));
    writer.use("KHR_materials_volume");
}

/// Writes the factors of extensions that differ from the defaults of Material.
void write_factors(Writer& writer, const Material& material, tinygltf::Material& to) {
    const Material usual;
    for (const auto& [name, member, extension, key, gltf_default, largest] : kMaterialFactors) {
        if (extension == kCoreFactors || material.*member == usual.*member) continue;
        Value& members = to.extensions[std::string(extension)];
        if (!members.IsObject()) members = Value(Value::Object());
        members.Get<Value::Object>()[std::string(key)] = Value(shortest_double(material.*member));
        writer.use(std::string(extension));
    }
}

Value make_material_extras(const Material& material) {
    Value::Object ours;
    if (material.mirror && material.reflectance != vec3(1))
        ours["reflectance"] = number_list(to_numbers(dvec3(material.reflectance)));
    if (material.mirror && material.albedo != vec3(0))
        ours["diffuse"] = number_list(to_numbers(dvec3(material.albedo)));
    if (!is_one_sided(material) && !material.two_sided) ours["fixed_normals"] = Value(true);
    return ours.empty() ? Value() : make_extras(std::move(ours));
}

} // namespace

int Writer::image(const Image& image) {
    const auto [entry, is_new] = images.try_emplace(&image, int_size(model.images));
    if (!is_new) return entry->second;
    const std::string png = encode_png(image);
    view(png.data(), png.size());
    tinygltf::Image& to = model.images.emplace_back();
    to.name = image.name, to.mimeType = "image/png";
    to.bufferView = int_size(model.bufferViews) - 1;
    return entry->second;
}

int Writer::sampler(const Texture& texture) {
    const std::tuple key{filter_code(texture), wrap_code(texture.wrap_u),
                         wrap_code(texture.wrap_v)};
    const auto [entry, is_new] = samplers.try_emplace(key, int_size(model.samplers));
    if (!is_new) return entry->second;
    tinygltf::Sampler& to = model.samplers.emplace_back();
    std::tie(to.magFilter, to.wrapS, to.wrapT) = key;
    return entry->second;
}

tinygltf::TextureInfo Writer::texture_info(const Texture& texture) {
    tinygltf::Texture to;
    to.source = image(*texture.image), to.sampler = sampler(texture);
    tinygltf::TextureInfo info;
    info.index = int_size(model.textures), info.texCoord = static_cast<int>(texture.uv_set);
    model.textures.push_back(std::move(to));
    if (texture.u_row == vec3(1, 0, 0) && texture.v_row == vec3(0, 1, 0)) return info;
    info.extensions["KHR_texture_transform"] = texture_transform(texture);
    use("KHR_texture_transform");
    return info;
}

void Writer::add_material(const Material& material) {
    const vec3& base = material.mirror ? material.reflectance : material.albedo;
    tinygltf::Material to;
    to.name = material.name;
    tinygltf::PbrMetallicRoughness& pbr = to.pbrMetallicRoughness;
    pbr.baseColorFactor = {shortest_double(base.x), shortest_double(base.y),
                           shortest_double(base.z), shortest_double(material.alpha)};
    pbr.metallicFactor = material.mirror ? 1 : shortest_double(material.metallic);
    pbr.roughnessFactor = material.mirror ? 0 : shortest_double(material.roughness);
    if (material.albedo_texture) pbr.baseColorTexture = texture_info(*material.albedo_texture);
    if (material.roughness_texture)
        pbr.metallicRoughnessTexture = texture_info(*material.roughness_texture);
    if (material.normal_texture) {
        const tinygltf::TextureInfo info = texture_info(*material.normal_texture);
        to.normalTexture.index = info.index, to.normalTexture.texCoord = info.texCoord;
        to.normalTexture.extensions = info.extensions;
        to.normalTexture.scale = shortest_double(material.normal_scale);
    }
    to.doubleSided = !is_one_sided(material);
    if (material.blended)
        to.alphaMode = "BLEND";
    else if (has_alpha_mask(material))
        to.alphaMode = "MASK", to.alphaCutoff = shortest_double(material.alpha_cutoff);
    write_emission(*this, material, to);
    write_dielectric(*this, material, to);
    write_factors(*this, material, to);
    write_volume(*this, material, to);
    if (material.unlit) {
        to.extensions["KHR_materials_unlit"] = Value(Value::Object());
        use("KHR_materials_unlit");
    }
    to.extras = make_material_extras(material);
    model.materials.push_back(std::move(to));
}

} // namespace catoptric::scene::gltf
