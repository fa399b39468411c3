#include "core/error.hpp"
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
    const dmat3 world_from_parent(parent.world_from_node);
    const dvec3 rest(node.parent_from_node[3]);
    Keyframes keys = *node.motion;
    for (dvec3& value : keys.values) value = world_from_parent * (value - rest);
    for (dvec3& tangent : keys.in_tangents) tangent = world_from_parent * tangent;
    for (dvec3& tangent : keys.out_tangents) tangent = world_from_parent * tangent;
    return keys;
}

/// World transforms from the roots down, without recursion. A node that is reached twice (a cycle,
/// or two parents) is refused, so this ends.
std::vector<Placed> place(Document& document, const std::string& file) {
    std::vector<Placed> placed(document.nodes.size());
    std::vector<std::pair<std::size_t, Placed>> waiting; // node and its parent's place
    for (const std::size_t root : document.roots) waiting.push_back({root, {}});
    while (!waiting.empty()) {
        const auto [index, parent] = std::move(waiting.back());
        waiting.pop_back();
        const Node& node = document.nodes[index];
        check(!placed[index].reached, Failure::bad_data, file, ": node ", index, " '", node.name,
              "': wanted one parent at most, found a second way to it");
        if (node.motion && !std::holds_alternative<std::monostate>(parent.motion))
            document.warnings.push_back(file + ": node '" + node.name +
                                        "' moves within a moving parent, whose motion is left out");
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

/// The primitives of one group that share a material, as one mesh: a mirror is a node, however many
/// primitives an exporter cut it into.
Mesh merged(const gltf::PrimitiveGroup& group, std::size_t material) {
    Mesh mesh{.name = group.name};
    for (const gltf::Primitive& part : group.primitives) {
        if (part.material != material) continue;
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        const auto append = [](auto& to, const auto& from) {
            to.insert(to.end(), from.begin(), from.end());
        };
        append(mesh.positions, part.mesh.positions);
        append(mesh.normals, part.mesh.normals);
        mesh.normals.resize(mesh.positions.size(), vec3(0));
        for (const uvec3& triangle : part.mesh.triangles)
            mesh.triangles.push_back(triangle + uvec3(first));
    }
    return mesh;
}

std::vector<std::size_t> materials_of(const gltf::PrimitiveGroup& group) {
    std::vector<std::size_t> materials;
    for (const gltf::Primitive& part : group.primitives)
        if (std::ranges::find(materials, part.material) == materials.end())
            materials.push_back(part.material);
    return materials;
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
    std::string file;
    const Document& document;
    Scene scene;
    struct Key {
        std::size_t group, material;
        bool inside_out;
        auto operator<=>(const Key&) const = default;
    };
    std::map<Key, std::size_t> meshes;

    std::size_t mesh_for(const Key& key);
    void add_objects(const Node& node, const Placed& placed);
    void add_camera(const Node& node, const Placed& placed);
};

std::size_t Builder::mesh_for(const Key& key) {
    const auto [entry, is_new] = meshes.try_emplace(key, scene.meshes.size());
    if (!is_new) return entry->second;
    Mesh mesh = merged(document.meshes[key.group], key.material);
    const std::string place = file + ": mesh '" + mesh.name + "'";
    if (key.inside_out)
        for (uvec3& triangle : mesh.triangles) std::swap(triangle.y, triangle.z);
    if (const std::size_t dropped = repair(mesh); dropped > 0)
        scene.warnings.push_back(place + ": " + std::to_string(dropped) +
                                 " triangles without area left out");
    scene.meshes.push_back(std::move(mesh));
    return entry->second;
}

void Builder::add_objects(const Node& node, const Placed& placed) {
    const gltf::PrimitiveGroup& group = document.meshes[*node.mesh];
    const std::vector<std::size_t> materials = materials_of(group);
    for (const std::size_t material : materials) {
        Object object{.name = node.name.empty() ? group.name : node.name, .material = material};
        if (materials.size() > 1) object.name += "/" + scene.materials[material].name;
        object.world_from_object = placed.world_from_node;
        object.motion = placed.motion;
        object.seen_by_camera = node.marks.seen_by_camera;
        object.mesh = mesh_for({*node.mesh, material, turns_inside_out(placed.world_from_node)});
        if (node.marks.sphere) {
            object.sphere = world_sphere(*node.marks.sphere, scene.meshes[object.mesh],
                                         placed.world_from_node);
            if (!object.sphere)
                scene.warnings.push_back(file + ": node '" + object.name +
                                         "' is marked as a sphere, but its mesh or scale is not");
        }
        scene.objects.push_back(std::move(object));
    }
}

/// A glTF camera looks along -z with +y up.
void Builder::add_camera(const Node& node, const Placed& placed) {
    Camera camera = document.cameras[*node.camera];
    if (!node.name.empty()) camera.name = node.name;
    const dmat4& world = placed.world_from_node;
    const dvec3 forward = -normalized_or_zero(dvec3(world[2]));
    const dvec3 up = normalized_or_zero(dvec3(world[1]));
    check(glm::cross(forward, up) != dvec3(0), Failure::bad_data, file, ": camera '", camera.name,
          "': wanted a node with three axes, found a scale of zero");
    camera.eye = dvec3(world[3]);
    camera.target = camera.eye + node.marks.distance.value_or(1) * forward;
    camera.up = up;
    scene.cameras.push_back(std::move(camera));
}

} // namespace

Scene load_gltf(const std::filesystem::path& path) {
    const std::string file = path.string();
    Document document = gltf::read(path);
    const std::vector<Placed> placed = place(document, file);
    Builder builder{.file = file, .document = document};
    builder.scene = {.name = path.stem().string(),
                     .materials = document.materials,
                     .warnings = document.warnings};
    for (std::size_t i = 0; i < placed.size(); ++i) {
        const Node& node = document.nodes[i];
        if (!placed[i].reached) continue;
        if (node.mesh) builder.add_objects(node, placed[i]);
        if (node.camera) builder.add_camera(node, placed[i]);
    }
    finish(builder.scene, file);
    return std::move(builder.scene);
}

} // namespace catoptric::scene
