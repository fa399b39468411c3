#include "core/text.hpp"
#include "scene/gltf_container.hpp"
#include "scene/gltf_document.hpp"

#include <algorithm>

namespace catoptric::scene::gltf {

namespace {

constexpr std::string_view kLights = "KHR_lights_punctual";
constexpr std::string_view kRead = "KHR_materials_emissive_strength";

/// What glTF allows by the beginning of an attribute's name.
struct Semantic {
    std::string_view name, type, other_type;
};
constexpr Semantic kSemantics[] = {{"POSITION", "VEC3", ""},    {"NORMAL", "VEC3", ""},
                                   {"TANGENT", "VEC4", "VEC3"}, {"TEXCOORD_", "VEC2", ""},
                                   {"COLOR_", "VEC3", "VEC4"},  {"JOINTS_", "VEC4", ""},
                                   {"WEIGHTS_", "VEC4", ""}};

/// Extensions of `value` and of all within it, which nests less than 64 deep.
void note_extensions(const Json& value, const Item& around, Notes& notes) {
    if (!value.is_structured()) return;
    for (const auto& [key, inner] : value.items()) {
        if (value.is_object() && key == "extras") continue;
        if (value.is_object() && key == "extensions" && inner.is_object())
            for (const auto& [name, content] : inner.items())
                if (name != kRead && name != kLights)
                    notes.add("extension " + in_quotes(name) + ", not read", around.label());
        note_extensions(inner, around, notes);
    }
}

void note_all_extensions(const Item& root, Notes& notes) {
    for (const auto& [key, value] : root.json().items()) {
        if (key == "extensions") {
            for (const auto& [name, content] : value.items())
                if (name != kLights)
                    notes.add("extension " + in_quotes(name) + ", not read", "of the whole file");
        } else if (value.is_array()) {
            for (std::size_t i = 0; i < value.size(); ++i)
                if (value[i].is_object()) note_extensions(value[i], root.at(key, i), notes);
        }
    }
}

void note_lights(const Item& root, Notes& notes) {
    const std::optional<Item> extensions = root.object("extensions");
    const std::optional<Item> lights = extensions ? extensions->object(kLights) : std::nullopt;
    if (!lights) return;
    lights->each("lights", [&](const Item& light) {
        notes.add("lights of KHR_lights_punctual, not read", in_quotes(light.name()));
    });
}

void note_texture(const Item& material, const Item& holder, const char* slot, std::size_t count,
                  Notes& notes) {
    const std::optional<Item> texture = holder.object(slot);
    if (!texture) return;
    texture->needed_index("index", count);
    notes.add("materials with a " + std::string(slot) + ", drawn without it", material.label());
}

void note_materials(const Item& root, Notes& notes) {
    const std::size_t textures = root.size("textures");
    root.each("materials", [&](const Item& material) {
        if (const std::optional<Item> pbr = material.object("pbrMetallicRoughness"))
            for (const char* slot : {"baseColorTexture", "metallicRoughnessTexture"})
                note_texture(material, *pbr, slot, textures, notes);
        for (const char* slot : {"normalTexture", "occlusionTexture", "emissiveTexture"})
            note_texture(material, material, slot, textures, notes);
        const std::string alpha = material.text("alphaMode", "OPAQUE");
        material.require(alpha == "OPAQUE" || alpha == "MASK" || alpha == "BLEND",
                         "alphaMode: wanted OPAQUE, MASK or BLEND, found ", shown(Json(alpha)));
        if (alpha != "OPAQUE")
            notes.add("materials with alphaMode " + alpha + ", drawn opaque", material.label());
    });
}

/// Images are not read, but named: those in files lie where a scene's files may.
void note_images(const Item& root, Context& context) {
    const std::size_t images = root.size("images"), samplers = root.size("samplers"),
                      views = root.size("bufferViews");
    root.each("textures", [&](const Item& texture) {
        texture.index("source", images);
        texture.index("sampler", samplers);
    });
    root.each("images", [&](const Item& image) {
        image.index("bufferView", views);
        context.notes.add("images, not read", image.label());
        const std::string uri = image.text("uri");
        if (!uri.empty() && !is_data_uri(uri))
            context.files.find(file_name_of(uri, image.place()), image.place());
    });
}

void note_skins(const Item& root, Context& context) {
    const std::size_t skins = root.size("skins"), nodes = root.size("nodes");
    root.each("skins", [&](const Item& skin) {
        skin.indices("joints", nodes);
        skin.index("skeleton", nodes);
        skin.index("inverseBindMatrices", context.accessors.size());
    });
    root.each("nodes", [&](const Item& node) {
        if (node.index("skin", skins))
            context.notes.add("nodes with a skin, not posed", node.label());
    });
}

void check_attributes(const Item& attributes, const Accessors& accessors) {
    for (const auto& [name, value] : attributes.json().items()) {
        const Accessor& accessor = accessors[attributes.needed_index(name, accessors.size())];
        for (const Semantic& semantic : kSemantics)
            attributes.require(!name.starts_with(semantic.name) || accessor.type == semantic.type ||
                                   accessor.type == semantic.other_type,
                               name, ": wanted an accessor of ", semantic.type, ", found ",
                               accessor.type);
    }
}

void note_primitives(const Item& root, Context& context) {
    root.each("meshes", [&](const Item& mesh) {
        mesh.each("primitives", [&](const Item& primitive) {
            if (const std::optional<Item> attributes = primitive.object("attributes")) {
                check_attributes(*attributes, context.accessors);
                if (attributes->has("COLOR_0"))
                    context.notes.add("primitives with colours at vertices, not read",
                                      primitive.label());
            }
            primitive.each("targets", [&](const Item& target) {
                check_attributes(target, context.accessors);
                context.notes.add("morph targets, not read", target.label());
            });
        });
    });
}

} // namespace

void note_unread(const Item& root, Context& context) {
    note_lights(root, context.notes);
    note_materials(root, context.notes);
    note_images(root, context);
    note_skins(root, context);
    note_primitives(root, context);
    note_all_extensions(root, context.notes);
}

} // namespace catoptric::scene::gltf
