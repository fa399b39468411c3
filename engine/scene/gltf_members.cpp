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
    GltfObjectKind in;
    std::string_view key;
    MemberKind kind;
    GltfObjectKind is =
        GltfObjectKind::nothing; ///< kind of the object, or of each object of the list
    std::string_view of = {};    ///< the list that the index refers to
    std::size_t count = 0;       ///< how many numbers
    bool unread = false;         ///< only checked, not passed to tinygltf
    std::string_view note = {};  ///< the note to add if the member is present
    bool made_up = false;        ///< if absent, set to -1 (index) or 0, since tinygltf needs it
    LimitedSum BudgetAccount::*total = nullptr; ///< counts the objects of the list
    std::size_t bytes = 0;                      ///< memory for each object of the list
};

constexpr MemberRule vector_member_rule(GltfObjectKind in, std::string_view key,
                                        std::size_t count) {
    return {.in = in, .key = key, .kind = MemberKind::numbers, .count = count};
}
constexpr MemberRule object_member_rule(GltfObjectKind in, std::string_view key,
                                        std::string_view of, MemberKind kind = MemberKind::index) {
    return {.in = in, .key = key, .kind = kind, .of = of};
}
template <typename Made = char>
constexpr MemberRule list_member_rule(GltfObjectKind in, std::string_view key, GltfObjectKind is,
                                      LimitedSum BudgetAccount::*total = nullptr) {
    return {in, key, MemberKind::list, is, {}, 0, false, {}, false, total, sizeof(Made)};
}
constexpr MemberRule replaceable_member_rule(MemberRule member) {
    member.made_up = true;
    return member;
}
constexpr MemberRule unread_member_rule(MemberRule member, std::string_view note = {}) {
    member.unread = true, member.note = note;
    return member;
}

using enum GltfObjectKind;
using enum MemberKind;

constexpr MemberRule kMemberRules[] = {
    {file, "asset", object, asset},
    {asset, "version", text},

    list_member_rule<tinygltf::BufferView>(file, "bufferViews", view),
    object_member_rule(view, "buffer", "buffers", needed_index),
    {view, "byteOffset", whole},
    {view, "byteLength", whole},
    {view, "byteStride", whole},

    list_member_rule<tinygltf::Accessor>(file, "accessors", accessor),
    object_member_rule(accessor, "bufferView", "bufferViews"),
    {accessor, "byteOffset", whole},
    {accessor, "componentType", whole},
    {accessor, "count", whole},
    {accessor, "normalized", flag},
    {accessor, "type", text},
    {accessor, "sparse", object, sparse},
    {sparse, "count", whole},
    {sparse, "indices", object, sparse_part},
    {sparse, "values", object, sparse_part},
    object_member_rule(sparse_part, "bufferView", "bufferViews"),
    {sparse_part, "byteOffset", whole},
    {sparse_part, "componentType", whole},

    unread_member_rule(
        list_member_rule<Material>(file, "materials", material, &BudgetAccount::materials)),
    {material, "name", text},
    {material, "normalTexture", object, texture_use},
    {material, "occlusionTexture", object, texture_use},
    object_member_rule(texture_use, "index", "textures", needed_index),
    unread_member_rule(list_member_rule<tinygltf::Texture>(file, "textures", texture)),
    object_member_rule(texture, "source", "images"),
    object_member_rule(texture, "sampler", "samplers"),
    unread_member_rule(list_member_rule<tinygltf::Image>(file, "images", image)),
    object_member_rule(image, "bufferView", "bufferViews"),
    {image, "uri", text},

    list_member_rule<tinygltf::Camera>(file, "cameras", camera, &BudgetAccount::cameras),
    {camera, "name", text},
    {camera, "type", text},
    replaceable_member_rule({camera, "perspective", object, perspective}),
    replaceable_member_rule({perspective, "yfov", number}),
    replaceable_member_rule({perspective, "znear", number}),
    replaceable_member_rule({camera, "orthographic", object, orthographic}),
    replaceable_member_rule({orthographic, "xmag", number}),
    replaceable_member_rule({orthographic, "ymag", number}),
    replaceable_member_rule({orthographic, "zfar", number}),
    replaceable_member_rule({orthographic, "znear", number}),

    list_member_rule<tinygltf::Mesh>(file, "meshes", mesh, &BudgetAccount::meshes),
    {mesh, "name", text},
    list_member_rule<tinygltf::Primitive>(mesh, "primitives", primitive,
                                          &BudgetAccount::primitives),
    object_member_rule(primitive, "material", "materials"),
    {primitive, "mode", whole},
    replaceable_member_rule({primitive, "attributes", object, attributes}),
    object_member_rule(attributes, "POSITION", "accessors"),
    object_member_rule(attributes, "NORMAL", "accessors"),
    object_member_rule(attributes, "TEXCOORD_0", "accessors"),
    object_member_rule(attributes, "TEXCOORD_1", "accessors"),
    object_member_rule(attributes, "COLOR_0", "accessors"),
    object_member_rule(attributes, "JOINTS_0", "accessors"),
    object_member_rule(attributes, "WEIGHTS_0", "accessors"),
    object_member_rule(primitive, "indices", "accessors"),
    list_member_rule(primitive, "targets", morph),
    object_member_rule(morph, "POSITION", "accessors"),
    object_member_rule(morph, "NORMAL", "accessors"),

    list_member_rule<tinygltf::Node>(file, "nodes", node, &BudgetAccount::nodes),
    {node, "name", text},
    object_member_rule(node, "mesh", "meshes"),
    object_member_rule(node, "camera", "cameras"),
    object_member_rule(node, "children", "nodes", indices),
    vector_member_rule(node, "matrix", 16),
    vector_member_rule(node, "rotation", 4),
    vector_member_rule(node, "scale", 3),
    vector_member_rule(node, "translation", 3),
    object_member_rule(node, "skin", "skins"),
    list_member_rule<tinygltf::Skin>(file, "skins", skin),
    object_member_rule(skin, "joints", "nodes", indices),
    object_member_rule(skin, "skeleton", "nodes"),
    object_member_rule(skin, "inverseBindMatrices", "accessors"),

    object_member_rule(file, "scene", "scenes"),
    list_member_rule<tinygltf::Scene>(file, "scenes", scene),
    object_member_rule(scene, "nodes", "nodes", indices),

    list_member_rule<tinygltf::Animation>(file, "animations", animation),
    {animation, "name", text},
    list_member_rule<tinygltf::AnimationChannel>(animation, "channels", channel,
                                                 &BudgetAccount::channels),
    {channel, "sampler", whole},
    {channel, "target", object, target},
    object_member_rule(target, "node", "nodes"),
    {target, "path", text},
    list_member_rule<tinygltf::AnimationSampler>(animation, "samplers", sampler),
    replaceable_member_rule(object_member_rule(sampler, "input", "accessors")),
    replaceable_member_rule(object_member_rule(sampler, "output", "accessors")),
    {sampler, "interpolation", text},
};

class MemberChecker {
public:
    MemberChecker(const JsonObject& root, BudgetAccount& account, LoaderNotes& notes)
        : root_(root), account_(account), notes_(notes) {}

    void object(const JsonObject& item, GltfObjectKind in) {
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
        if (member.kind == MemberKind::object) object(*item.object(key), member.is);
        if (!member.note.empty()) notes_.add(member.note, item.entry());
    }
    void each(const JsonObject& item, const MemberRule& member) {
        item.each(member.key, [&](const JsonObject& one) {
            if (member.total != nullptr) (account_.*member.total).add(1, one.place());
            account_.json_memory.add(member.bytes, one.place());
            object(one, member.is);
            if (!member.note.empty()) notes_.add(member.note, one.entry());
        });
    }

    const JsonObject& root_;
    BudgetAccount& account_;
    LoaderNotes& notes_;
};

Json read_members(Json& from, GltfObjectKind in);

/// Converts a member to a form that tinygltf reads. For example, it does not accept 3.0 as an
/// integer.
Json read_member(Json& value, const MemberRule& member) {
    if (member.kind == flag) return value.get<bool>();
    const auto counted = [](const Json& number) { return number.get<std::uint64_t>(); };
    if (member.kind == MemberKind::object) return read_members(value, member.is);
    if (member.kind == MemberKind::number)
        return value.get<double>(); // tinygltf cuts others to 32 bits
    if (member.kind == MemberKind::list)
        for (Json& one : value) one = read_members(one, member.is);
    else if (member.kind == MemberKind::indices)
        for (Json& one : value) one = counted(one);
    else if (member.kind != MemberKind::text && member.kind != MemberKind::numbers)
        return counted(value);
    return std::move(value);
}

/// Returns the members of an object that are read. Adds placeholders that tinygltf needs.
Json read_members(Json& from, GltfObjectKind in) {
    Json to = Json::object();
    for (const MemberRule& member : kMemberRules) {
        if (member.in != in || member.unread) continue;
        const auto at = from.find(member.key);
        if (at != from.end()) {
            to[std::string(member.key)] = read_member(*at, member);
        } else if (member.made_up) {
            Json nothing = Json::object();
            to[std::string(member.key)] = member.kind == MemberKind::object
                                              ? read_members(nothing, member.is)
                                          : member.kind == MemberKind::index ? Json(-1)
                                                                             : Json(0);
        }
    }
    return to;
}

} // namespace

void check_known_members(const JsonObject& root, BudgetAccount& account, LoaderNotes& notes) {
    MemberChecker(root, account, notes).object(root, GltfObjectKind::file);
}

Json keep_known_members(Json document) { return read_members(document, GltfObjectKind::file); }

} // namespace catoptric::scene::gltf
