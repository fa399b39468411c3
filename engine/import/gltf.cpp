#include "core/text.hpp"
#include "import/file_options.hpp"
#include "import/gltf_model.hpp"
#include "import/load.hpp"
#include "scene/motion.hpp"
#include "scene/moved_sphere.hpp"
#include "scene/pose.hpp"
#include "scene/repair.hpp"
#include "scene/transform.hpp"
#include "scene/unsupported_feature.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

namespace catoptric::scene {

namespace {

/// Returns whether the node's transform mirrors its mesh. The mirrored triangles are inside out,
/// and glTF requires us to reverse their winding.
bool flips_winding(const dmat4& world_from_node) {
    return glm::determinant(dmat3(world_from_node)) < 0;
}

/// Returns how a camera follows a single track of translations, as a rig of one node.
RigAttachment make_translation_rig(const Keyframes& frames) {
    NodeRig rig{.nodes = {{.translations = frames.keys}}, .repeats = frames.repeats};
    rig.nodes[0].parent_from_space = dmat4(frames.world_from_keys);
    RigAttachment follows{.rig = std::make_shared<const NodeRig>(std::move(rig))};
    // Transform into the world from the space of the animation's keys, with the place of the node
    // when nothing moves.
    dmat4 rest = dmat4(frames.world_from_keys);
    rest[3] = dvec4(frames.world_from_keys * frames.rest, 1);
    follows.node_from_object = glm::inverse(rest);
    return follows;
}

/// Returns the exact sphere in world space. Returns none unless the mesh's vertices lie on it and
/// the node scales it uniformly.
std::optional<Sphere> sphere_in_world(const Sphere& sphere, const Mesh& mesh,
                                      const dmat4& world_from_node) {
    const dmat3 axes(world_from_node);
    const dvec3 scale(glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2]));
    // glTF stores floats. The tolerance is 4 ulp of the largest number in the computation.
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

/// Turns nodes into objects. Nodes that share a mesh share it in the scene, too.
struct GltfBuilder {
    gltf::ReadContext context;
    Scene scene;
    std::vector<dmat4> at_rest;                     ///< transform from each node to world space
    std::vector<std::vector<gltf::MeshPart>> parts; ///< of each mesh
    std::vector<Camera> cameras;
    struct MeshKey {
        std::size_t mesh, part;
        int skin; ///< -1 if the node has none
        bool inside_out;
        std::vector<double> weights; ///< of morph targets
        auto operator<=>(const MeshKey&) const = default;
    };
    std::map<MeshKey, std::size_t> meshes;

    std::string node_place(std::size_t node) const;
    Mesh repaired(const MeshKey& key);
    std::size_t mesh_index(const MeshKey& key);
    std::string object_name(std::size_t node, std::size_t mesh, std::size_t part);
    void add_node(std::size_t node, const gltf::PlacedNode& placed);
    void add_object(std::size_t node, const gltf::PlacedNode& placed, std::size_t part);
    void add_camera(std::size_t node, const gltf::PlacedNode& placed);
    void add_light(std::size_t node, const gltf::PlacedNode& placed);
    void check_unshown_meshes();
};

std::string GltfBuilder::node_place(std::size_t node) const {
    return context.document.file + ": " + context.document.describe_node(node);
}

Mesh GltfBuilder::repaired(const MeshKey& key) {
    std::vector<dmat4> joints;
    if (key.skin >= 0) joints = joint_transforms(key.skin, at_rest, context);
    Mesh mesh = build_part(key.mesh, parts[key.mesh][key.part], key.weights, context,
                           key.skin >= 0 ? &joints : nullptr);
    context.account.mesh_vertices.add(count_missing_normals(mesh),
                                      mesh_place(context.document, key.mesh));
    const std::size_t dropped = repair_mesh(mesh);
    context.notes.add("triangles without area, left out", "in " + quote(mesh.name), dropped);
    // Normals that `repair_mesh` adds follow the winding in the file, so the winding is reversed
    // only afterwards.
    if (key.inside_out)
        for (uvec3& triangle : mesh.triangles) std::swap(triangle.y, triangle.z);
    return mesh;
}

std::size_t GltfBuilder::mesh_index(const MeshKey& key) {
    const auto [entry, is_new] = meshes.try_emplace(key, scene.meshes.size());
    if (is_new) scene.meshes.push_back(repaired(key));
    return entry->second;
}

/// Returns the node's name, or its mesh's if it has none. Appends the material's name if the mesh
/// has several parts.
std::string GltfBuilder::object_name(std::size_t node, std::size_t mesh, std::size_t part) {
    const tinygltf::Model& model = context.document.model;
    const std::string& name = model.nodes[node].name;
    const std::string& own = name.empty() ? model.meshes[mesh].name : name;
    const bool is_one = parts[mesh].size() == 1;
    const std::string& material = scene.materials[parts[mesh][part].material].name;
    context.account.name_bytes.add(own.size() + (is_one ? 0 : 1 + material.size()),
                                   node_place(node));
    return is_one ? own : own + "/" + material;
}

void GltfBuilder::add_object(std::size_t node, const gltf::PlacedNode& placed, std::size_t part) {
    const std::string place = node_place(node);
    const gltf::NodeExtras& extras = context.document.extras[node];
    const auto its_mesh = std::size_t(context.document.model.nodes[node].mesh);
    context.account.objects.add(1, place);
    Object object{.name = object_name(node, its_mesh, part),
                  .material = parts[its_mesh][part].material,
                  .seen_by_camera = extras.seen_by_camera};
    const int skin = context.document.model.nodes[node].skin;
    if (skin < 0) // joints place a skinned mesh, not its node
        object.world_from_object = placed.world_from_node, object.motion = placed.motion;
    const std::vector<double>& weights = context.document.node_weights[node];
    object.mesh = mesh_index({its_mesh, part, skin, flips_winding(object.world_from_object),
                              weights.empty() ? context.document.weights[its_mesh] : weights});
    const Mesh& mesh = scene.meshes[object.mesh];
    context.account.shown_vertices.add(mesh.positions.size(), place);
    context.account.shown_triangles.add(mesh.triangles.size(), place);
    if (extras.sphere) {
        const RigAttachment* follows = followed_node(object.motion);
        if (!follows || preserves_spheres(*follows))
            object.sphere = sphere_in_world(*extras.sphere, mesh, placed.world_from_node);
        if (!object.sphere)
            context.notes.add("nodes marked as a sphere whose mesh or scale is not one",
                              context.document.describe_node(node));
    }
    scene.objects.push_back(std::move(object));
}

/// A glTF camera looks along -z with +y up.
void GltfBuilder::add_camera(std::size_t node, const gltf::PlacedNode& placed) {
    const tinygltf::Node& from = context.document.model.nodes[node];
    const std::string place = node_place(node);
    Camera camera = cameras[std::size_t(from.camera)];
    if (!from.name.empty()) camera.name = from.name;
    context.account.name_bytes.add(camera.name.size(), place);
    const dmat4& world = placed.world_from_node;
    const dvec3 forward = -normalized_or_zero(dvec3(world[2]));
    const dvec3 up = normalized_or_zero(dvec3(world[1]));
    check(glm::cross(forward, up) != dvec3(0), Failure::bad_data, place,
          ": wanted a camera's node with three axes, found a scale of zero");
    camera.eye = dvec3(world[3]);
    camera.target = camera.eye + context.document.extras[node].distance.value_or(1) * forward;
    check(is_finite(camera.eye) && is_finite(camera.target), Failure::bad_data, place,
          ": wanted a camera at finite coordinates, found an overflow");
    camera.up = up;
    if (const auto* follows = std::get_if<RigAttachment>(&placed.motion)) {
        camera.follows = *follows;
        camera.follows.node_from_object *= glm::inverse(world);
    } else if (const auto* frames = std::get_if<Keyframes>(&placed.motion)) {
        camera.follows = make_translation_rig(*frames);
    }
    scene.cameras.push_back(std::move(camera));
}

void GltfBuilder::add_light(std::size_t node, const gltf::PlacedNode& placed) {
    const tinygltf::Node& from = context.document.model.nodes[node];
    PunctualLight light = context.document.lights.lights[*context.document.lights.of_node[node]];
    if (!from.name.empty()) light.name = from.name;
    context.account.name_bytes.add(light.name.size(), node_place(node));
    light.world_from_light = placed.world_from_node;
    light.motion = placed.motion;
    for (int column = 0; column < 4; ++column)
        check(is_finite(dvec3(light.world_from_light[column])), Failure::bad_data, node_place(node),
              ": wanted a light at finite coordinates, found an overflow");
    scene.punctual.push_back(std::move(light));
}

void GltfBuilder::add_node(std::size_t node, const gltf::PlacedNode& placed) {
    const tinygltf::Node& from = context.document.model.nodes[node];
    const std::size_t count = from.mesh < 0 ? 0 : parts[std::size_t(from.mesh)].size();
    for (std::size_t part = 0; part < count; ++part) add_object(node, placed, part);
    if (from.camera >= 0) add_camera(node, placed);
    if (context.document.lights.of_node[node]) add_light(node, placed);
    if (from.skin >= 0 && from.mesh >= 0) {
        context.notes.add("nodes with a skin, posed by its joints at rest",
                          context.document.describe_node(node));
        add_unsupported(context.unsupported, "skin", context.document.describe_node(node));
    }
}

/// Reads also the meshes that no node shows, so that an invalid mesh is an error whether or not it
/// is shown.
void GltfBuilder::check_unshown_meshes() {
    std::vector<bool> is_shown(parts.size(), false);
    for (const auto& [key, mesh] : meshes) is_shown[key.mesh] = true;
    for (std::size_t mesh = 0; mesh < is_shown.size(); ++mesh)
        for (std::size_t part = 0; !is_shown[mesh] && part < parts[mesh].size(); ++part)
            build_part(mesh, parts[mesh][part], context.document.weights[mesh], context);
}

} // namespace

Scene load_gltf(const std::filesystem::path& path, const FileOptions& options) {
    const std::string file = path.string();
    LoadAccount account(options.budget);
    FileOpener files(path, options.root, account);
    LoaderNotes notes;
    std::vector<UnsupportedFeature> unsupported;
    const gltf::Document document = gltf::read_document(file, files, account, notes, unsupported);
    gltf::check_forest(document);
    GltfBuilder builder{.context = {.document = document,
                                    .options = options,
                                    .account = account,
                                    .notes = notes,
                                    .unsupported = unsupported}};
    builder.scene = {.name = path.stem().string(),
                     .materials = document.materials,
                     .exposure = document.exposure};
    builder.cameras = read_cameras(document);
    builder.parts = read_mesh_parts(builder.scene.materials, builder.context);
    builder.at_rest = rest_transforms(document);
    const std::vector<gltf::PlacedNode> placed = place_nodes(document,
                                                             read_animation(builder.context));
    for (std::size_t i = 0; i < placed.size(); ++i) {
        const tinygltf::Node& node = document.model.nodes[i];
        if (placed[i].reached)
            builder.add_node(i, placed[i]);
        else if (node.mesh >= 0 || node.camera >= 0)
            notes.add("nodes outside the scene that is shown, left out", document.describe_node(i));
    }
    builder.check_unshown_meshes();
    finish_scene(builder.scene, file, notes, std::move(unsupported));
    builder.scene.files = files.found();
    return std::move(builder.scene);
}

} // namespace catoptric::scene
