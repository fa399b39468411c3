#include "scene/gltf_model.hpp"

#include <algorithm>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace catoptric::scene::gltf {

namespace {

std::string mesh_label(const Document& document, std::size_t mesh) {
    return label_of("meshes", mesh, document.model.meshes[mesh].name);
}

int attribute(const tinygltf::Primitive& primitive, const char* name) {
    const auto at = primitive.attributes.find(name);
    return at == primitive.attributes.end() ? -1 : at->second;
}

/// The elements that a primitive is made of.
struct Primitive {
    Primitive(const tinygltf::Model& model, const tinygltf::Primitive& from)
        : positions(elements_of(model, attribute(from, "POSITION"))) {
        if (const int of = attribute(from, "NORMAL"); of >= 0) normals = elements_of(model, of);
        if (from.indices >= 0) indices = elements_of(model, from.indices);
    }
    std::size_t corners() const { return indices ? indices->count : positions.count; }

    Elements positions;
    std::optional<Elements> normals, indices;
};

void check_primitive(const tinygltf::Primitive& primitive, const std::string& place,
                     Context& context) {
    const std::string attributes = place + ": attributes";
    const int position = attribute(primitive, "POSITION"), normal = attribute(primitive, "NORMAL");
    check(position >= 0, Failure::bad_data, attributes, ": wanted POSITION, found none");
    Account& account = context.account;
    const std::size_t count = context
                                  .floats(position, TINYGLTF_TYPE_VEC3, account.positions,
                                          attributes + ": POSITION")
                                  .count;
    if (normal >= 0) {
        const std::size_t normals = context
                                        .floats(normal, TINYGLTF_TYPE_VEC3, account.normals,
                                                attributes + ": NORMAL")
                                        .count;
        check(normals == count, Failure::bad_data, attributes, ": wanted ", count,
              " normals, one for each position, found ", normals);
    }
    const std::size_t corners = primitive.indices < 0
                                    ? count
                                    : context.whole(primitive.indices, place + ": indices").count;
    check(corners % 3 == 0, Failure::bad_data, place,
          ": wanted three corners for each triangle, found ", corners, " corners");
}

/// Its triangles, as numbers of its positions.
std::vector<std::uint32_t> corners_of(const Primitive& primitive, const std::string& place) {
    std::vector<std::uint32_t> corners(primitive.corners());
    std::iota(corners.begin(), corners.end(), 0u);
    if (!primitive.indices) return corners;
    const std::size_t count = primitive.positions.count;
    for (std::uint32_t& corner : corners) {
        corner = whole_at(*primitive.indices, corner);
        check(corner < count, Failure::bad_data, place, ": indices: wanted indices below ", count,
              ", found ", corner);
        check(corner != restart_of(*primitive.indices), Failure::bad_data, place,
              ": indices: wanted a vertex, found ", corner, ", which begins a new primitive");
    }
    return corners;
}

/// The positions that corners name, ascending: all of them, unless there are more than corners,
/// as where primitives share a long list.
std::vector<std::uint32_t> vertices_of(const std::vector<std::uint32_t>& corners,
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

/// Adds the triangles and their vertices.
void append(Mesh& mesh, std::vector<std::uint32_t> corners, const Primitive& primitive) {
    const Elements& positions = primitive.positions;
    const std::optional<Elements>& normals = primitive.normals;
    const std::vector<std::uint32_t> used = vertices_of(corners, positions.count);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const std::uint32_t vertex : used) {
        mesh.positions.push_back(vector_at(positions, vertex));
        mesh.normals.push_back(normals ? vec3(vector_at(*normals, vertex)) : vec3(0));
    }
    const bool is_all = used.size() == positions.count;
    for (std::uint32_t& corner : corners)
        corner = first + (is_all ? corner
                                 : static_cast<std::uint32_t>(
                                       std::ranges::lower_bound(used, corner) - used.begin()));
    for (std::size_t i = 0; i < corners.size(); i += 3)
        mesh.triangles.emplace_back(corners[i], corners[i + 1], corners[i + 2]);
}

std::vector<Part> parts_of(std::size_t mesh, std::vector<Material>& materials, Context& context) {
    const std::string& file = context.document.file;
    const tinygltf::Model& model = context.document.model;
    std::vector<Part> parts;
    std::unordered_map<std::size_t, std::size_t> part_of; // by material
    const std::vector<tinygltf::Primitive>& primitives = model.meshes[mesh].primitives;
    for (std::size_t i = 0; i < primitives.size(); ++i) {
        const std::string label = mesh_label(context.document, mesh) + ": " +
                                  label_of("primitives", i);
        if (primitives[i].mode != TINYGLTF_MODE_TRIANGLES) {
            context.notes.add("primitives that are not made of triangles, left out", label);
            continue;
        }
        check_primitive(primitives[i], file + ": " + label, context);
        const bool has_none = primitives[i].material < 0;
        if (has_none && materials.size() == model.materials.size())
            materials.push_back({.name = "default", .albedo = vec3(1)});
        const std::size_t material = has_none ? model.materials.size()
                                              : std::size_t(primitives[i].material);
        const auto [entry, is_new] = part_of.try_emplace(material, parts.size());
        if (is_new) parts.push_back({.material = material});
        parts[entry->second].primitives.push_back(i);
    }
    return parts;
}

} // namespace

std::vector<std::vector<Part>> read_parts(std::vector<Material>& materials, Context& context) {
    std::vector<std::vector<Part>> parts;
    for (std::size_t mesh = 0; mesh < context.document.model.meshes.size(); ++mesh)
        parts.push_back(parts_of(mesh, materials, context));
    return parts;
}

Mesh mesh_of(std::size_t index, const Part& part, const Context& context) {
    const tinygltf::Model& model = context.document.model;
    const std::string place = mesh_place(context.document, index);
    Account& account = context.account;
    std::vector<Primitive> primitives;
    std::size_t vertices = 0, triangles = 0;
    for (const std::size_t i : part.primitives) { // before anything is made of it
        const Primitive& its = primitives.emplace_back(model, model.meshes[index].primitives[i]);
        const std::size_t count = std::min(its.positions.count, its.corners());
        account.mesh_triangles.add(its.corners() / 3, place);
        account.mesh_vertices.add(count, place);
        vertices += count, triangles += its.corners() / 3;
    }
    Mesh mesh{.name = model.meshes[index].name};
    account.name_bytes.add(mesh.name.size(), place);
    mesh.positions.reserve(vertices), mesh.normals.reserve(vertices);
    mesh.triangles.reserve(triangles);
    for (const Primitive& primitive : primitives)
        append(mesh, corners_of(primitive, place), primitive);
    return mesh;
}

std::string mesh_place(const Document& document, std::size_t mesh) {
    return document.file + ": " + mesh_label(document, mesh);
}

} // namespace catoptric::scene::gltf
