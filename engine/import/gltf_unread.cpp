#include "core/text.hpp"
#include "import/gltf_check.hpp"

#include <algorithm>

namespace catoptric::scene::gltf {

namespace {

constexpr std::size_t kMaxAttributeNameLength =
    1024; // attribute name in bytes; messages quote it in full
/// Extensions that are read, or that only change how other members are stored.
constexpr std::string_view kSupportedExtensions[] = {
    kEmissiveStrengthExtension,  "KHR_lights_punctual",     "KHR_materials_ior",
    "KHR_materials_specular",    "KHR_materials_unlit",     "KHR_materials_pbrSpecularGlossiness",
    "KHR_texture_transform",     "KHR_mesh_quantization",   "EXT_texture_webp",
    "KHR_materials_volume",      "EXT_mesh_gpu_instancing", kMeshoptExtension,
    "KHR_draco_mesh_compression"};

bool is_read_extension(std::string_view extension) {
    return std::ranges::find(kSupportedExtensions, extension) != std::end(kSupportedExtensions) ||
           is_factor_extension(extension);
}

/// The accessor types that glTF allows for attributes whose name starts with `name`.
struct AttributeTypes {
    std::string_view name, type, other_type;
};
constexpr AttributeTypes kAttributeTypes[] = {
    {"POSITION", "VEC3", ""},  {"NORMAL", "VEC3", ""},     {"TANGENT", "VEC4", "VEC3"},
    {"TEXCOORD_", "VEC2", ""}, {"COLOR_", "VEC3", "VEC4"}, {"JOINTS_", "VEC4", ""},
    {"WEIGHTS_", "VEC4", ""}};

/// Notes the unread extensions of `value` and of all values inside it. The recursion is at most 64
/// deep, because `parse_json` limits nesting.
void note_extensions_inside(const Json& value, const JsonObject& around, LoaderNotes& notes) {
    if (!value.is_structured()) return;
    for (const auto& [key, inner] : value.items()) {
        if (value.is_object() && key == "extras") continue;
        if (value.is_object() && key == "extensions" && inner.is_object())
            for (const auto& [name, content] : inner.items())
                if (!is_read_extension(name))
                    notes.add("extension " + quote(name) + ", not read", around.path());
        note_extensions_inside(inner, around, notes);
    }
}

void note_unread_extensions(const JsonObject& root, LoaderNotes& notes) {
    for (const auto& [key, value] : root.json().items()) {
        if (key == "extensions") {
            for (const auto& [name, content] : value.items())
                if (!is_read_extension(name))
                    notes.add("extension " + quote(name) + ", not read", "of the whole file");
        } else if (value.is_array()) {
            for (std::size_t i = 0; i < value.size(); ++i)
                if (value[i].is_object()) note_extensions_inside(value[i], root.at(key, i), notes);
        }
    }
}

void check_alpha_mode(const JsonObject& material) {
    const std::string alpha = material.text("alphaMode", "OPAQUE");
    material.require(alpha == "OPAQUE" || alpha == "MASK" || alpha == "BLEND",
                     "alphaMode: wanted OPAQUE, MASK or BLEND, found ", describe(Json(alpha)));
}

void check_image_source(const JsonObject& image, FileOpener& files) {
    const std::string uri = image.text("uri");
    if (!uri.empty() && !is_data_uri(uri))
        files.find(name_from_uri(uri, image.place()), image.place());
}

void check_camera_type(const JsonObject& camera) {
    const std::string type = camera.text("type");
    camera.require((type == "perspective" || type == "orthographic") && camera.has(type),
                   "wanted a perspective or orthographic camera, found neither");
}

/// Notes the attributes that are not read, but for those of applications ("_NAME"). Tangents count
/// only where a normal map needs them.
void note_unread_attributes(const JsonObject& primitive, const JsonObject& attributes,
                            const JsonObject& root, LoaderNotes& notes) {
    constexpr std::string_view kReadAttributes[] = {
        "POSITION", "NORMAL", "TEXCOORD_0", "TEXCOORD_1", "COLOR_0", "JOINTS_0", "WEIGHTS_0"};
    const std::size_t material = primitive.whole("material", ~std::uint64_t(0));
    const bool has_normal_map = material < root.size("materials") &&
                                root.at("materials", material).has("normalTexture");
    for (const auto& [name, value] : attributes.json().items()) {
        if (name.starts_with('_') ||
            std::ranges::find(kReadAttributes, name) != std::end(kReadAttributes))
            continue;
        if (name == "TANGENT") {
            notes.add("attributes TANGENT, not read (normal maps get their tangents from "
                      "texture coordinates)",
                      attributes.path(), has_normal_map ? 1 : 0);
            continue;
        }
        notes.add("attributes " + quote(name) + ", not read", attributes.path());
    }
}

void check_attributes(const JsonObject& attributes, const JsonObject& root) {
    const std::size_t count = root.size("accessors");
    for (const auto& [name, value] : attributes.json().items()) {
        attributes.require(name.size() <= kMaxAttributeNameLength, "attribute ", quote(name),
                           ": wanted a name of at most ", kMaxAttributeNameLength, " bytes, found ",
                           name.size());
        const std::string type =
            root.at("accessors", attributes.needed_index(name, count)).text("type");
        for (const AttributeTypes& semantic : kAttributeTypes)
            attributes.require(!name.starts_with(semantic.name) || type == semantic.type ||
                                   type == semantic.other_type,
                               name, ": wanted an accessor of ", semantic.type, ", found ", type);
    }
}

void check_primitive(const JsonObject& primitive, const JsonObject& root, LoaderNotes& notes) {
    const std::uint64_t mode = primitive.whole("mode", 4);
    primitive.require(mode <= 6, "mode: wanted 0 to 6, found ", mode);
    const std::optional<JsonObject> attributes = primitive.object("attributes");
    if (attributes) {
        check_attributes(*attributes, root);
        note_unread_attributes(primitive, *attributes, root, notes);
    }
    primitive.each("targets", [&](const JsonObject& target) { check_attributes(target, root); });
}

void check_channels(const JsonObject& animation, LoaderNotes& notes) {
    const std::size_t samplers = animation.size("samplers");
    animation.each("channels", [&](const JsonObject& channel) {
        channel.needed_index("sampler", samplers);
        const std::optional<JsonObject> target = channel.object("target");
        channel.require(target.has_value(), "wanted a target, found none");
        const std::string path = target->text("path");
        if (target->has("node") && path != "translation" && path != "rotation" && path != "scale")
            notes.add("animation channels of " + quote(path) + ", left out", channel.path());
    });
}

} // namespace

void check_cross_references(const JsonObject& root, FileOpener& files, LoaderNotes& notes) {
    root.each("materials", [&](const JsonObject& material) { check_alpha_mode(material); });
    root.each("images", [&](const JsonObject& image) { check_image_source(image, files); });
    root.each("cameras", [&](const JsonObject& camera) { check_camera_type(camera); });
    root.each("meshes", [&](const JsonObject& mesh) {
        mesh.each("primitives",
                  [&](const JsonObject& primitive) { check_primitive(primitive, root, notes); });
    });
    root.each("animations", [&](const JsonObject& animation) { check_channels(animation, notes); });
    note_unread_extensions(root, notes);
}

} // namespace catoptric::scene::gltf
