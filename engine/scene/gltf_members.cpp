#include "scene/gltf_check.hpp"

#include <tiny_gltf.h>

namespace catoptric::scene::gltf {

namespace {

/// The objects of a glTF file that have something to say to us.
enum class In {
    file,
    asset,
    view,
    accessor,
    sparse,
    sparse_part,
    material,
    pbr,
    extensions,
    strength,
    texture_use,
    camera,
    perspective,
    orthographic,
    mesh,
    primitive,
    attributes,
    node,
    scene,
    animation,
    channel,
    target,
    sampler,
    skin,
    texture,
    image,
    nothing,
};

enum class Kind { text, flag, number, numbers, whole, index, needed_index, indices, object, list };

/// What a member of an object must be, and what becomes of it.
struct Member {
    In in;
    std::string_view key;
    Kind kind;
    In is = In::nothing;             ///< the object, or each one of the list
    std::string_view of = {};        ///< the list that an index is of
    std::size_t count = 0;           ///< of numbers
    bool needed_there = false;       ///< tinygltf wants it: where absent it is -1 as an index, or 0
    bool unread = false;             ///< checked only
    std::string_view note = {};      ///< what is said of it when it is there
    Total Account::*total = nullptr; ///< each one of the list counts here,
    std::size_t bytes = 0;           ///< and takes so much memory
};

constexpr Member text(In in, std::string_view key) { return {in, key, Kind::text}; }
constexpr Member flag(In in, std::string_view key) { return {in, key, Kind::flag}; }
constexpr Member whole(In in, std::string_view key) { return {in, key, Kind::whole}; }
constexpr Member number(In in, std::string_view key) { return {in, key, Kind::number}; }
constexpr Member numbers(In in, std::string_view key, std::size_t count) {
    return {.in = in, .key = key, .kind = Kind::numbers, .count = count};
}
constexpr Member index(In in, std::string_view key, std::string_view of) {
    return {.in = in, .key = key, .kind = Kind::index, .of = of};
}
constexpr Member needed_index(In in, std::string_view key, std::string_view of) {
    return {.in = in, .key = key, .kind = Kind::needed_index, .of = of};
}
constexpr Member indices(In in, std::string_view key, std::string_view of) {
    return {.in = in, .key = key, .kind = Kind::indices, .of = of};
}
constexpr Member object(In in, std::string_view key, In is) { return {in, key, Kind::object, is}; }
template <typename Made = char>
constexpr Member list(std::string_view key, In is, Total Account::*total = nullptr,
                      In in = In::file) {
    return {
        .in = in, .key = key, .kind = Kind::list, .is = is, .total = total, .bytes = sizeof(Made)};
}
constexpr Member there(Member member) {
    member.needed_there = true;
    return member;
}
constexpr Member unread(Member member, std::string_view note = {}) {
    member.unread = true, member.note = note;
    return member;
}

constexpr Member kMembers[] = {
    object(In::file, "asset", In::asset),
    text(In::asset, "version"),

    list<tinygltf::BufferView>("bufferViews", In::view),
    needed_index(In::view, "buffer", "buffers"),
    whole(In::view, "byteOffset"),
    whole(In::view, "byteLength"),
    whole(In::view, "byteStride"),

    list<tinygltf::Accessor>("accessors", In::accessor),
    index(In::accessor, "bufferView", "bufferViews"),
    whole(In::accessor, "byteOffset"),
    whole(In::accessor, "componentType"),
    whole(In::accessor, "count"),
    text(In::accessor, "type"),
    object(In::accessor, "sparse", In::sparse),
    whole(In::sparse, "count"),
    object(In::sparse, "indices", In::sparse_part),
    object(In::sparse, "values", In::sparse_part),
    index(In::sparse_part, "bufferView", "bufferViews"),
    whole(In::sparse_part, "byteOffset"),
    whole(In::sparse_part, "componentType"),

    list<tinygltf::Material>("materials", In::material, &Account::materials),
    text(In::material, "name"),
    object(In::material, "pbrMetallicRoughness", In::pbr),
    numbers(In::pbr, "baseColorFactor", 4),
    number(In::pbr, "metallicFactor"),
    number(In::pbr, "roughnessFactor"),
    numbers(In::material, "emissiveFactor", 3),
    flag(In::material, "doubleSided"),
    object(In::material, "extensions", In::extensions),
    object(In::extensions, kEmissiveStrength, In::strength),
    number(In::strength, "emissiveStrength"),
    unread(object(In::pbr, "baseColorTexture", In::texture_use),
           "materials with a baseColorTexture, drawn without it"),
    unread(object(In::pbr, "metallicRoughnessTexture", In::texture_use),
           "materials with a metallicRoughnessTexture, drawn without it"),
    unread(object(In::material, "normalTexture", In::texture_use),
           "materials with a normalTexture, drawn without it"),
    unread(object(In::material, "occlusionTexture", In::texture_use),
           "materials with a occlusionTexture, drawn without it"),
    unread(object(In::material, "emissiveTexture", In::texture_use),
           "materials with a emissiveTexture, drawn without it"),
    needed_index(In::texture_use, "index", "textures"),
    unread(list("textures", In::texture)),
    index(In::texture, "source", "images"),
    index(In::texture, "sampler", "samplers"),
    unread(list("images", In::image), "images, not read"),
    index(In::image, "bufferView", "bufferViews"),
    text(In::image, "uri"),

    list<tinygltf::Camera>("cameras", In::camera, &Account::cameras),
    text(In::camera, "name"),
    text(In::camera, "type"),
    there(object(In::camera, "perspective", In::perspective)),
    there(number(In::perspective, "yfov")),
    there(number(In::perspective, "znear")),
    there(object(In::camera, "orthographic", In::orthographic)),
    there(number(In::orthographic, "xmag")),
    there(number(In::orthographic, "ymag")),
    there(number(In::orthographic, "zfar")),
    there(number(In::orthographic, "znear")),

    list<tinygltf::Mesh>("meshes", In::mesh, &Account::meshes),
    text(In::mesh, "name"),
    list<tinygltf::Primitive>("primitives", In::primitive, &Account::primitives, In::mesh),
    index(In::primitive, "material", "materials"),
    whole(In::primitive, "mode"),
    there(object(In::primitive, "attributes", In::attributes)),
    index(In::attributes, "POSITION", "accessors"),
    index(In::attributes, "NORMAL", "accessors"),
    unread(index(In::attributes, "COLOR_0", "accessors"),
           "primitives with colours at vertices, not read"),
    index(In::primitive, "indices", "accessors"),
    unread(list("targets", In::nothing, nullptr, In::primitive), "morph targets, not read"),

    list<tinygltf::Node>("nodes", In::node, &Account::nodes),
    text(In::node, "name"),
    index(In::node, "mesh", "meshes"),
    index(In::node, "camera", "cameras"),
    indices(In::node, "children", "nodes"),
    numbers(In::node, "matrix", 16),
    numbers(In::node, "rotation", 4),
    numbers(In::node, "scale", 3),
    numbers(In::node, "translation", 3),
    unread(index(In::node, "skin", "skins"), "nodes with a skin, not posed"),
    unread(list("skins", In::skin)),
    indices(In::skin, "joints", "nodes"),
    index(In::skin, "skeleton", "nodes"),
    index(In::skin, "inverseBindMatrices", "accessors"),

    index(In::file, "scene", "scenes"),
    list<tinygltf::Scene>("scenes", In::scene),
    indices(In::scene, "nodes", "nodes"),

    list<tinygltf::Animation>("animations", In::animation),
    text(In::animation, "name"),
    list<tinygltf::AnimationChannel>("channels", In::channel, &Account::channels, In::animation),
    whole(In::channel, "sampler"),
    object(In::channel, "target", In::target),
    index(In::target, "node", "nodes"),
    text(In::target, "path"),
    list<tinygltf::AnimationSampler>("samplers", In::sampler, nullptr, In::animation),
    there(index(In::sampler, "input", "accessors")),
    there(index(In::sampler, "output", "accessors")),
    text(In::sampler, "interpolation"),
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

/// What is there, as tinygltf understands it: of whole numbers it does not take 3.0.
Json read_member(Json& value, const Member& member) {
    const auto whole = [](const Json& number) { return number.get<std::uint64_t>(); };
    if (member.kind == Kind::flag) return value.get<bool>();
    if (member.kind == Kind::object) return read_members(value, member.is);
    if (member.kind == Kind::number) return value.get<double>(); // and cuts others to 32 bits
    if (member.kind == Kind::list)
        for (Json& one : value) one = read_members(one, member.is);
    else if (member.kind == Kind::indices)
        for (Json& one : value) one = whole(one);
    else if (member.kind != Kind::text && member.kind != Kind::numbers)
        return whole(value);
    return std::move(value);
}

/// Takes from an object what is read; what tinygltf wants beyond that is made up.
Json read_members(Json& from, In in) {
    Json to = Json::object();
    for (const Member& member : kMembers) {
        if (member.in != in || member.unread) continue;
        const auto at = from.find(member.key);
        if (at != from.end()) {
            to[std::string(member.key)] = read_member(*at, member);
        } else if (member.needed_there) {
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
