#include "scene/gltf_document.hpp"
#include "scene/repair.hpp"

#include <algorithm>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace catoptric::scene::gltf {

namespace {

constexpr std::uint64_t kTriangles = 4; // the mode; 0 .. 6

Primitive primitive_of(const Item& item, Context& context) {
    const std::size_t count = context.accessors.size();
    const std::optional<Item> attributes = item.object("attributes");
    item.require(attributes && attributes->has("POSITION"),
                 "attributes: wanted POSITION, found none");
    Primitive primitive{.positions = attributes->needed_index("POSITION", count),
                        .normals = attributes->index("NORMAL", count),
                        .indices = item.index("indices", count)};
    Account& account = context.account;
    const Accessor& positions = context.accessors.floats(
        primitive.positions, "VEC3", account.positions, attributes->place() + ": POSITION");
    if (primitive.normals) {
        const Accessor& normals = context.accessors.floats(
            *primitive.normals, "VEC3", account.normals, attributes->place() + ": NORMAL");
        attributes->require(normals.count == positions.count, "wanted ", positions.count,
                            " normals, one for each position, found ", normals.count);
    }
    const Accessor& corners = primitive.indices
                                  ? context.accessors.whole(*primitive.indices,
                                                            item.place() + ": indices")
                                  : positions;
    item.require(corners.count % 3 == 0, "wanted three corners for each triangle, found ",
                 corners.count, " corners");
    return primitive;
}

/// Its triangles, as numbers of its positions.
std::vector<std::uint32_t> corners_of(const Primitive& primitive, const Accessor& positions,
                                      const Accessors& accessors, const std::string& place) {
    std::vector<std::uint32_t> corners(primitive.indices ? accessors[*primitive.indices].count
                                                         : positions.count);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        if (!primitive.indices) {
            corners[i] = static_cast<std::uint32_t>(i);
            continue;
        }
        const Accessor& indices = accessors[*primitive.indices];
        const std::uint32_t index = corners[i] = whole_at(indices, i);
        check(index < positions.count, Failure::bad_data, place, ": indices: wanted indices below ",
              positions.count, ", found ", index);
        check(index != restart_of(indices.component), Failure::bad_data, place,
              ": indices: wanted a vertex, found ", index, ", which begins a new primitive");
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
void append(Mesh& mesh, std::vector<std::uint32_t> corners, const Accessor& positions,
            const Accessor* normals) {
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

} // namespace

std::vector<PrimitiveGroup> read_meshes(const Item& root, std::vector<Material>& materials,
                                        Context& context) {
    std::vector<PrimitiveGroup> groups;
    const std::size_t material_count = materials.size();
    root.each("meshes", [&](const Item& item) {
        context.account.meshes.add(1, item.place());
        PrimitiveGroup group{.name = item.name(), .place = item.place()};
        std::unordered_map<std::size_t, std::size_t> part_of; // by material
        item.each("primitives", [&](const Item& part) {
            context.account.primitives.add(1, part.place());
            const auto material = part.index("material", material_count);
            const std::uint64_t mode = part.whole("mode", kTriangles);
            part.require(mode <= 6, "mode: wanted 0 to 6, found ", mode);
            if (mode != kTriangles) {
                context.notes.add("primitives that are not made of triangles, left out",
                                  part.label());
                return;
            }
            if (!material && materials.size() == material_count)
                materials.push_back({.name = "default", .albedo = vec3(1)});
            const std::size_t its = material.value_or(material_count);
            const auto [entry, is_new] = part_of.try_emplace(its, group.parts.size());
            if (is_new) group.parts.push_back({.material = its});
            group.parts[entry->second].primitives.push_back(primitive_of(part, context));
        });
        groups.push_back(std::move(group));
    });
    return groups;
}

Mesh mesh_of(const PrimitiveGroup& group, const Part& part, Context& context) {
    const Accessors& accessors = context.accessors;
    std::size_t vertices = 0, triangles = 0;
    for (const Primitive& primitive : part.primitives) { // before anything is made of it
        const std::size_t positions = accessors[primitive.positions].count;
        const std::size_t corners = primitive.indices ? accessors[*primitive.indices].count
                                                      : positions;
        context.account.mesh_triangles.add(corners / 3, group.place);
        context.account.mesh_vertices.add(std::min(positions, corners), group.place);
        vertices += std::min(positions, corners), triangles += corners / 3;
    }
    context.account.name_bytes.add(group.name.size(), group.place);
    Mesh mesh{.name = group.name};
    mesh.positions.reserve(vertices), mesh.normals.reserve(vertices);
    mesh.triangles.reserve(triangles);
    for (const Primitive& primitive : part.primitives) {
        const Accessor& positions = accessors[primitive.positions];
        append(mesh, corners_of(primitive, positions, accessors, group.place), positions,
               primitive.normals ? &accessors[*primitive.normals] : nullptr);
    }
    return mesh;
}

} // namespace catoptric::scene::gltf
