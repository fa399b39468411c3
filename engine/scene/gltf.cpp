#include "core/text.hpp"
#include "scene/gltf_model.hpp"
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

/// Where a node stands, and how it moves in world space.
struct Placed {
    dmat4 world_from_node{1};
    Motion motion;
    bool reached = false;
};

using KeysOf = std::vector<std::shared_ptr<const Keys>>;

/// The node's own translation relative to its rest, carried into the world; else its parent's.
Motion motion_of(const std::shared_ptr<const Keys>& keys, const dmat4& parent_from_node,
                 const Placed& parent) {
    if (!keys) return parent.motion;
    return Keyframes{.keys = keys,
                     .world_from_keys = dmat3(parent.world_from_node),
                     .rest = dvec3(parent_from_node[3])};
}

/// World transforms from the roots down, without recursion. The nodes are a forest; but a scene may
/// name a node twice, or beside its parent.
std::vector<Placed> place(const gltf::Document& document, const KeysOf& motions, Notes& notes) {
    std::vector<Placed> placed(document.model.nodes.size());
    std::vector<dmat4> parent_from_node; // of those that nothing reaches too: they may be wrong
    for (std::size_t i = 0; i < placed.size(); ++i)
        parent_from_node.push_back(gltf::parent_from_node(document, i));
    std::vector<std::pair<std::size_t, Placed>> waiting; // node and its parent's place
    for (const int root : gltf::roots_of(document.model))
        waiting.push_back({std::size_t(root), {}});
    while (!waiting.empty()) {
        const auto [index, parent] = std::move(waiting.back());
        waiting.pop_back();
        check(!placed[index].reached, Failure::bad_data, document.file, ": ", document.label(index),
              ": wanted one parent at most, found a second way to it");
        if (motions[index] && !std::holds_alternative<std::monostate>(parent.motion))
            notes.add("nodes that move within a moving parent, whose motion is left out",
                      document.label(index));
        placed[index] = {parent.world_from_node * parent_from_node[index],
                         motion_of(motions[index], parent_from_node[index], parent), true};
        for (const int child : document.model.nodes[index].children)
            waiting.push_back({std::size_t(child), placed[index]});
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
    gltf::Context context;
    Scene scene;
    std::vector<std::vector<gltf::Part>> parts; ///< of each mesh
    std::vector<std::optional<Camera>> cameras;
    struct Key {
        std::size_t mesh, part;
        bool inside_out;
        auto operator<=>(const Key&) const = default;
    };
    std::map<Key, std::size_t> meshes;

    std::string node_place(std::size_t node) const;
    Mesh repaired(const Key& key);
    std::size_t mesh_for(const Key& key);
    std::string object_name(std::size_t node, std::size_t mesh, std::size_t part);
    void add_node(std::size_t node, const Placed& placed);
    void add_object(std::size_t node, const Placed& placed, std::size_t part);
    void add_camera(std::size_t node, const Placed& placed);
    void check_unshown();
};

std::string Builder::node_place(std::size_t node) const {
    return context.document.file + ": " + context.document.label(node);
}

Mesh Builder::repaired(const Key& key) {
    Mesh mesh = mesh_of(key.mesh, parts[key.mesh][key.part], context);
    context.account.mesh_vertices.add(corners_without_normal(mesh),
                                      mesh_place(context.document, key.mesh));
    const std::size_t dropped = repair(mesh);
    context.notes.add("triangles without area, left out", "in " + in_quotes(mesh.name), dropped);
    if (key.inside_out) // after the normals that were missing: they belong to the file's winding
        for (uvec3& triangle : mesh.triangles) std::swap(triangle.y, triangle.z);
    return mesh;
}

std::size_t Builder::mesh_for(const Key& key) {
    const auto [entry, is_new] = meshes.try_emplace(key, scene.meshes.size());
    if (is_new) scene.meshes.push_back(repaired(key));
    return entry->second;
}

/// The node's name, or its mesh's; with the material where the mesh has several.
std::string Builder::object_name(std::size_t node, std::size_t mesh, std::size_t part) {
    const tinygltf::Model& model = context.document.model;
    const std::string& name = model.nodes[node].name;
    const std::string& own = name.empty() ? model.meshes[mesh].name : name;
    const bool is_one = parts[mesh].size() == 1;
    const std::string& material = scene.materials[parts[mesh][part].material].name;
    context.account.name_bytes.add(own.size() + (is_one ? 0 : 1 + material.size()),
                                   node_place(node));
    return is_one ? own : own + "/" + material;
}

void Builder::add_object(std::size_t node, const Placed& placed, std::size_t part) {
    const std::string place = node_place(node);
    const gltf::Marks& marks = context.document.marks[node];
    const auto its_mesh = std::size_t(context.document.model.nodes[node].mesh);
    context.account.objects.add(1, place);
    Object object{.name = object_name(node, its_mesh, part),
                  .material = parts[its_mesh][part].material,
                  .world_from_object = placed.world_from_node,
                  .motion = placed.motion,
                  .seen_by_camera = marks.seen_by_camera};
    object.mesh = mesh_for({its_mesh, part, turns_inside_out(placed.world_from_node)});
    const Mesh& mesh = scene.meshes[object.mesh];
    context.account.shown_vertices.add(mesh.positions.size(), place);
    context.account.shown_triangles.add(mesh.triangles.size(), place);
    if (marks.sphere) {
        object.sphere = world_sphere(*marks.sphere, mesh, placed.world_from_node);
        if (!object.sphere)
            context.notes.add("nodes marked as a sphere whose mesh or scale is not one",
                              context.document.label(node));
    }
    scene.objects.push_back(std::move(object));
}

/// A glTF camera looks along -z with +y up.
void Builder::add_camera(std::size_t node, const Placed& placed) {
    const tinygltf::Node& from = context.document.model.nodes[node];
    const std::string place = node_place(node);
    if (!cameras[std::size_t(from.camera)]) return;
    if (!std::holds_alternative<std::monostate>(placed.motion))
        context.notes.add("cameras that move, standing still", context.document.label(node));
    Camera camera = *cameras[std::size_t(from.camera)];
    if (!from.name.empty()) camera.name = from.name;
    context.account.name_bytes.add(camera.name.size(), place);
    const dmat4& world = placed.world_from_node;
    const dvec3 forward = -normalized_or_zero(dvec3(world[2]));
    const dvec3 up = normalized_or_zero(dvec3(world[1]));
    check(glm::cross(forward, up) != dvec3(0), Failure::bad_data, place,
          ": wanted a camera's node with three axes, found a scale of zero");
    camera.eye = dvec3(world[3]);
    camera.target = camera.eye + context.document.marks[node].distance.value_or(1) * forward;
    check(is_finite(camera.eye) && is_finite(camera.target), Failure::bad_data, place,
          ": wanted a camera at finite coordinates, found an overflow");
    camera.up = up;
    scene.cameras.push_back(std::move(camera));
}

void Builder::add_node(std::size_t node, const Placed& placed) {
    const tinygltf::Node& from = context.document.model.nodes[node];
    const std::size_t count = from.mesh < 0 ? 0 : parts[std::size_t(from.mesh)].size();
    for (std::size_t part = 0; part < count; ++part) add_object(node, placed, part);
    if (from.camera >= 0) add_camera(node, placed);
}

/// What no node shows is read all the same: a file is right or it is not.
void Builder::check_unshown() {
    std::vector<bool> is_shown(parts.size(), false);
    for (const auto& [key, mesh] : meshes) is_shown[key.mesh] = true;
    for (std::size_t mesh = 0; mesh < is_shown.size(); ++mesh)
        for (std::size_t part = 0; !is_shown[mesh] && part < parts[mesh].size(); ++part)
            mesh_of(mesh, parts[mesh][part], context);
}

} // namespace

Scene load_gltf(const std::filesystem::path& path, const LoadOptions& options) {
    const std::string file = path.string();
    Account account(options.budget);
    Files files(path, options.root, account);
    Notes notes;
    const gltf::Document document = gltf::read(file, files, account, notes);
    gltf::check_forest(document);
    Builder builder{.context = {.document = document, .account = account, .notes = notes}};
    builder.scene = {.name = path.stem().string(),
                     .materials = read_materials(builder.context),
                     .exposure = document.exposure};
    builder.cameras = read_cameras(document);
    builder.parts = read_parts(builder.scene.materials, builder.context);
    const std::vector<Placed> placed = place(document, read_motions(builder.context), notes);
    for (std::size_t i = 0; i < placed.size(); ++i) {
        const tinygltf::Node& node = document.model.nodes[i];
        if (placed[i].reached)
            builder.add_node(i, placed[i]);
        else if (node.mesh >= 0 || node.camera >= 0)
            notes.add("nodes outside the scene that is shown, left out", document.label(i));
    }
    builder.check_unshown();
    finish(builder.scene, file, notes);
    builder.scene.files = files.found();
    return std::move(builder.scene);
}

} // namespace catoptric::scene
