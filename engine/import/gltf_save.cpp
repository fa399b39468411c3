// Writes a scene as .glb. A mirror is metallic 1, roughness 0. A light uses
// KHR_materials_emissive_strength, and motion is a CUBICSPLINE translation. The camera is written,
// too. Our own extras are in gltf_model.hpp.
#include "core/error.hpp"
#include "core/file.hpp"
#include "import/gltf_writer.hpp"
#include "import/load.hpp"
#include "scene/light_kind.hpp"
#include "scene/pose.hpp"
#include "scene/transform.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <sstream>
#include <utility>

namespace catoptric::scene {

namespace gltf {

namespace {

using tinygltf::Value;

int write_uv(Writer& writer, const std::vector<vec2>& list) {
    writer.append_accessor(list, TINYGLTF_TYPE_VEC2, TINYGLTF_COMPONENT_TYPE_FLOAT);
    return int_size(writer.model.accessors) - 1;
}

int write_colours(Writer& writer, const std::vector<vec4>& list) {
    writer.append_accessor(list, TINYGLTF_TYPE_VEC4, TINYGLTF_COMPONENT_TYPE_FLOAT);
    return int_size(writer.model.accessors) - 1;
}

int write_indices(Writer& writer, const Mesh& mesh, bool inside_out) {
    std::vector<std::uint32_t> wide;
    for (const uvec3& t : mesh.triangles)
        wide.insert(wide.end(), {t.x, inside_out ? t.z : t.y, inside_out ? t.y : t.z});
    if (mesh.positions.size() >= 65535) // index 65535 would mean primitive restart
        writer.append_accessor(wide, TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT);
    else
        writer.append_accessor(std::vector<std::uint16_t>(wide.begin(), wide.end()),
                               TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT);
    return int_size(writer.model.accessors) - 1;
}

/// Returns the glTF mesh of an object, and adds it if it is new. glTF stores the material with the
/// triangles. Objects with a mirrored transform get a mesh with reversed winding.
int find_or_write_mesh(Writer& writer, const Object& object) {
    const bool inside_out = glm::determinant(dmat3(object.world_from_object)) < 0;
    tinygltf::Model& model = writer.model;
    const auto [entry, is_new] = writer.meshes.try_emplace(
        {object.mesh, object.material, inside_out}, int_size(model.meshes));
    if (!is_new) return entry->second;
    const Mesh& mesh = writer.scene.meshes[object.mesh];
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.material = static_cast<int>(object.material);
    auto& attributes = primitive.attributes;
    attributes["POSITION"] = writer.vectors({mesh.positions.begin(), mesh.positions.end()});
    attributes["NORMAL"] = writer.vectors(mesh.normals);
    if (!mesh.uv[0].empty()) attributes["TEXCOORD_0"] = write_uv(writer, mesh.uv[0]);
    if (!mesh.uv[1].empty()) attributes["TEXCOORD_1"] = write_uv(writer, mesh.uv[1]);
    if (!mesh.colours.empty()) attributes["COLOR_0"] = write_colours(writer, mesh.colours);
    primitive.indices = write_indices(writer, mesh, inside_out);
    tinygltf::Mesh to;
    to.name = mesh.name, to.primitives = {std::move(primitive)};
    model.meshes.push_back(std::move(to));
    return entry->second;
}

/// Returns the extras of an object (gltf_model.hpp), with the sphere in node space. Returns an
/// empty value if all extras have their defaults.
Value make_object_extras(const Object& object) {
    Value::Object ours;
    const dmat4& world = object.world_from_object;
    const double scale = glm::length(dvec3(world[0]));
    if (object.sphere && object.sphere->centre == dvec3(world[3]) && object.sphere->radius == scale)
        ours["sphere"] = Value(true);
    else if (object.sphere) {
        const dvec3 centre = transform_point(glm::inverse(world), object.sphere->centre);
        ours["sphere"] = number_list({centre.x, centre.y, centre.z, object.sphere->radius / scale});
    }
    if (!object.seen_by_camera) ours["seen_by_camera"] = Value(false);
    return ours.empty() ? Value() : make_extras(std::move(ours));
}

/// Adds a node that has no motion of its own, as a root of the scene or as a child of a rig's node.
void add_child_node(Writer& writer, const RigAttachment* follows, tinygltf::Node node) {
    const int parent = follows ? writer.node_of(*follows) : -1;
    const int index = int_size(writer.model.nodes);
    writer.model.nodes.push_back(std::move(node));
    if (parent < 0)
        writer.model.scenes[0].nodes.push_back(index);
    else
        writer.model.nodes[std::size_t(parent)].children.push_back(index);
}

/// Adds a node with its transform and motion. A moving node stores its translation separately. If
/// the rest of its transform is more than a scale, a child node gets the rest.
void add_object_node(Writer& writer, const dmat4& world, const Motion& motion,
                     tinygltf::Node node) {
    tinygltf::Model& model = writer.model;
    if (const RigAttachment* follows = followed_node(motion)) {
        node.matrix = to_numbers(follows->node_from_object);
        return add_child_node(writer, follows, std::move(node));
    }
    const dvec3 rest(world[3]), scale(world[0][0], world[1][1], world[2][2]);
    const bool is_scale = dmat3(world) == glm::matrixCompMult(dmat3(world), dmat3(1));
    const std::optional<TranslationTrack> keys = motion_to_keys(motion);
    const int index = int_size(model.nodes);
    model.scenes[0].nodes.push_back(index);
    if (keys) writer.add_motion(*keys, rest, index);
    if (is_scale && rest != dvec3(0)) node.translation = to_numbers(rest);
    if (is_scale && scale != dvec3(1)) node.scale = to_numbers(scale);
    if (!is_scale && keys) {
        tinygltf::Node& parent = model.nodes.emplace_back();
        parent.name = node.name + "/motion";
        parent.translation = to_numbers(rest), parent.children = {index + 1};
        dmat4 unmoved = world;
        unmoved[3] = dvec4(0, 0, 0, 1);
        node.matrix = to_numbers(unmoved);
    } else if (!is_scale) {
        node.matrix = to_numbers(world);
    }
    model.nodes.push_back(std::move(node));
}

void add_object(Writer& writer, const Object& object) {
    if (writer.scene.meshes[object.mesh].triangles.empty()) return;
    tinygltf::Node node;
    node.name = object.name, node.mesh = find_or_write_mesh(writer, object),
    node.extras = make_object_extras(object);
    add_object_node(writer, object.world_from_object, object.motion, std::move(node));
}

/// glTF cameras look along -z with +y up.
void add_camera(Writer& writer, const Camera& camera) {
    const double distance = glm::distance(camera.eye, camera.target);
    const dvec3 forward = normalized_or_zero(camera.target - camera.eye);
    const dvec3 right = normalized_or_zero(glm::cross(forward, camera.up));
    check(right != dvec3(0), Failure::internal, "camera '", camera.name,
          "' wants an up vector that is not parallel to its view");
    const dmat4 world(dvec4(right, 0), dvec4(glm::cross(right, forward), 0), dvec4(-forward, 0),
                      dvec4(camera.eye, 1));
    const RigAttachment* follows = camera.follows.rig ? &camera.follows : nullptr;
    tinygltf::Node node;
    node.name = camera.name, node.camera = int_size(writer.model.cameras);
    node.matrix = to_numbers(follows ? follows->node_from_object * world : world);
    node.extras = make_extras({{"distance", Value(distance)}});
    add_child_node(writer, follows, std::move(node));
    tinygltf::Camera& to = writer.model.cameras.emplace_back();
    to.name = camera.name;
    // We do not clip; these planes lie a factor of 1000 nearer and farther than the target.
    const double nearest = distance / 1000, farthest = distance * 1000;
    if (camera.orthographic_height > 0) {
        to.type = "orthographic";
        to.orthographic.xmag = to.orthographic.ymag = camera.orthographic_height / 2;
        to.orthographic.znear = nearest, to.orthographic.zfar = farthest;
    } else {
        to.type = "perspective";
        to.perspective.yfov = glm::radians(camera.vertical_fov_degrees);
        to.perspective.znear = nearest, to.perspective.zfar = farthest;
    }
}

void add_light(Writer& writer, const PunctualLight& light) {
    const LightKind& kind = find_light_kind(light.kind);
    const std::string extension = "KHR_lights_punctual";
    const double largest = std::max({light.intensity.x, light.intensity.y, light.intensity.z});
    tinygltf::Light to;
    to.name = light.name;
    to.type = gltf_type_of(kind);
    if (to.type != kind.name) to.extras = make_extras({{"light", Value(std::string(kind.name))}});
    to.intensity = largest;
    to.color = to_numbers(largest > 0 ? dvec3(light.intensity) / largest : dvec3(1));
    if (std::isfinite(light.range)) to.range = light.range;
    to.spot.innerConeAngle = std::acos(light.cos_inner);
    to.spot.outerConeAngle = std::acos(light.cos_outer);
    tinygltf::Node node;
    node.name = light.name;
    node.extensions[extension] = Value(
        Value::Object{{"light", Value(int_size(writer.model.lights))}});
    writer.model.lights.push_back(std::move(to));
    add_object_node(writer, light.world_from_light, light.motion, std::move(node));
}

/// Throws `io` above 4 GiB.
std::string pack_glb(Writer& writer) {
    tinygltf::Model& model = writer.model;
    if (!writer.bytes.empty()) model.buffers.emplace_back().data = std::move(writer.bytes);
    std::ostringstream stream;
    tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, stream, false, true);
    std::string bytes = std::move(stream).str();
    check(bytes.size() < 0xffff0000u, Failure::io, "a .glb holds at most 4 GiB, this wants ",
          bytes.size(), " bytes");
    return bytes;
}

} // namespace

std::vector<double> to_numbers(const dmat4& matrix) {
    std::vector<double> list;
    for (int i = 0; i < 16; ++i) list.push_back(matrix[i / 4][i % 4] + 0.0);
    return list;
}

Value make_extras(Value::Object ours) {
    return Value(Value::Object{{"catoptric", Value(std::move(ours))}});
}

Value number_list(const std::vector<double>& list) {
    Value::Array array;
    for (const double number : list) array.emplace_back(number + 0.0);
    return Value(std::move(array));
}

tinygltf::BufferView& Writer::view(const void* first, std::size_t size) {
    tinygltf::BufferView& view = model.bufferViews.emplace_back();
    view.buffer = 0, view.byteOffset = bytes.size(), view.byteLength = size;
    const auto* const data = static_cast<const unsigned char*>(first);
    bytes.insert(bytes.end(), data, data + size);
    bytes.resize((bytes.size() + 3) / 4 * 4, 0);
    return view;
}

int Writer::vectors(const std::vector<vec3>& list) {
    Bounds<float> box;
    for (const vec3& v : list) box.add(v);
    tinygltf::Accessor& accessor = append_accessor(list, TINYGLTF_TYPE_VEC3,
                                                   TINYGLTF_COMPONENT_TYPE_FLOAT);
    accessor.minValues = to_numbers(box.lo), accessor.maxValues = to_numbers(box.hi);
    return int_size(model.accessors) - 1;
}

void Writer::use(const std::string& extension) {
    if (std::ranges::find(model.extensionsUsed, extension) == model.extensionsUsed.end())
        model.extensionsUsed.push_back(extension);
}

} // namespace gltf

void save_glb(const Scene& scene, const std::filesystem::path& path) {
    check_scene(scene);
    gltf::Writer writer{.scene = scene};
    tinygltf::Model& model = writer.model;
    model.asset.version = "2.0", model.asset.generator = "catoptric";
    model.defaultScene = 0;
    model.scenes.emplace_back().name = scene.name;
    if (scene.exposure)
        model.scenes[0].extras = gltf::make_extras(
            {{"exposure", tinygltf::Value(*scene.exposure)}});
    writer.motion.name = "motion";
    for (const Material& material : scene.materials) writer.add_material(material);
    for (const Object& object : scene.objects) gltf::add_object(writer, object);
    for (const PunctualLight& light : scene.punctual) gltf::add_light(writer, light);
    for (const Camera& camera : scene.cameras) gltf::add_camera(writer, camera);
    writer.finish_motion();
    write_file(path, gltf::pack_glb(writer));
}

} // namespace catoptric::scene
