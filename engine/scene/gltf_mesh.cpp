#include "scene/gltf_model.hpp"
#include "scene/gltf_primitive.hpp"
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

} // namespace catoptric::scene::gltf
