#include "core/error.hpp"
#include "core/file.hpp"
#include "scene/gltf_check.hpp"
#include "scene/load.hpp"
#include "scene/number.hpp"
#include "scene/transform.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <optional>
#include <sstream>
#include <tuple>
#include <utility>

#include <tiny_gltf.h>

namespace catoptric::scene {

namespace {

using tinygltf::Value;

/// The model and its one buffer, growing together.
struct Writer {
    const Scene& scene;
    tinygltf::Model model;
    gltf::Bytes bytes;
    tinygltf::Animation motion;
    std::map<std::tuple<std::size_t, std::size_t, bool>, int> meshes;

    template <typename Element>
    tinygltf::Accessor& append(const std::vector<Element>& list, int type, int component);
    int vectors(const std::vector<vec3>& list);
    int times(const std::vector<float>& list);
    int indices(const Mesh& mesh, bool inside_out);
    int mesh_for(const Object& object);
    void add_motion(const Keys& keys, const dvec3& rest, int node);
    void add_object(const Object& object);
    void add_camera(const Camera& camera);
    void add_material(const Material& material);
};

int size_of(const auto& list) { return static_cast<int>(list.size()); }

/// Puts the elements into the buffer, with a view and an accessor for them, the last one.
template <typename Element>
tinygltf::Accessor& Writer::append(const std::vector<Element>& list, int type, int component) {
    tinygltf::BufferView& view = model.bufferViews.emplace_back();
    view.buffer = 0, view.byteOffset = bytes.size(),
    view.byteLength = list.size() * sizeof(Element);
    const auto* const first = reinterpret_cast<const unsigned char*>(list.data());
    bytes.insert(bytes.end(), first, first + view.byteLength);
    bytes.resize((bytes.size() + 3) / 4 * 4, 0);
    tinygltf::Accessor& accessor = model.accessors.emplace_back();
    accessor.bufferView = size_of(model.bufferViews) - 1, accessor.count = list.size();
    accessor.type = type, accessor.componentType = component;
    return accessor;
}

template <typename Vector>
std::vector<double> numbers(const Vector& v) {
    return {v.x + 0.0, v.y + 0.0, v.z + 0.0}; // + 0: no "-0.0"
}

int Writer::vectors(const std::vector<vec3>& list) {
    Bounds<float> box;
    for (const vec3& v : list) box.add(v);
    tinygltf::Accessor& accessor = append(list, TINYGLTF_TYPE_VEC3, TINYGLTF_COMPONENT_TYPE_FLOAT);
    accessor.minValues = numbers(box.lo), accessor.maxValues = numbers(box.hi);
    return size_of(model.accessors) - 1;
}

int Writer::times(const std::vector<float>& list) {
    tinygltf::Accessor& accessor = append(list, TINYGLTF_TYPE_SCALAR,
                                          TINYGLTF_COMPONENT_TYPE_FLOAT);
    accessor.minValues = {list.front()}, accessor.maxValues = {list.back()};
    return size_of(model.accessors) - 1;
}

int Writer::indices(const Mesh& mesh, bool inside_out) {
    std::vector<std::uint32_t> wide;
    for (const uvec3& t : mesh.triangles)
        wide.insert(wide.end(), {t.x, inside_out ? t.z : t.y, inside_out ? t.y : t.z});
    if (mesh.positions.size() >= 65535) // the highest 16-bit index means "restart"
        append(wide, TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT);
    else
        append(std::vector<std::uint16_t>(wide.begin(), wide.end()), TINYGLTF_TYPE_SCALAR,
               TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT);
    return size_of(model.accessors) - 1;
}

/// glTF keeps the material with the triangles, and turns those of a mirrored node inside out.
int Writer::mesh_for(const Object& object) {
    const bool inside_out = glm::determinant(dmat3(object.world_from_object)) < 0;
    const auto [entry, is_new] = meshes.try_emplace({object.mesh, object.material, inside_out},
                                                    size_of(model.meshes));
    if (!is_new) return entry->second;
    const Mesh& mesh = scene.meshes[object.mesh];
    tinygltf::Mesh& to = model.meshes.emplace_back();
    to.name = mesh.name;
    tinygltf::Primitive& primitive = to.primitives.emplace_back();
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.material = static_cast<int>(object.material);
    primitive.attributes["POSITION"] = vectors({mesh.positions.begin(), mesh.positions.end()});
    primitive.attributes["NORMAL"] = vectors(mesh.normals);
    primitive.indices = indices(mesh, inside_out);
    return entry->second;
}

/// One period as 64 Hermite pieces with the true derivative at each key: the error is below
/// (2 pi / 64)^4 / 384 = 2.5e-7 of the amplitude.
Keys keys_of(const Harmonic& motion) {
    constexpr int kPieces = 64;
    Keys keys{.interpolation = Keys::Interpolation::cubic};
    for (int i = 0; i <= kPieces; ++i) {
        const double angle = 2 * std::numbers::pi * i / kPieces;
        keys.times.push_back(motion.period * i / kPieces);
        keys.values.push_back(motion.amplitude * (1 - std::cos(angle)));
        keys.in_tangents.push_back(motion.amplitude * std::sin(angle) *
                                   (2 * std::numbers::pi / motion.period));
    }
    keys.out_tangents = keys.in_tangents;
    return keys;
}

std::optional<Keys> keys_of(const Motion& motion) {
    if (const auto* harmonic = std::get_if<Harmonic>(&motion)) return keys_of(*harmonic);
    if (const auto* frames = std::get_if<Keyframes>(&motion))
        if (Keys keys = in_the_world(*frames); !keys.times.empty()) return keys;
    return std::nullopt;
}

void Writer::add_motion(const Keys& keys, const dvec3& rest, int node) {
    using enum Keys::Interpolation;
    const bool is_cubic = keys.interpolation == cubic;
    std::vector<vec3> output;
    for (std::size_t i = 0; i < keys.times.size(); ++i) {
        if (is_cubic) output.emplace_back(keys.in_tangents[i]);
        output.emplace_back(rest + keys.values[i]);
        if (is_cubic) output.emplace_back(keys.out_tangents[i]);
    }
    tinygltf::AnimationSampler sampler;
    sampler.input = times({keys.times.begin(), keys.times.end()});
    sampler.output = vectors(output);
    sampler.interpolation = is_cubic                     ? "CUBICSPLINE"
                            : keys.interpolation == step ? "STEP"
                                                         : "LINEAR";
    tinygltf::AnimationChannel channel;
    channel.sampler = size_of(motion.samplers);
    channel.target_node = node, channel.target_path = "translation";
    motion.samplers.push_back(std::move(sampler));
    motion.channels.push_back(std::move(channel));
}

std::vector<double> numbers(const dmat4& matrix) {
    std::vector<double> list;
    for (int i = 0; i < 16; ++i) list.push_back(matrix[i / 4][i % 4] + 0.0);
    return list;
}

Value marked(Value::Object ours) {
    return Value(Value::Object{{"catoptric", Value(std::move(ours))}});
}

/// Our marks (gltf_model.hpp), the sphere in node space; nothing when there is nothing to say.
Value extras(const Object& object) {
    Value::Object ours;
    const dmat4& world = object.world_from_object;
    const double scale = glm::length(dvec3(world[0]));
    if (object.sphere && object.sphere->centre == dvec3(world[3]) && object.sphere->radius == scale)
        ours["sphere"] = Value(true);
    else if (object.sphere) {
        const dvec3 centre = transform_point(glm::inverse(world), object.sphere->centre);
        ours["sphere"] = Value(Value::Array{Value(centre.x), Value(centre.y), Value(centre.z),
                                            Value(object.sphere->radius / scale)});
    }
    if (!object.seen_by_camera) ours["seen_by_camera"] = Value(false);
    return ours.empty() ? Value() : marked(std::move(ours));
}

/// A node that moves holds its translation apart; where the rest is more than a scale, that goes
/// into a child.
void Writer::add_object(const Object& object) {
    if (scene.meshes[object.mesh].triangles.empty()) return;
    const dmat4& world = object.world_from_object;
    const dvec3 rest(world[3]), scale(world[0][0], world[1][1], world[2][2]);
    const bool is_scale = dmat3(world) == glm::matrixCompMult(dmat3(world), dmat3(1));
    const std::optional<Keys> keys = keys_of(object.motion);
    const int index = size_of(model.nodes);
    model.scenes[0].nodes.push_back(index);
    if (keys) add_motion(*keys, rest, index);

    tinygltf::Node node;
    node.name = object.name, node.mesh = mesh_for(object), node.extras = extras(object);
    if (is_scale && rest != dvec3(0)) node.translation = numbers(rest);
    if (is_scale && scale != dvec3(1)) node.scale = numbers(scale);
    if (!is_scale && keys) {
        tinygltf::Node& parent = model.nodes.emplace_back();
        parent.name = object.name + "/motion";
        parent.translation = numbers(rest), parent.children = {index + 1};
        dmat4 unmoved = world;
        unmoved[3] = dvec4(0, 0, 0, 1);
        node.matrix = numbers(unmoved);
    } else if (!is_scale) {
        node.matrix = numbers(world);
    }
    model.nodes.push_back(std::move(node));
}

/// glTF cameras look along -z with +y up.
void Writer::add_camera(const Camera& camera) {
    const double distance = glm::distance(camera.eye, camera.target);
    const dvec3 forward = normalized_or_zero(camera.target - camera.eye);
    const dvec3 right = normalized_or_zero(glm::cross(forward, camera.up));
    check(right != dvec3(0), Failure::internal, "camera '", camera.name,
          "' wants an up that is not along its view");
    const dmat4 world(dvec4(right, 0), dvec4(glm::cross(right, forward), 0), dvec4(-forward, 0),
                      dvec4(camera.eye, 1));
    model.scenes[0].nodes.push_back(size_of(model.nodes));
    tinygltf::Node& node = model.nodes.emplace_back();
    node.name = camera.name, node.camera = size_of(model.cameras), node.matrix = numbers(world);
    node.extras = marked({{"distance", Value(distance)}});
    tinygltf::Camera& to = model.cameras.emplace_back();
    to.name = camera.name, to.type = "perspective";
    to.perspective.yfov = glm::radians(camera.vertical_fov_degrees);
    to.perspective.znear = distance / 1000,
    to.perspective.zfar = distance * 1000; // we clip nothing
}

/// Radiance above 1 needs the extension: the largest component is the strength; and so does what
/// tinygltf takes for black.
void Writer::add_material(const Material& material) {
    const vec3& base = material.mirror ? material.reflectance : material.albedo;
    tinygltf::Material& to = model.materials.emplace_back();
    to.name = material.name;
    to.pbrMetallicRoughness.baseColorFactor = {as_typed(base.x), as_typed(base.y), as_typed(base.z),
                                               1};
    to.pbrMetallicRoughness.metallicFactor = material.mirror ? 1 : 0;
    to.pbrMetallicRoughness.roughnessFactor = material.mirror ? 0 : 1;
    to.doubleSided = !is_one_sided(material);
    const dvec3 emission(material.emission);
    const double largest = std::max({emission.x, emission.y, emission.z});
    if (largest == 0) return;
    const bool is_common = largest <= 1 && largest > 1e-6;
    to.emissiveFactor = numbers(is_common ? emission : emission / largest);
    if (is_common) return;
    const std::string extension(gltf::kEmissiveStrength);
    to.extensions[extension] = Value(Value::Object{{"emissiveStrength", Value(largest)}});
    model.extensionsUsed = {extension};
}

/// The GLB container of what the writer holds.
std::string packed(Writer& writer) {
    tinygltf::Model& model = writer.model;
    if (!writer.bytes.empty()) model.buffers.emplace_back().data = std::move(writer.bytes);
    if (!writer.motion.channels.empty()) model.animations = {std::move(writer.motion)};
    std::ostringstream stream;
    tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, stream, false, true);
    std::string bytes = std::move(stream).str();
    check(bytes.size() < 0xffff0000u, Failure::io, "a .glb holds at most 4 GiB, this wants ",
          bytes.size(), " bytes");
    return bytes;
}

} // namespace

void save_glb(const Scene& scene, const std::filesystem::path& path) {
    Writer writer{.scene = scene};
    tinygltf::Model& model = writer.model;
    model.asset.version = "2.0", model.asset.generator = "catoptric";
    model.defaultScene = 0;
    model.scenes.emplace_back().name = scene.name;
    if (scene.exposure) model.scenes[0].extras = marked({{"exposure", Value(*scene.exposure)}});
    writer.motion.name = "motion";
    for (const Material& material : scene.materials) writer.add_material(material);
    for (const Object& object : scene.objects) writer.add_object(object);
    for (const Camera& camera : scene.cameras) writer.add_camera(camera);
    write_file(path, packed(writer));
}

} // namespace catoptric::scene
