#include "import/gltf_check.hpp"
#include "scene/material.hpp"

#include <tiny_gltf.h>

namespace catoptric::scene::gltf {

namespace {

/// The kinds of objects in a glTF file whose members are checked.
// clang-format off
enum class ObjectKind {
    nothing, file, asset, view, accessor, sparse, sparse_part, material, texture_use, camera,
    perspective, orthographic, mesh, primitive, attributes, morph, node, scene, animation, channel,
    target, sampler, skin, texture, image
};
// clang-format on

enum class MemberKind {
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
struct MemberRule {
    ObjectKind in;
    std::string_view key;
    MemberKind kind;
    ObjectKind is = ObjectKind::nothing; ///< kind of the object, or of each object of the list
    std::string_view of = {};            ///< the list that the index refers to
    std::size_t count = 0;               ///< how many numbers the list must have
    bool unread = false;                 ///< only checked, not passed to tinygltf
    bool made_up = false; ///< if absent, set to -1 (index) or 0, since tinygltf needs it
    LimitedSum LoadAccount::*total = nullptr; ///< counts the objects of the list
    std::size_t bytes = 0;                    ///< memory for each object of the list
};

constexpr MemberRule vector_rule(ObjectKind in, std::string_view key, std::size_t count) {
    return {.in = in, .key = key, .kind = MemberKind::numbers, .count = count};
}
constexpr MemberRule index_rule(ObjectKind in, std::string_view key, std::string_view of,
                                MemberKind kind = MemberKind::index) {
    return {.in = in, .key = key, .kind = kind, .of = of};
}
template <typename Made = char>
constexpr MemberRule list_rule(ObjectKind in, std::string_view key, ObjectKind is,
                               LimitedSum LoadAccount::*total = nullptr) {
    return {in, key, MemberKind::list, is, {}, 0, false, false, total, sizeof(Made)};
}
constexpr MemberRule placeholder_rule(MemberRule member) {
    member.made_up = true;
    return member;
}
constexpr MemberRule unread_rule(MemberRule member) {
    member.unread = true;
    return member;
}

using enum ObjectKind;
using enum MemberKind;

constexpr MemberRule kMemberRules[] = {
    {file, "asset", object, asset},
    {asset, "version", text},

    list_rule<tinygltf::BufferView>(file, "bufferViews", view),
    index_rule(view, "buffer", "buffers", needed_index),
    {view, "byteOffset", whole},
    {view, "byteLength", whole},
    {view, "byteStride", whole},

    list_rule<tinygltf::Accessor>(file, "accessors", accessor),
    index_rule(accessor, "bufferView", "bufferViews"),
    {accessor, "byteOffset", whole},
    {accessor, "componentType", whole},
    {accessor, "count", whole},
    {accessor, "normalized", flag},
    {accessor, "type", text},
    {accessor, "sparse", object, sparse},
    {sparse, "count", whole},
    {sparse, "indices", object, sparse_part},
    {sparse, "values", object, sparse_part},
    index_rule(sparse_part, "bufferView", "bufferViews"),
    {sparse_part, "byteOffset", whole},
    {sparse_part, "componentType", whole},

    unread_rule(list_rule<Material>(file, "materials", material, &LoadAccount::materials)),
    {material, "name", text},
    {material, "normalTexture", object, texture_use},
    {material, "occlusionTexture", object, texture_use},
    index_rule(texture_use, "index", "textures", needed_index),
    unread_rule(list_rule<tinygltf::Texture>(file, "textures", texture)),
    index_rule(texture, "source", "images"),
    index_rule(texture, "sampler", "samplers"),
    unread_rule(list_rule<tinygltf::Image>(file, "images", image)),
    index_rule(image, "bufferView", "bufferViews"),
    {image, "uri", text},

    list_rule<tinygltf::Camera>(file, "cameras", camera, &LoadAccount::cameras),
    {camera, "name", text},
    {camera, "type", text},
    placeholder_rule({camera, "perspective", object, perspective}),
    placeholder_rule({perspective, "yfov", number}),
    placeholder_rule({perspective, "znear", number}),
    placeholder_rule({camera, "orthographic", object, orthographic}),
    placeholder_rule({orthographic, "xmag", number}),
    placeholder_rule({orthographic, "ymag", number}),
    placeholder_rule({orthographic, "zfar", number}),
    placeholder_rule({orthographic, "znear", number}),

    list_rule<tinygltf::Mesh>(file, "meshes", mesh, &LoadAccount::meshes),
    {mesh, "name", text},
    list_rule<tinygltf::Primitive>(mesh, "primitives", primitive, &LoadAccount::primitives),
    index_rule(primitive, "material", "materials"),
    {primitive, "mode", whole},
    placeholder_rule({primitive, "attributes", object, attributes}),
    index_rule(attributes, "POSITION", "accessors"),
    index_rule(attributes, "NORMAL", "accessors"),
    index_rule(attributes, "TEXCOORD_0", "accessors"),
    index_rule(attributes, "TEXCOORD_1", "accessors"),
    index_rule(attributes, "COLOR_0", "accessors"),
    index_rule(attributes, "JOINTS_0", "accessors"),
    index_rule(attributes, "WEIGHTS_0", "accessors"),
    index_rule(primitive, "indices", "accessors"),
    list_rule(primitive, "targets", morph),
    index_rule(morph, "POSITION", "accessors"),
    index_rule(morph, "NORMAL", "accessors"),

    list_rule<tinygltf::Node>(file, "nodes", node, &LoadAccount::nodes),
    {node, "name", text},
    index_rule(node, "mesh", "meshes"),
    index_rule(node, "camera", "cameras"),
    index_rule(node, "children", "nodes", indices),
    vector_rule(node, "matrix", 16),
    vector_rule(node, "rotation", 4),
    vector_rule(node, "scale", 3),
    vector_rule(node, "translation", 3),
    index_rule(node, "skin", "skins"),
    list_rule<tinygltf::Skin>(file, "skins", skin),
    index_rule(skin, "joints", "nodes", indices),
    index_rule(skin, "skeleton", "nodes"),
    index_rule(skin, "inverseBindMatrices", "accessors"),

    index_rule(file, "scene", "scenes"),
    list_rule<tinygltf::Scene>(file, "scenes", scene),
    index_rule(scene, "nodes", "nodes", indices),

    list_rule<tinygltf::Animation>(file, "animations", animation),
    {animation, "name", text},
    list_rule<tinygltf::AnimationChannel>(animation, "channels", channel, &LoadAccount::channels),
    {channel, "sampler", whole},
    {channel, "target", object, target},
    index_rule(target, "node", "nodes"),
    {target, "path", text},
    list_rule<tinygltf::AnimationSampler>(animation, "samplers", sampler),
    placeholder_rule(index_rule(sampler, "input", "accessors")),
    placeholder_rule(index_rule(sampler, "output", "accessors")),
    {sampler, "interpolation", text},
};

class MemberChecker {
public:
    MemberChecker(const JsonObject& root, LoadAccount& account) : root_(root), account_(account) {}

    void check_members(const JsonObject& item, ObjectKind in) {
        for (const MemberRule& member : kMemberRules)
            if (member.in == in) check_member(item, member);
    }

private:
    void check_member(const JsonObject& item, const MemberRule& member) {
        const std::string_view key = member.key;
        if (member.kind == MemberKind::list) return each(item, member);
        if (member.kind == MemberKind::needed_index) item.needed_index(key, root_.size(member.of));
        if (!item.has(key)) return;
        if (member.kind == MemberKind::text) item.text(key);
        if (member.kind == MemberKind::flag) item.flag(key, false);
        if (member.kind == MemberKind::number) item.number(key, 0);
        if (member.kind == MemberKind::numbers) item.numbers(key, member.count);
        if (member.kind == MemberKind::whole) item.whole(key, 0);
        if (member.kind == MemberKind::index) item.index(key, root_.size(member.of));
        if (member.kind == MemberKind::indices) item.indices(key, root_.size(member.of));
        if (member.kind == MemberKind::object) check_members(*item.object(key), member.is);
    }
    void each(const JsonObject& item, const MemberRule& member) {
        item.each(member.key, [&](const JsonObject& one) {
            if (member.total != nullptr) (account_.*member.total).add(1, one.place());
            account_.json_memory.add(member.bytes, one.place());
            check_members(one, member.is);
        });
    }

    const JsonObject& root_;
    LoadAccount& account_;
};

Json convert_members(Json& from, ObjectKind in);

/// Converts a member to a form that tinygltf reads. For example, it does not accept 3.0 as an
/// integer.
Json convert_member(Json& value, const MemberRule& member) {
    if (member.kind == flag) return value.get<bool>();
    const auto counted = [](const Json& number) { return number.get<std::uint64_t>(); };
    if (member.kind == MemberKind::object) return convert_members(value, member.is);
    if (member.kind == MemberKind::number)
        return value.get<double>(); // tinygltf cuts others to 32 bits
    if (member.kind == MemberKind::list)
        for (Json& one : value) one = convert_members(one, member.is);
    else if (member.kind == MemberKind::indices)
        for (Json& one : value) one = counted(one);
    else if (member.kind != MemberKind::text && member.kind != MemberKind::numbers)
        return counted(value);
    return std::move(value);
}

/// Returns the members of an object that are read. Adds placeholders that tinygltf needs.
Json convert_members(Json& from, ObjectKind in) {
    Json to = Json::object();
    for (const MemberRule& member : kMemberRules) {
        if (member.in != in || member.unread) continue;
        const auto at = from.find(member.key);
        if (at != from.end()) {
            to[std::string(member.key)] = convert_member(*at, member);
        } else if (member.made_up) {
            Json nothing = Json::object();
            to[std::string(member.key)] = member.kind == MemberKind::object
                                              ? convert_members(nothing, member.is)
                                          : member.kind == MemberKind::index ? Json(-1)
                                                                             : Json(0);
        }
    }
    return to;
}

} // namespace

void check_known_members(const JsonObject& root, LoadAccount& account) {
    MemberChecker(root, account).check_members(root, ObjectKind::file);
}

Json keep_known_members(Json document) { return convert_members(document, ObjectKind::file); }

} // namespace catoptric::scene::gltf
