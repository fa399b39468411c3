#include "scene/gltf_check.hpp"
#include "scene/material.hpp"

#include <tiny_gltf.h>

namespace catoptric::scene::gltf {

namespace {

/// The kinds of objects in a glTF file whose members are checked.
// clang-format off
enum class GltfObjectKind {
    nothing, file, asset, view, accessor, sparse, sparse_part, material, texture_use, camera,
    perspective, orthographic, mesh, primitive, attributes, morph, node, scene, animation, channel,
    target, sampler, skin, texture, image
};
// clang-format on

enum class GltfMemberKind {
    text,
    flag,
    number,
    numbers,
    whole,
    index,
    needed_index,
    indices,
    object,
    list
};

/// One row of the member table: the type that a member must have, and how it is used.
struct GltfMemberRule {
    GltfObjectKind in;
    std::string_view key;
    GltfMemberKind kind;
    GltfObjectKind is =
        GltfObjectKind::nothing; ///< kind of the object, or of each object of the list
    std::string_view of = {};    ///< the list that the index refers to
    std::size_t count = 0;       ///< how many numbers the list must have
    bool unread = false;         ///< only checked, not passed to tinygltf
    bool made_up = false;        ///< if absent, set to -1 (index) or 0, since tinygltf needs it
    BudgetLimitedSum SceneLoadBudgetUsage::*total = nullptr; ///< counts the objects of the list
    std::size_t bytes = 0;                                   ///< memory for each object of the list
};

constexpr GltfMemberRule make_vector_member_rule(GltfObjectKind in, std::string_view key,
                                                 std::size_t count) {
    return {.in = in, .key = key, .kind = GltfMemberKind::numbers, .count = count};
}
constexpr GltfMemberRule make_index_member_rule(GltfObjectKind in, std::string_view key,
                                                std::string_view of,
                                                GltfMemberKind kind = GltfMemberKind::index) {
    return {.in = in, .key = key, .kind = kind, .of = of};
}
template <typename Made = char>
constexpr GltfMemberRule
make_list_member_rule(GltfObjectKind in, std::string_view key, GltfObjectKind is,
                      BudgetLimitedSum SceneLoadBudgetUsage::*total = nullptr) {
    return {in, key, GltfMemberKind::list, is, {}, 0, false, false, total, sizeof(Made)};
}
constexpr GltfMemberRule make_placeholder_member_rule(GltfMemberRule member) {
    member.made_up = true;
    return member;
}
constexpr GltfMemberRule make_unread_member_rule(GltfMemberRule member) {
    member.unread = true;
    return member;
}

using enum GltfObjectKind;
using enum GltfMemberKind;

constexpr GltfMemberRule kGltfMemberRules[] = {
    {file, "asset", object, asset},
    {asset, "version", text},

    make_list_member_rule<tinygltf::BufferView>(file, "bufferViews", view),
    make_index_member_rule(view, "buffer", "buffers", needed_index),
    {view, "byteOffset", whole},
    {view, "byteLength", whole},
    {view, "byteStride", whole},

    make_list_member_rule<tinygltf::Accessor>(file, "accessors", accessor),
    make_index_member_rule(accessor, "bufferView", "bufferViews"),
    {accessor, "byteOffset", whole},
    {accessor, "componentType", whole},
    {accessor, "count", whole},
    {accessor, "normalized", flag},
    {accessor, "type", text},
    {accessor, "sparse", object, sparse},
    {sparse, "count", whole},
    {sparse, "indices", object, sparse_part},
    {sparse, "values", object, sparse_part},
    make_index_member_rule(sparse_part, "bufferView", "bufferViews"),
    {sparse_part, "byteOffset", whole},
    {sparse_part, "componentType", whole},

    make_unread_member_rule(make_list_member_rule<Material>(file, "materials", material,
                                                            &SceneLoadBudgetUsage::materials)),
    {material, "name", text},
    {material, "normalTexture", object, texture_use},
    {material, "occlusionTexture", object, texture_use},
    make_index_member_rule(texture_use, "index", "textures", needed_index),
    make_unread_member_rule(make_list_member_rule<tinygltf::Texture>(file, "textures", texture)),
    make_index_member_rule(texture, "source", "images"),
    make_index_member_rule(texture, "sampler", "samplers"),
    make_unread_member_rule(make_list_member_rule<tinygltf::Image>(file, "images", image)),
    make_index_member_rule(image, "bufferView", "bufferViews"),
    {image, "uri", text},

    make_list_member_rule<tinygltf::Camera>(file, "cameras", camera,
                                            &SceneLoadBudgetUsage::cameras),
    {camera, "name", text},
    {camera, "type", text},
    make_placeholder_member_rule({camera, "perspective", object, perspective}),
    make_placeholder_member_rule({perspective, "yfov", number}),
    make_placeholder_member_rule({perspective, "znear", number}),
    make_placeholder_member_rule({camera, "orthographic", object, orthographic}),
    make_placeholder_member_rule({orthographic, "xmag", number}),
    make_placeholder_member_rule({orthographic, "ymag", number}),
    make_placeholder_member_rule({orthographic, "zfar", number}),
    make_placeholder_member_rule({orthographic, "znear", number}),

    make_list_member_rule<tinygltf::Mesh>(file, "meshes", mesh, &SceneLoadBudgetUsage::meshes),
    {mesh, "name", text},
    make_list_member_rule<tinygltf::Primitive>(mesh, "primitives", primitive,
                                               &SceneLoadBudgetUsage::primitives),
    make_index_member_rule(primitive, "material", "materials"),
    {primitive, "mode", whole},
    make_placeholder_member_rule({primitive, "attributes", object, attributes}),
    make_index_member_rule(attributes, "POSITION", "accessors"),
    make_index_member_rule(attributes, "NORMAL", "accessors"),
    make_index_member_rule(attributes, "TEXCOORD_0", "accessors"),
    make_index_member_rule(attributes, "TEXCOORD_1", "accessors"),
    make_index_member_rule(attributes, "COLOR_0", "accessors"),
    make_index_member_rule(attributes, "JOINTS_0", "accessors"),
    make_index_member_rule(attributes, "WEIGHTS_0", "accessors"),
    make_index_member_rule(primitive, "indices", "accessors"),
    make_list_member_rule(primitive, "targets", morph),
    make_index_member_rule(morph, "POSITION", "accessors"),
    make_index_member_rule(morph, "NORMAL", "accessors"),

    make_list_member_rule<tinygltf::Node>(file, "nodes", node, &SceneLoadBudgetUsage::nodes),
    {node, "name", text},
    make_index_member_rule(node, "mesh", "meshes"),
    make_index_member_rule(node, "camera", "cameras"),
    make_index_member_rule(node, "children", "nodes", indices),
    make_vector_member_rule(node, "matrix", 16),
    make_vector_member_rule(node, "rotation", 4),
    make_vector_member_rule(node, "scale", 3),
    make_vector_member_rule(node, "translation", 3),
    make_index_member_rule(node, "skin", "skins"),
    make_list_member_rule<tinygltf::Skin>(file, "skins", skin),
    make_index_member_rule(skin, "joints", "nodes", indices),
    make_index_member_rule(skin, "skeleton", "nodes"),
    make_index_member_rule(skin, "inverseBindMatrices", "accessors"),

    make_index_member_rule(file, "scene", "scenes"),
    make_list_member_rule<tinygltf::Scene>(file, "scenes", scene),
    make_index_member_rule(scene, "nodes", "nodes", indices),

    make_list_member_rule<tinygltf::Animation>(file, "animations", animation),
    {animation, "name", text},
    make_list_member_rule<tinygltf::AnimationChannel>(animation, "channels", channel,
                                                      &SceneLoadBudgetUsage::channels),
    {channel, "sampler", whole},
    {channel, "target", object, target},
    make_index_member_rule(target, "node", "nodes"),
    {target, "path", text},
    make_list_member_rule<tinygltf::AnimationSampler>(animation, "samplers", sampler),
    make_placeholder_member_rule(make_index_member_rule(sampler, "input", "accessors")),
    make_placeholder_member_rule(make_index_member_rule(sampler, "output", "accessors")),
    {sampler, "interpolation", text},
};

class GltfMemberChecker {
public:
    GltfMemberChecker(const JsonObject& root, SceneLoadBudgetUsage& account)
        : gltf_root_(root), account_(account) {}

    void check_object_members(const JsonObject& item, GltfObjectKind in) {
        for (const GltfMemberRule& member : kGltfMemberRules)
            if (member.in == in) check_member(item, member);
    }

private:
    void check_member(const JsonObject& item, const GltfMemberRule& member) {
        const std::string_view key = member.key;
        if (member.kind == GltfMemberKind::list) return each(item, member);
        if (member.kind == GltfMemberKind::needed_index)
            item.needed_index(key, gltf_root_.size(member.of));
        if (!item.has_member(key)) return;
        if (member.kind == GltfMemberKind::text) item.text(key);
        if (member.kind == GltfMemberKind::flag) item.flag(key, false);
        if (member.kind == GltfMemberKind::number) item.number(key, 0);
        if (member.kind == GltfMemberKind::numbers) item.numbers(key, member.count);
        if (member.kind == GltfMemberKind::whole) item.whole(key, 0);
        if (member.kind == GltfMemberKind::index) item.index(key, gltf_root_.size(member.of));
        if (member.kind == GltfMemberKind::indices) item.indices(key, gltf_root_.size(member.of));
        if (member.kind == GltfMemberKind::object)
            check_object_members(*item.read_object_member(key), member.is);
    }
    void each(const JsonObject& item, const GltfMemberRule& member) {
        item.each(member.key, [&](const JsonObject& one) {
            if (member.total != nullptr)
                (account_.*member.total).add_amount_within_budget(1, one.place());
            account_.json_memory.add_amount_within_budget(member.bytes, one.place());
            check_object_members(one, member.is);
        });
    }

    const JsonObject& gltf_root_;
    SceneLoadBudgetUsage& account_;
};

Json convert_members_for_tinygltf(Json& from, GltfObjectKind in);

/// Converts a member to a form that tinygltf reads. For example, it does not accept 3.0 as an
/// integer.
Json convert_member_for_tinygltf(Json& value, const GltfMemberRule& member) {
    if (member.kind == flag) return value.get<bool>();
    const auto counted = [](const Json& number) { return number.get<std::uint64_t>(); };
    if (member.kind == GltfMemberKind::object)
        return convert_members_for_tinygltf(value, member.is);
    if (member.kind == GltfMemberKind::number)
        return value.get<double>(); // tinygltf cuts others to 32 bits
    if (member.kind == GltfMemberKind::list)
        for (Json& one : value) one = convert_members_for_tinygltf(one, member.is);
    else if (member.kind == GltfMemberKind::indices)
        for (Json& one : value) one = counted(one);
    else if (member.kind != GltfMemberKind::text && member.kind != GltfMemberKind::numbers)
        return counted(value);
    return std::move(value);
}

/// Returns the members of an object that are read. Adds placeholders that tinygltf needs.
Json convert_members_for_tinygltf(Json& from, GltfObjectKind in) {
    Json to = Json::object();
    for (const GltfMemberRule& member : kGltfMemberRules) {
        if (member.in != in || member.unread) continue;
        const auto at = from.find(member.key);
        if (at != from.end()) {
            to[std::string(member.key)] = convert_member_for_tinygltf(*at, member);
        } else if (member.made_up) {
            Json nothing = Json::object();
            to[std::string(member.key)] = member.kind == GltfMemberKind::object
                                              ? convert_members_for_tinygltf(nothing, member.is)
                                          : member.kind == GltfMemberKind::index ? Json(-1)
                                                                                 : Json(0);
        }
    }
    return to;
}

} // namespace

void check_known_members(const JsonObject& root, SceneLoadBudgetUsage& account) {
    GltfMemberChecker(root, account).check_object_members(root, GltfObjectKind::file);
}

Json keep_known_members(Json document) {
    return convert_members_for_tinygltf(document, GltfObjectKind::file);
}

} // namespace catoptric::scene::gltf
