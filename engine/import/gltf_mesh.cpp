#include "import/gltf_model.hpp"
#include "scene/transform.hpp"
#include "scene/unsupported_feature.hpp"

#include <algorithm>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace catoptric::scene::gltf {

namespace {

std::string mesh_label(const Document& document, std::size_t mesh) {
    return item_label("meshes", mesh, document.model.meshes[mesh].name);
}

/// Returns the indices of the vertices that a mesh keeps, ascending. Keeps all `count` positions if
/// there are at most as many as corners. Otherwise keeps only those that corners use, because
/// primitives may share a long list.
std::vector<std::uint32_t> used_vertices(const std::vector<std::uint32_t>& corners,
                                         std::size_t count) {
    std::vector<std::uint32_t> vertices = corners;
    if (count <= corners.size()) {
        vertices.resize(count);
        std::iota(vertices.begin(), vertices.end(), 0u);
        return vertices;
    }
    std::ranges::sort(vertices);
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

/// Appends values to a list of vertex data. Vertices before `before` get the value `otherwise`. The
/// list stays empty until a primitive has values for it.
template <typename Value>
void fill_start(std::vector<Value>& list, std::size_t before, const Value& otherwise) {
    if (list.size() < before) list.resize(before, otherwise);
}

void append_vertices(Mesh& mesh, const std::vector<std::uint32_t>& used,
                     const GltfPrimitive& primitive, const std::vector<dmat4>* joints) {
    const std::size_t before = mesh.positions.size();
    for (const std::uint32_t vertex : used) {
        auto [position, normal] = primitive.vertex(vertex);
        if (joints && primitive.joints) primitive.pose(vertex, *joints, position, normal);
        mesh.positions.push_back(position), mesh.normals.push_back(vec3(normal));
    }
    for (std::size_t set = 0; set < mesh.uv.size(); ++set) {
        if (!primitive.uv[set] && mesh.uv[set].empty()) continue;
        fill_start(mesh.uv[set], before, vec2(0));
        for (const std::uint32_t vertex : used)
            mesh.uv[set].push_back(primitive.uv[set]
                                       ? vec2(read_number(*primitive.uv[set], vertex, 0),
                                              read_number(*primitive.uv[set], vertex, 1))
                                       : vec2(0));
    }
    if (!primitive.colours && mesh.colours.empty()) return;
    fill_start(mesh.colours, before, vec4(1));
    for (const std::uint32_t vertex : used) mesh.colours.push_back(primitive.colour(vertex));
}

/// Adds a primitive's triangles and their vertices to the mesh.
void append_triangles(Mesh& mesh, std::vector<std::uint32_t> corners,
                      const GltfPrimitive& primitive, const std::vector<dmat4>* joints) {
    const std::vector<std::uint32_t> used = used_vertices(corners, primitive.positions.count);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    append_vertices(mesh, used, primitive, joints);
    const bool is_all = used.size() == primitive.positions.count;
    for (std::uint32_t& corner : corners)
        corner = first + (is_all ? corner
                                 : static_cast<std::uint32_t>(
                                       std::ranges::lower_bound(used, corner) - used.begin()));
    for (std::size_t i = 0; i < corners.size(); i += 3)
        mesh.triangles.emplace_back(corners[i], corners[i + 1], corners[i + 2]);
}

/// Returns whether the primitive is drawn. Adds a note if it is not.
bool is_drawn(const tinygltf::Primitive& primitive, const std::string& label,
              ReadContext& context) {
    if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
        context.notes.add("primitives of points or lines, left out", label);
        add_unsupported(context.unsupported, "points-lines", label);
        return false;
    }
    const bool has_place = primitive.attributes.contains("POSITION");
    context.notes.add("primitives without positions, left out", label, has_place ? 0 : 1);
    return has_place;
}

std::vector<MeshPart> group_by_material(std::size_t mesh, std::vector<Material>& materials,
                                        ReadContext& context) {
    const Document& document = context.document;
    std::vector<MeshPart> parts;
    std::unordered_map<std::size_t, std::size_t> part_of; // part by material
    const std::vector<tinygltf::Primitive>& primitives = document.model.meshes[mesh].primitives;
    for (std::size_t i = 0; i < primitives.size(); ++i) {
        const std::string label = mesh_label(document, mesh) + ": " + item_label("primitives", i);
        if (!is_drawn(primitives[i], label, context)) continue;
        check_primitive(primitives[i], document.file + ": " + label, context);
        if (!primitives[i].targets.empty()) {
            context.notes.add("primitives with morph targets, in their default shape", label);
            add_unsupported(context.unsupported, "morph", label);
        }
        const bool has_none = primitives[i].material < 0;
        if (has_none && materials.size() == document.materials.size())
            materials.push_back({.name = "default", .albedo = vec3(1), .front_only = true});
        const std::size_t material = has_none ? document.materials.size()
                                              : std::size_t(primitives[i].material);
        const auto [entry, is_new] = part_of.try_emplace(material, parts.size());
        if (is_new) parts.push_back({.material = material});
        parts[entry->second].primitives.push_back(i);
    }
    return parts;
}

} // namespace

std::vector<std::vector<MeshPart>> read_mesh_parts(std::vector<Material>& materials,
                                                   ReadContext& context) {
    std::vector<std::vector<MeshPart>> parts;
    for (std::size_t mesh = 0; mesh < context.document.model.meshes.size(); ++mesh)
        parts.push_back(group_by_material(mesh, materials, context));
    return parts;
}

Mesh build_part(std::size_t index, const MeshPart& part, const std::vector<double>& weights,
                const ReadContext& context, const std::vector<dmat4>* joints) {
    const tinygltf::Model& model = context.document.model;
    const std::string place = mesh_place(context.document, index);
    LoadAccount& account = context.account;
    std::vector<GltfPrimitive> primitives;
    std::size_t vertices = 0, triangles = 0;
    for (const std::size_t i : part.primitives) { // count against the budget before allocating
        const GltfPrimitive& its = primitives.emplace_back(model, model.meshes[index].primitives[i],
                                                           weights);
        const std::size_t count = std::min(its.positions.count, 3 * its.triangle_count());
        account.mesh_triangles.add(its.triangle_count(), place);
        account.mesh_vertices.add(count, place);
        vertices += count, triangles += its.triangle_count();
    }
    Mesh mesh{.name = model.meshes[index].name};
    account.name_bytes.add(mesh.name.size(), place);
    mesh.positions.reserve(vertices), mesh.normals.reserve(vertices);
    mesh.triangles.reserve(triangles);
    for (const GltfPrimitive& primitive : primitives)
        append_triangles(mesh, triangle_corners(primitive, place), primitive, joints);
    return mesh;
}

std::string mesh_place(const Document& document, std::size_t mesh) {
    return document.file + ": " + mesh_label(document, mesh);
}

namespace {

template <typename Attributes>
int find_attribute(const Attributes& attributes, const std::string& name) {
    const auto at = attributes.find(name);
    return at == attributes.end() ? -1 : at->second;
}

template <typename Attributes>
std::optional<AccessorElements> read_attribute(const tinygltf::Model& model,
                                               const Attributes& attributes,
                                               const std::string& name) {
    const int accessor = find_attribute(attributes, name);
    return accessor < 0 ? std::nullopt : std::optional(read_elements(model, accessor));
}

/// A vertex attribute besides the position, with its allowed types and component types.
struct AttributeRule {
    const char* name;
    std::string_view what;
    int type, other_type;
    ReadContext::AllowedIntegers also;
};
constexpr AttributeRule kAttributeRules[] = {
    {"NORMAL", "normals", TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC3,
     ReadContext::AllowedIntegers::quantised},
    {"TEXCOORD_0", "texture coordinates", TINYGLTF_TYPE_VEC2, TINYGLTF_TYPE_VEC2,
     ReadContext::AllowedIntegers::quantised},
    {"TEXCOORD_1", "texture coordinates", TINYGLTF_TYPE_VEC2, TINYGLTF_TYPE_VEC2,
     ReadContext::AllowedIntegers::quantised},
    {"COLOR_0", "colours", TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC4,
     ReadContext::AllowedIntegers::normalised},
    {"WEIGHTS_0", "weights", TINYGLTF_TYPE_VEC4, TINYGLTF_TYPE_VEC4,
     ReadContext::AllowedIntegers::normalised}};

void check_count(std::size_t found, std::size_t wanted, std::string_view what,
                 const std::string& place) {
    check(found == wanted, Failure::bad_data, place, ": wanted ", wanted, " ", what,
          ", one for each position, found ", found);
}

std::size_t count_clamped_colours(const AccessorElements& colours) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < colours.count; ++i) {
        bool is_clamped = false;
        for (int channel = 0; channel < colours.width; ++channel)
            is_clamped |= is_clamped_factor(read_number(colours, i, channel));
        count += is_clamped;
    }
    return count;
}

void check_attributes(const tinygltf::Primitive& primitive, std::size_t count,
                      const std::string& place, ReadContext& context) {
    for (const auto& [name, what, type, other, also] : kAttributeRules) {
        const int accessor = find_attribute(primitive.attributes, name);
        if (accessor < 0) continue;
        const int its = context.document.model.accessors[std::size_t(accessor)].type;
        // Normalised texture coordinates need no extension; normals and positions need one.
        const bool is_uv = type == TINYGLTF_TYPE_VEC2;
        const ReadContext::AllowedIntegers allowed = is_uv && !context.document.is_quantised
                                                         ? ReadContext::AllowedIntegers::normalised
                                                         : also;
        LoadAccount& account = context.account;
        LimitedSum& total = also == kAttributeRules[0].also && !is_uv ? account.normals
                                                                      : account.attributes;
        const AccessorElements found = context.floats(accessor, its == other ? other : type, total,
                                                      place + ": " + name, allowed);
        check_count(found.count, count, what, place);
        if (std::string_view(name) == "COLOR_0")
            context.notes.add(kClampedFactorNote, place + ": COLOR_0",
                              count_clamped_colours(found));
    }
    if (const int joints = find_attribute(primitive.attributes, "JOINTS_0"); joints >= 0)
        check_count(context.whole(joints, place + ": JOINTS_0", TINYGLTF_TYPE_VEC4).count, count,
                    "joints", place);
    for (const auto& target : primitive.targets)
        for (const char* name : {"POSITION", "NORMAL"})
            if (const int accessor = find_attribute(target, name); accessor >= 0)
                check_count(context
                                .floats(accessor, TINYGLTF_TYPE_VEC3, context.account.attributes,
                                        place + ": targets: " + name,
                                        ReadContext::AllowedIntegers::quantised)
                                .count,
                            count, "morph target values", place + ": targets");
}

} // namespace

void check_primitive(const tinygltf::Primitive& primitive, const std::string& place,
                     ReadContext& context) {
    const std::string attributes = place + ": attributes";
    const std::size_t count = context
                                  .floats(find_attribute(primitive.attributes, "POSITION"),
                                          TINYGLTF_TYPE_VEC3, context.account.positions,
                                          attributes + ": POSITION",
                                          ReadContext::AllowedIntegers::quantised)
                                  .count;
    check_attributes(primitive, count, attributes, context);
    const std::size_t corners = primitive.indices < 0
                                    ? count
                                    : context.whole(primitive.indices, place + ": indices").count;
    check(primitive.mode != TINYGLTF_MODE_TRIANGLES || corners % 3 == 0, Failure::bad_data, place,
          ": wanted three corners for each triangle, found ", corners, " corners");
}

GltfPrimitive::GltfPrimitive(const tinygltf::Model& model, const tinygltf::Primitive& from,
                             const std::vector<double>& weights_of_targets)
    : mode(from.mode),
      positions(read_elements(model, find_attribute(from.attributes, "POSITION"))) {
    const auto of = [&](const char* name) { return read_attribute(model, from.attributes, name); };
    normals = of("NORMAL"), colours = of("COLOR_0");
    uv = {of("TEXCOORD_0"), of("TEXCOORD_1")};
    joints = of("JOINTS_0"), weights = of("WEIGHTS_0");
    if (!weights) joints.reset();
    if (from.indices >= 0) indices = read_elements(model, from.indices);
    for (std::size_t i = 0; i < std::min(from.targets.size(), weights_of_targets.size()); ++i)
        if (weights_of_targets[i] != 0)
            morphs.push_back({weights_of_targets[i],
                              read_attribute(model, from.targets[i], "POSITION"),
                              read_attribute(model, from.targets[i], "NORMAL")});
}

std::size_t GltfPrimitive::triangle_count() const {
    const std::size_t corners = indices ? indices->count : positions.count;
    if (mode == TINYGLTF_MODE_TRIANGLES) return corners / 3;
    return corners < 3 ? 0 : corners - 2;
}

GltfVertex GltfPrimitive::vertex(std::size_t index) const {
    GltfVertex vertex{read_vector(positions, index),
                      normals ? normalized_or_zero(read_vector(*normals, index)) : dvec3(0)};
    for (const MorphTarget& morph : morphs) {
        if (morph.positions) vertex.position += morph.weight * read_vector(*morph.positions, index);
        if (morph.normals && normals)
            vertex.normal += morph.weight * read_vector(*morph.normals, index);
    }
    return vertex;
}

vec4 GltfPrimitive::colour(std::size_t index) const {
    vec4 colour(1);
    for (int i = 0; colours && i < colours->width; ++i)
        colour[i] = static_cast<float>(read_number(*colours, index, i));
    return glm::clamp(colour, 0.f, 1.f); // glTF 2.0, 3.7.2.1
}

void GltfPrimitive::pose(std::size_t index, const std::vector<dmat4>& world_from_bound,
                         dvec3& position, dvec3& normal) const {
    dmat4 world(0);
    double sum = 0;
    for (int i = 0; i < 4; ++i) {
        const double weight = read_number(*weights, index, i);
        const std::uint32_t joint = read_integer(*joints, index, i);
        if (weight == 0 || joint >= world_from_bound.size()) continue;
        world += weight * world_from_bound[joint];
        sum += weight;
    }
    if (!(sum > 0)) return; // no joint has weight, so the vertex stays
    world /= sum;           // the sum of quantised weights is not exactly 1
    position = transform_point(world, position);
    normal = normal_matrix(world) * normal;
}

std::vector<std::uint32_t> triangle_corners(const GltfPrimitive& primitive,
                                            const std::string& place) {
    const bool is_list = primitive.mode == TINYGLTF_MODE_TRIANGLES;
    std::vector<std::uint32_t> named(primitive.indices ? primitive.indices->count
                                                       : primitive.positions.count);
    std::iota(named.begin(), named.end(), 0u);
    const std::size_t count = primitive.positions.count;
    for (std::uint32_t& corner : named) {
        if (!primitive.indices) break;
        corner = read_integer(*primitive.indices, corner);
        check(corner < count, Failure::bad_data, place, ": indices: wanted indices below ", count,
              ", found ", corner);
        check(corner != restart_index(*primitive.indices), Failure::bad_data, place,
              ": indices: wanted a vertex, found ", corner, ", which begins a new primitive");
    }
    if (is_list) return named;
    std::vector<std::uint32_t> corners;
    corners.reserve(3 * primitive.triangle_count());
    for (std::uint32_t i = 0; i < primitive.triangle_count(); ++i) {
        if (primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN)
            corners.insert(corners.end(), {named[i + 1], named[i + 2], named[0]});
        else // in a strip, every second triangle has the opposite winding
            corners.insert(corners.end(), {named[i], named[i + 1 + i % 2], named[i + 2 - i % 2]});
    }
    return corners;
}

} // namespace catoptric::scene::gltf
