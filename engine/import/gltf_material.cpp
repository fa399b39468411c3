#include "core/text.hpp"
#include "import/gltf_check.hpp"
#include "import/gltf_texture.hpp"
#include "scene/material_facts.hpp"
#include "scene/repair.hpp"
#include "scene/unsupported_feature.hpp"
#include "shared.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace catoptric::scene::gltf {

namespace {

/// A material extension that is not drawn, and the unsupported feature that reports it.
struct UnsupportedExtension {
    /// The extension has no effect if its factor is absent or 0. An empty factor name means that
    /// the extension always has an effect.
    std::string_view extension, factor;
    std::string_view gap;
};
constexpr UnsupportedExtension kUnsupportedExtensions[] = {
    {"KHR_materials_sheen", "", "sheen"},
    {"KHR_materials_anisotropy", "anisotropyStrength", "anisotropy"},
    {"KHR_materials_iridescence", "iridescenceFactor", "iridescence"}};
/// Least light that a volume lets through at its attenuation distance, because glTF allows 0.
constexpr double kMinAttenuation = 1e-6;
constexpr std::string_view kVolumeExtension =
    "KHR_materials_volume"; // no effect without transmission
constexpr std::string_view kClearCoatExtension = "KHR_materials_clearcoat";
constexpr std::string_view kMaterialExtensions[] = {kEmissiveStrengthExtension,
                                                    "KHR_materials_ior",
                                                    "KHR_materials_specular",
                                                    "KHR_materials_unlit",
                                                    "KHR_materials_pbrSpecularGlossiness",
                                                    kVolumeExtension};

dvec3 read_vec3(const JsonObject& item, std::string_view key, double otherwise) {
    const std::vector<double> list = item.numbers(key, 3);
    return list.empty() ? dvec3(otherwise) : dvec3(list[0], list[1], list[2]);
}

class MaterialReader {
public:
    /// `has_colours`: some primitive with this material has vertex colours.
    MaterialReader(const JsonObject& from, std::size_t index, bool has_colours,
                   const MaterialContext& source, TextureReader& textures)
        : json_(from), index_(index), has_colours_(has_colours), source_(source),
          textures_(textures), extensions_(from.object("extensions")) {}

    Material read();

private:
    std::optional<JsonObject> find_extension(std::string_view name) const {
        return extensions_ ? extensions_->object(name) : std::nullopt;
    }
    std::optional<Texture> read_texture(const JsonObject& item, std::string_view key, bool srgb) {
        const std::optional<JsonObject> use = item.object(key);
        return use ? textures_.read(*use, srgb) : std::nullopt;
    }
    /// Notes a member with a number that is clamped to 0 to `largest`.
    void note_if_clamped(std::initializer_list<double> numbers, std::string_view key,
                         double largest = 1) {
        if (std::ranges::any_of(numbers, [=](double n) { return is_clamped_factor(n, largest); }))
            source_.notes.add(kClampedFactorNote, json_.path() + ": " + std::string(key));
    }
    dvec3 read_colour(const JsonObject& item, std::string_view key, double otherwise) {
        const dvec3 colour = read_vec3(item, key, otherwise);
        note_if_clamped({colour.x, colour.y, colour.z}, key);
        return glm::clamp(colour, 0.0, 1.0);
    }
    float read_fraction(const JsonObject& item, std::string_view key, double otherwise,
                        double largest = 1) {
        const double number = item.number(key, otherwise);
        note_if_clamped({number}, key, largest);
        return static_cast<float>(std::clamp(number, 0.0, largest));
    }
    void report_unsupported(std::string_view id) {
        add_unsupported_material(source_.unsupported, std::string(id), json_.path(), index_);
    }
    void base_colour(const JsonObject& item, std::string_view factor, std::string_view texture);
    void factors(std::string_view extension, const JsonObject& item);
    void read_metallic_roughness(const JsonObject& pbr);
    void read_specular_glossiness(const JsonObject& glossiness);
    void dielectric();
    void emission();
    void alpha();
    bool is_metal() const;
    void transmission();
    void other_properties();
    void report_clear_coat();
    void make_mirror(const vec3& reflectance, const vec3& diffuse);
    void read_extras();

    const JsonObject& json_;
    std::size_t index_;
    bool has_colours_;
    const MaterialContext& source_;
    TextureReader& textures_;
    std::optional<JsonObject> extensions_;
    Material material_;
};

void MaterialReader::base_colour(const JsonObject& item, std::string_view factor,
                                 std::string_view map) {
    const std::vector<double> base = item.numbers(factor, 4);
    const auto at = [&](std::size_t i) {
        return base.empty() ? 1.0f : static_cast<float>(std::clamp(base[i], 0.0, 1.0));
    };
    if (!base.empty()) note_if_clamped({base[0], base[1], base[2], base[3]}, factor);
    material_.albedo = {at(0), at(1), at(2)}, material_.alpha = at(3);
    material_.albedo_texture = read_texture(item, map, true);
}

/// Reads the factors that glTF keeps in the extension, or in the core part of a material.
void MaterialReader::factors(std::string_view extension, const JsonObject& item) {
    for (const MaterialFactor& factor : kMaterialFactors)
        if (factor.extension == extension)
            material_.*factor.member = read_fraction(item, factor.key, factor.gltf_default,
                                                     factor.largest);
}

void MaterialReader::read_metallic_roughness(const JsonObject& pbr) {
    base_colour(pbr, "baseColorFactor", "baseColorTexture");
    factors(kCoreFactors, pbr);
    material_.roughness_texture = read_texture(pbr, "metallicRoughnessTexture", false);
}

/// Reads the factors and the diffuse texture of KHR_materials_pbrSpecularGlossiness.
void MaterialReader::read_specular_glossiness(const JsonObject& glossiness) {
    base_colour(glossiness, "diffuseFactor", "diffuseTexture");
    material_.metallic = 0;
    material_.roughness = 1 - read_fraction(glossiness, "glossinessFactor", 1);
    material_.dielectric_f0 = vec3(read_colour(glossiness, "specularFactor", 1));
    material_.dielectric_f90 = vec3(1);
    if (glossiness.has("specularGlossinessTexture")) report_unsupported("material-extension");
}

void MaterialReader::dielectric() {
    const std::optional<JsonObject> ior = find_extension("KHR_materials_ior"),
                                    specular = find_extension("KHR_materials_specular");
    const double n = ior ? ior->number("ior", 1.5) : 1.5;
    json_.require(n == 0 || n >= 1, "KHR_materials_ior: wanted an ior of 0 or from 1 on, found ",
                  n);
    const double f = n == 0 ? 1 : f0_from_ior(n);
    material_.dielectric_f0 = vec3(ior ? static_cast<float>(f) : kUsualDielectricF0);
    material_.dielectric_f90 = vec3(1);
    if (!specular) return;
    const float strength = read_fraction(*specular, "specularFactor", 1);
    const dvec3 colour = glm::max(read_vec3(*specular, "specularColorFactor", 1), dvec3(0));
    material_.dielectric_f0 = vec3(glm::min(f * colour, dvec3(1))) * strength;
    material_.dielectric_f90 = vec3(strength);
    if (specular->has("specularTexture") || specular->has("specularColorTexture"))
        report_unsupported("material-extension");
}

void MaterialReader::emission() {
    const std::optional<JsonObject> strength = find_extension(kEmissiveStrengthExtension);
    material_.emission = vec3((strength ? strength->number("emissiveStrength", 1) : 1) *
                              read_vec3(json_, "emissiveFactor", 0));
    json_.require(is_valid_radiance(material_.emission),
                  "wanted an emission of at least 0 that fits a float, found another");
    if (material_.emission != vec3(0))
        material_.emission_texture = read_texture(json_, "emissiveTexture", true);
}

void MaterialReader::alpha() {
    const std::string mode = json_.text("alphaMode", "OPAQUE");
    const double cutoff = json_.number("alphaCutoff", .5);
    json_.require(cutoff >= 0, "alphaCutoff: wanted at least 0, found ", cutoff);
    if (mode == "MASK") material_.alpha_cutoff = static_cast<float>(cutoff);
    if (mode != "BLEND") return;
    material_.blended = true, material_.alpha_cutoff = .5f;
    report_unsupported("blend-shadow");
}

/// Returns whether the whole surface is metal, without any dielectric part.
bool MaterialReader::is_metal() const {
    if (material_.metallic < 1 || !material_.roughness_texture) return material_.metallic == 1;
    return std::ranges::all_of(material_.roughness_texture->image->texels,
                               [](std::uint32_t texel) { return (texel >> 16 & 0xff) == 0xff; });
}

/// Reads the properties of transmitted light, and reports properties that techniques do not draw. A
/// material that is metal everywhere is not reported, because only the dielectric part transmits
/// light.
void MaterialReader::transmission() {
    if (material_.transmission == 0 || is_metal()) return;
    if (extensions_->has("KHR_materials_ior")) {
        const double ior = find_extension("KHR_materials_ior")->number("ior", 1.5);
        // glTF's ior of 0 reflects all light.
        constexpr double kLargest = std::numeric_limits<float>::max();
        material_.ior = static_cast<float>(ior == 0 ? kLargest : std::min(ior, kLargest));
    }
    if (const std::optional<JsonObject> volume = find_extension(kVolumeExtension)) {
        json_.require(volume->number("thicknessFactor", 0) >= 0,
                      "thicknessFactor: wanted at least 0, found a negative number");
        material_.solid = volume->number("thicknessFactor", 0) > 0;
        const double distance = volume->number("attenuationDistance", 0); // 0: as without
        const dvec3 colour = glm::max(read_colour(*volume, "attenuationColor", 1),
                                      dvec3(kMinAttenuation));
        json_.require(distance >= 0, "attenuationDistance: wanted at least 0, found ", distance);
        if (material_.solid && distance > 0)
            material_.absorption = vec3(-glm::log(colour) / distance);
        json_.require(is_valid_radiance(material_.absorption),
                      "attenuationDistance: wanted an absorption that fits a float, found more");
    }
    if (find_extension("KHR_materials_transmission")->has("transmissionTexture"))
        report_unsupported("material-extension");
    if (!is_glass(material_)) return report_unsupported("partial-glass");
    report_unsupported("glass-approximated"), report_unsupported("glass-shadow");
    if (material_.roughness > shared::kMaxSharpRoughness) report_unsupported("rough-glass");
    if (material_.dispersion > 0 && material_.solid) report_unsupported("dispersion");
    if (material_.alpha_cutoff == 0) return;
    material_.blended = false, material_.alpha_cutoff = 0; // glass transmits light, whatever its
                                                           // alpha
    report_unsupported("material-extension");
}

/// A coat has the normals of the surface below, and one roughness everywhere. Some surfaces have
/// no coat (has_clear_coat).
void MaterialReader::report_clear_coat() {
    if (material_.clearcoat == 0) return;
    if (!has_clear_coat(material_)) return report_unsupported("clearcoat");
    const JsonObject coat = *find_extension(kClearCoatExtension);
    const bool has_maps = coat.has("clearcoatTexture") || coat.has("clearcoatRoughnessTexture") ||
                          coat.has("clearcoatNormalTexture") || json_.has("normalTexture");
    if (has_maps) report_unsupported("clearcoat-texture");
}

/// Reads the extensions of kMaterialFactors, and reports what the engine does not draw.
void MaterialReader::other_properties() {
    if (const std::optional<JsonObject> use = json_.object("normalTexture")) {
        material_.normal_texture = textures_.read(*use, false);
        material_.normal_scale = static_cast<float>(use->number("scale", 1));
    }
    if (json_.has("occlusionTexture")) {
        source_.notes.add("materials with an occlusionTexture, drawn without it", json_.path());
        report_unsupported("occlusion-texture");
    }
    // `technique` comes from the draft KHR_technique_webgl, which kept shaders beside materials.
    if (json_.has("technique")) report_unsupported("material-extension");
    if (!extensions_) return;
    for (const auto& [name, value] : extensions_->json().items()) {
        if (is_factor_extension(name)) {
            factors(name, *extensions_->object(name));
            continue;
        }
        bool is_known = std::ranges::find(kMaterialExtensions, name) !=
                        std::end(kMaterialExtensions);
        for (const auto& [extension, factor, id] : kUnsupportedExtensions) {
            if (name != extension) continue;
            is_known = true;
            if (factor.empty() || extensions_->object(name)->number(factor, 0) != 0)
                report_unsupported(id);
        }
        if (!is_known) report_unsupported("material-extension");
    }
}

/// Makes the material a mirror, given only by reflectance and diffuse albedo, as scenes made in
/// code do.
void MaterialReader::make_mirror(const vec3& reflectance, const vec3& diffuse) {
    material_.mirror = true, material_.reflectance = reflectance, material_.albedo = diffuse;
    material_.metallic = 0, material_.roughness = 1;
}

/// Reads properties that glTF cannot express, from `extras`:
///   {"catoptric": {"reflectance": [r, g, b], "diffuse": [r, g, b], "fixed_normals": true}}
/// The first two make a mirror with the same reflectance at any angle, over a diffuse albedo.
/// `fixed_normals` makes a surface with two sides but one normal.
void MaterialReader::read_extras() {
    const std::optional<JsonObject> ours = find_extras(json_);
    const auto colour = [&](std::string_view key, double otherwise) {
        return vec3(read_colour(*ours, key, otherwise));
    };
    if (ours && (ours->has("reflectance") || ours->has("diffuse")))
        make_mirror(colour("reflectance", 1), colour("diffuse", 0));
    if (ours && ours->flag("fixed_normals", false)) material_.two_sided = false;
}

Material MaterialReader::read() {
    material_.name = json_.name();
    const std::optional<JsonObject> glossiness = find_extension(
                                        "KHR_materials_pbrSpecularGlossiness"),
                                    pbr = json_.object("pbrMetallicRoughness");
    material_.metallic = 1, material_.albedo = vec3(1);
    if (glossiness)
        read_specular_glossiness(*glossiness);
    else if (pbr)
        read_metallic_roughness(*pbr);
    if (!glossiness) dielectric();
    emission();
    alpha();
    const bool doubled = json_.flag("doubleSided", false);
    material_.two_sided = doubled, material_.front_only = !doubled;
    other_properties();
    transmission();
    if (find_extension("KHR_materials_unlit")) {
        material_.unlit = true, material_.metallic = 0, material_.roughness = 1;
        material_.emission = vec3(0), material_.emission_texture.reset();
    }
    // A metal of this kind reflects all light at every angle, so it is the same as a mirror without
    // Fresnel's equations.
    const bool is_perfect = material_.metallic == 1 && material_.roughness == 0 &&
                            material_.albedo == vec3(1) && !material_.albedo_texture &&
                            !material_.roughness_texture && !has_colours_ &&
                            material_.clearcoat == 0;
    if (is_perfect) make_mirror(vec3(1), vec3(0));
    read_extras();
    report_clear_coat();
    return material_;
}

/// Returns for each material whether some primitive with it has vertex colours.
std::vector<bool> coloured_materials(const JsonObject& root) {
    std::vector<bool> coloured(root.size("materials"));
    root.each("meshes", [&](const JsonObject& mesh) {
        mesh.each("primitives", [&](const JsonObject& primitive) {
            const std::optional<JsonObject> attributes = primitive.object("attributes");
            const auto material = primitive.index("material", coloured.size());
            if (material && attributes && attributes->has("COLOR_0")) coloured[*material] = true;
        });
    });
    return coloured;
}

} // namespace

std::vector<Material> read_materials(const MaterialContext& source) {
    std::vector<Material> materials;
    TextureReader textures(source);
    const std::vector<bool> coloured = coloured_materials(source.root);
    source.root.each("materials", [&](const JsonObject& item) {
        const std::size_t index = materials.size();
        materials.push_back(MaterialReader(item, index, coloured[index], source, textures).read());
    });
    return materials;
}

} // namespace catoptric::scene::gltf
