#include "core/text.hpp"
#include "scene/gltf_container.hpp"
#include "scene/gltf_document.hpp"
#include "scene/load.hpp"
#include "scene/repair.hpp"
#include "scene/transform.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

namespace catoptric::scene {

namespace {

using gltf::Document;
using gltf::Node;

/// Where a node stands, and how it moves in world space.
struct Placed {
    dmat4 world_from_node{1};
    Motion motion;
    bool reached = false;
};

/// The node's own translation relative to its rest, carried into the world; else its parent's.
Motion motion_of(const Node& node, const Placed& parent) {
    if (!node.motion) return parent.motion;
    return Keyframes{.keys = node.motion,
                     .world_from_keys = dmat3(parent.world_from_node),
                     .rest = dvec3(node.parent_from_node[3])};
}

/// World transforms from the roots down, without recursion. The nodes are a forest; but a scene may
/// name a node twice, or beside its parent.
std::vector<Placed> place(const Document& document, const std::string& file, Notes& notes) {
    std::vector<Placed> placed(document.nodes.size());
    std::vector<std::pair<std::size_t, Placed>> waiting; // node and its parent's place
    for (const std::size_t root : document.roots) waiting.push_back({root, {}});
    while (!waiting.empty()) {
        const auto [index, parent] = std::move(waiting.back());
        waiting.pop_back();
        const Node& node = document.nodes[index];
        check(!placed[index].reached, Failure::bad_data, file, ": ", node.label,
              ": wanted one parent at most, found a second way to it");
        if (node.motion && !std::holds_alternative<std::monostate>(parent.motion))
            notes.add("nodes that move within a moving parent, whose motion is left out",
                      node.label);
        placed[index] = {parent.world_from_node * node.parent_from_node, motion_of(node, parent),
                         true};
        for (const std::size_t child : node.children) waiting.push_back({child, placed[index]});
    }
    return placed;
}

/// A mirrored node turns triangles inside out; glTF wants them turned back.
bool turns_inside_out(const dmat4& world_from_node) {
    return glm::determinant(dmat3(world_from_node)) < 0;
}

/// The exact sphere in world space, if the mesh lies on it and the node scales it uniformly.
std::optional<Sphere> world_sphere(const Sphere& sphere, const Mesh& mesh,
                                   const dmat4& world_from_node) {
    const dmat3 axes(world_from_node);
    const dvec3 scale(glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2]));
    // glTF's floats: 4 ulp of the largest number that took part
    const double relative = 4 * std::ldexp(1.0, -23);
    const double reach = glm::length(sphere.centre) + sphere.radius;
    for (const dvec3& position : mesh.positions)
        if (!(std::abs(glm::length(position - sphere.centre) - sphere.radius) <= relative * reach))
            return std::nullopt;
    const double skew = std::max(
        {std::abs(glm::dot(axes[0], axes[1])), std::abs(glm::dot(axes[1], axes[2])),
         std::abs(glm::dot(axes[2], axes[0])), std::abs(scale.x - scale.y) * scale.x,
         std::abs(scale.x - scale.z) * scale.x});
    if (!(skew <= relative * scale.x * scale.x)) return std::nullopt;
    return Sphere{transform_point(world_from_node, sphere.centre), sphere.radius * scale.x};
}

/// Makes objects of nodes; a mesh that several nodes share stays one.
struct Builder {
    const std::string& file;
    const Document& document;
    gltf::Context& context;
    Scene scene;
    struct Key {
        std::size_t group, part;
        bool inside_out;
        auto operator<=>(const Key&) const = default;
    };
    std::map<Key, std::size_t> meshes;

    Mesh repaired(std::size_t group, std::size_t part);
    std::size_t mesh_for(const Key& key);
    std::string object_name(const Node& node, std::size_t part);
    void add_object(const Node& node, const Placed& placed, std::size_t part);
    void add_camera(const Node& node, const Placed& placed);
    void check_unshown();
};

Mesh Builder::repaired(std::size_t group_index, std::size_t part) {
    const gltf::PrimitiveGroup& group = document.meshes[group_index];
    Mesh mesh = mesh_of(group, group.parts[part], context);
    context.account.mesh_vertices.add(corners_without_normal(mesh), group.place);
    const std::size_t dropped = repair(mesh);
    context.notes.add("triangles without area, left out", "in " + in_quotes(mesh.name), dropped);
    return mesh;
}

std::size_t Builder::mesh_for(const Key& key) {
    const auto [entry, is_new] = meshes.try_emplace(key, scene.meshes.size());
    if (!is_new) return entry->second;
    Mesh mesh = repaired(key.group, key.part);
    if (key.inside_out) // after the normals that were missing: they belong to the file's winding
        for (uvec3& triangle : mesh.triangles) std::swap(triangle.y, triangle.z);
    scene.meshes.push_back(std::move(mesh));
    return entry->second;
}

/// The node's name, or its mesh's; with the material where the mesh has several.
std::string Builder::object_name(const Node& node, std::size_t part) {
    const gltf::PrimitiveGroup& group = document.meshes[*node.mesh];
    const std::string& own = node.name.empty() ? group.name : node.name;
    const bool is_one = group.parts.size() == 1;
    const std::string& material = scene.materials[group.parts[part].material].name;
    context.account.name_bytes.add(own.size() + (is_one ? 0 : 1 + material.size()), file, ": ",
                                   node.label);
    return is_one ? own : own + "/" + material;
}

void Builder::add_object(const Node& node, const Placed& placed, std::size_t part) {
    gltf::Context& its = context;
    its.account.objects.add(1, file, ": ", node.label);
    Object object{.name = object_name(node, part),
                  .material = document.meshes[*node.mesh].parts[part].material,
                  .world_from_object = placed.world_from_node,
                  .motion = placed.motion,
                  .seen_by_camera = node.marks.seen_by_camera};
    object.mesh = mesh_for({*node.mesh, part, turns_inside_out(placed.world_from_node)});
    const Mesh& mesh = scene.meshes[object.mesh];
    its.account.shown_vertices.add(mesh.positions.size(), file, ": ", node.label);
    its.account.shown_triangles.add(mesh.triangles.size(), file, ": ", node.label);
    if (node.marks.sphere) {
        object.sphere = world_sphere(*node.marks.sphere, mesh, placed.world_from_node);
        if (!object.sphere)
            its.notes.add("nodes marked as a sphere whose mesh or scale is not one", node.label);
    }
    scene.objects.push_back(std::move(object));
}

/// A glTF camera looks along -z with +y up.
void Builder::add_camera(const Node& node, const Placed& placed) {
    if (!document.cameras[*node.camera]) return;
    Camera camera = *document.cameras[*node.camera];
    if (!node.name.empty()) camera.name = node.name;
    context.account.name_bytes.add(camera.name.size(), file, ": ", node.label);
    const dmat4& world = placed.world_from_node;
    const dvec3 forward = -normalized_or_zero(dvec3(world[2]));
    const dvec3 up = normalized_or_zero(dvec3(world[1]));
    check(glm::cross(forward, up) != dvec3(0), Failure::bad_data, file, ": ", node.label,
          ": wanted a camera's node with three axes, found a scale of zero");
    camera.eye = dvec3(world[3]);
    camera.target = camera.eye + node.marks.distance.value_or(1) * forward;
    check(is_finite(camera.eye) && is_finite(camera.target), Failure::bad_data, file, ": ",
          node.label, ": wanted a camera at finite coordinates, found an overflow");
    camera.up = up;
    scene.cameras.push_back(std::move(camera));
}

/// What no node shows is read all the same: a file is right or it is not.
void Builder::check_unshown() {
    std::vector<bool> is_shown(document.meshes.size(), false);
    for (const auto& [key, mesh] : meshes) is_shown[key.group] = true;
    for (std::size_t group = 0; group < is_shown.size(); ++group)
        for (std::size_t part = 0; !is_shown[group] && part < document.meshes[group].parts.size();
             ++part)
            mesh_of(document.meshes[group], document.meshes[group].parts[part], context);
}

} // namespace

Scene load_gltf(const std::filesystem::path& path, const LoadOptions& options) {
    const std::string file = path.string();
    Account account(options.budget);
    Files files(path, options.root, account);
    const gltf::Container container = gltf::read_container(file, files, account);
    const gltf::Item root(container.document, file);
    gltf::Accessors accessors(root, container.buffers);
    Notes notes;
    gltf::Context context{accessors, files, account, notes};
    const Document document = gltf::read(root, context);
    const std::vector<Placed> placed = place(document, file, notes);
    Builder builder{.file = file, .document = document, .context = context};
    builder.scene = {.name = path.stem().string(), .materials = document.materials};
    for (std::size_t i = 0; i < placed.size(); ++i) {
        const Node& node = document.nodes[i];
        if (!placed[i].reached) continue;
        const std::size_t parts = node.mesh ? document.meshes[*node.mesh].parts.size() : 0;
        for (std::size_t part = 0; part < parts; ++part) builder.add_object(node, placed[i], part);
        if (node.camera) builder.add_camera(node, placed[i]);
    }
    builder.check_unshown();
    finish(builder.scene, file, notes);
    builder.scene.files = files.found();
    return std::move(builder.scene);
}

} // namespace catoptric::scene
