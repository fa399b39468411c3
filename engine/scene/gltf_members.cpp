#include "scene/gltf_check.hpp"
#include "scene/material.hpp"

#include <tiny_gltf.h>

namespace catoptric::scene::gltf {

namespace {

/// The kinds of objects in a glTF file whose members are checked.
// clang-format off
enum class In {
    nothing, file, asset, view, accessor, sparse, sparse_part, material, texture_use, camera,
    perspective, orthographic, mesh, primitive, attributes, morph, node, scene, animation, channel,
    target, sampler, skin, texture, image
};
// clang-format on

enum class Kind { text, flag, number, numbers, whole, index, needed_index, indices, object, list };

/// One row of the member table: the type that a member must have, and how it is used.
struct Member {
    In in;
    std::string_view key;
    Kind kind;
    In is = In::nothing;             ///< kind of the object, or of each object of the list
    std::string_view of = {};        ///< the list that the index refers to
    std::size_t count = 0;           ///< how many numbers
    bool unread = false;             ///< only checked, not passed to tinygltf
    std::string_view note = {};      ///< the note to add if the member is present
    bool made_up = false;            ///< if absent, set to -1 (index) or 0, since tinygltf needs it
    Total Account::*total = nullptr; ///< counts the objects of the list
    std::size_t bytes = 0;           ///< memory for each object of the list
};

constexpr Member vector(In in, std::string_view key, std::size_t count) {
    return {.in = in, .key = key, .kind = Kind::numbers, .count = count};
}
constexpr Member one_of(In in, std::string_view key, std::string_view of, Kind kind = Kind::index) {
    return {.in = in, .key = key, .kind = kind, .of = of};
}
template <typename Made = char>
constexpr Member list_of(In in, std::string_view key, In is, Total Account::*total = nullptr) {
    return {in, key, Kind::list, is, {}, 0, false, {}, false, total, sizeof(Made)};
}
constexpr Member made_up(Member member) {
    member.made_up = true;
    return member;
}
constexpr Member unread(Member member, std::string_view note = {}) {
    member.unread = true, member.note = note;
    return member;
}

using enum In;
using enum Kind;

constexpr Member kMembers[] = {
    {file, "asset", object, asset},
    {asset, "version", text},

    list_of<tinygltf::BufferView>(file, "bufferViews", view),
    one_of(view, "buffer", "buffers", needed_index),
    {view, "byteOffset", whole},
    {view, "byteLength", whole},
    {view, "byteStride", whole},

    list_of<tinygltf::Accessor>(file, "accessors", accessor),
    one_of(accessor, "bufferView", "bufferViews"),
    {accessor, "byteOffset", whole},
    {accessor, "componentType", whole},
    {accessor, "count", whole},
    {accessor, "normalized", flag},
    {accessor, "type", text},
    {accessor, "sparse", object, sparse},
    {sparse, "count", whole},
    {sparse, "indices", object, sparse_part},
    {sparse, "values", object, sparse_part},
    one_of(sparse_part, "bufferView", "bufferViews"),
    {sparse_part, "byteOffset", whole},
    {sparse_part, "componentType", whole},

    unread(list_of<Material>(file, "materials", material, &Account::materials)),
    {material, "name", text},
    {material, "normalTexture", object, texture_use},
    {material, "occlusionTexture", object, texture_use},
    one_of(texture_use, "index", "textures", needed_index),
    unread(list_of<tinygltf::Texture>(file, "textures", texture)),
    one_of(texture, "source", "images"),
    one_of(texture, "sampler", "samplers"),
    unread(list_of<tinygltf::Image>(file, "images", image)),
    one_of(image, "bufferView", "bufferViews"),
    {image, "uri", text},

    list_of<tinygltf::Camera>(file, "cameras", camera, &Account::cameras),
    {camera, "name", text},
    {camera, "type", text},
    made_up({camera, "perspective", object, perspective}),
    made_up({perspective, "yfov", number}),
    made_up({perspective, "znear", number}),
    made_up({camera, "orthographic", object, orthographic}),
    made_up({orthographic, "xmag", number}),
    made_up({orthographic, "ymag", number}),
    made_up({orthographic, "zfar", number}),
    made_up({orthographic, "znear", number}),

    list_of<tinygltf::Mesh>(file, "meshes", mesh, &Account::meshes),
    {mesh, "name", text},
    list_of<tinygltf::Primitive>(mesh, "primitives", primitive, &Account::primitives),
    one_of(primitive, "material", "materials"),
    {primitive, "mode", whole},
    made_up({primitive, "attributes", object, attributes}),
    one_of(attributes, "POSITION", "accessors"),
    one_of(attributes, "NORMAL", "accessors"),
    one_of(attributes, "TEXCOORD_0", "accessors"),
    one_of(attributes, "TEXCOORD_1", "accessors"),
    one_of(attributes, "COLOR_0", "accessors"),
    one_of(attributes, "JOINTS_0", "accessors"),
    one_of(attributes, "WEIGHTS_0", "accessors"),
    one_of(primitive, "indices", "accessors"),
    list_of(primitive, "targets", morph),
    one_of(morph, "POSITION", "accessors"),
    one_of(morph, "NORMAL", "accessors"),

    list_of<tinygltf::Node>(file, "nodes", node, &Account::nodes),
    {node, "name", text},
    one_of(node, "mesh", "meshes"),
    one_of(node, "camera", "cameras"),
    one_of(node, "children", "nodes", indices),
    vector(node, "matrix", 16),
    vector(node, "rotation", 4),
    vector(node, "scale", 3),
    vector(node, "translation", 3),
    one_of(node, "skin", "skins"),
    list_of<tinygltf::Skin>(file, "skins", skin),
    one_of(skin, "joints", "nodes", indices),
    one_of(skin, "skeleton", "nodes"),
    one_of(skin, "inverseBindMatrices", "accessors"),

    one_of(file, "scene", "scenes"),
    list_of<tinygltf::Scene>(file, "scenes", scene),
    one_of(scene, "nodes", "nodes", indices),

    list_of<tinygltf::Animation>(file, "animations", animation),
    {animation, "name", text},
    list_of<tinygltf::AnimationChannel>(animation, "channels", channel, &Account::channels),
    {channel, "sampler", whole},
    {channel, "target", object, target},
    one_of(target, "node", "nodes"),
    {target, "path", text},
    list_of<tinygltf::AnimationSampler>(animation, "samplers", sampler),
    made_up(one_of(sampler, "input", "accessors")),
    made_up(one_of(sampler, "output", "accessors")),
    {sampler, "interpolation", text},
};

class Checker {
public:
    Checker(const Item& root, Account& account, Notes& notes)
        : root_(root), account_(account), notes_(notes) {}

    void object(const Item& item, In in) {
        for (const Member& member : kMembers)
            if (member.in == in) check_member(item, member);
    }

private:
    void check_member(const Item& item, const Member& member) {
        const std::string_view key = member.key;
        if (member.kind == Kind::list) return each(item, member);
        if (member.kind == Kind::needed_index) item.needed_index(key, root_.size(member.of));
        if (!item.has(key)) return;
        if (member.kind == Kind::text) item.text(key);
        if (member.kind == Kind::flag) item.flag(key, false);
        if (member.kind == Kind::number) item.number(key, 0);
        if (member.kind == Kind::numbers) item.numbers(key, member.count);
        if (member.kind == Kind::whole) item.whole(key, 0);
        if (member.kind == Kind::index) item.index(key, root_.size(member.of));
        if (member.kind == Kind::indices) item.indices(key, root_.size(member.of));
        if (member.kind == Kind::object) object(*item.object(key), member.is);
        if (!member.note.empty()) notes_.add(member.note, item.entry());
    }
    void each(const Item& item, const Member& member) {
        item.each(member.key, [&](const Item& one) {
            if (member.total != nullptr) (account_.*member.total).add(1, one.place());
            account_.json_memory.add(member.bytes, one.place());
            object(one, member.is);
            if (!member.note.empty()) notes_.add(member.note, one.entry());
        });
    }

    const Item& root_;
    Account& account_;
    Notes& notes_;
};

Json read_members(Json& from, In in);

/// Converts a member to a form that tinygltf reads. For example, it does not accept 3.0 as an
/// integer.
Json read_member(Json& value, const Member& member) {
    if (member.kind == flag) return value.get<bool>();
    const auto counted = [](const Json& number) { return number.get<std::uint64_t>(); };
    if (member.kind == Kind::object) return read_members(value, member.is);
    if (member.kind == Kind::number) return value.get<double>(); // tinygltf cuts others to 32 bits
    if (member.kind == Kind::list)
        for (Json& one : value) one = read_members(one, member.is);
    else if (member.kind == Kind::indices)
        for (Json& one : value) one = counted(one);
    else if (member.kind != Kind::text && member.kind != Kind::numbers)
        return counted(value);
    return std::move(value);
}

/// Returns the members of an object that are read. Adds placeholders that tinygltf needs.
Json read_members(Json& from, In in) {
    Json to = Json::object();
    for (const Member& member : kMembers) {
        if (member.in != in || member.unread) continue;
        const auto at = from.find(member.key);
        if (at != from.end()) {
            to[std::string(member.key)] = read_member(*at, member);
        } else if (member.made_up) {
            Json nothing = Json::object();
            to[std::string(member.key)] = member.kind == Kind::object
                                              ? read_members(nothing, member.is)
                                          : member.kind == Kind::index ? Json(-1)
                                                                       : Json(0);
        }
    }
    return to;
}

} // namespace

void check_members(const Item& root, Account& account, Notes& notes) {
    Checker(root, account, notes).object(root, In::file);
}

Json what_is_read(Json document) { return read_members(document, In::file); }

} // namespace catoptric::scene::gltf
