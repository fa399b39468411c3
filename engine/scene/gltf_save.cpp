#include "core/error.hpp"
#include "core/file.hpp"
#include "scene/load.hpp"
#include "scene/number.hpp"
#include "scene/transform.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>

#include <nlohmann/json.hpp>

namespace catoptric::scene {

namespace {

using Json = nlohmann::ordered_json; // keys stay as written: same scene, same bytes

enum : int { kUnsignedShort = 5123, kUnsignedInt = 5125, kFloat = 5126 };

/// The JSON and the one buffer, growing together.
struct Writer {
    const Scene& scene;
    Json root;
    std::string buffer;
    std::map<std::tuple<std::size_t, std::size_t, bool>, std::size_t> meshes;
    Json nodes = Json::array(), animated = Json::array(), samplers = Json::array();

    std::size_t append(const void* data, std::size_t size, Json accessor);
    std::size_t vectors(const std::vector<vec3>& list);
    std::size_t times(const std::vector<float>& list);
    std::size_t indices(const Mesh& mesh, bool inside_out);
    std::size_t mesh_for(const Object& object);
    void add_motion(const Keys& keys, const dvec3& rest, std::size_t node);
    void add_object(const Object& object);
    void add_camera(const Camera& camera);
    void add_material(const Material& material);
};

/// Puts the bytes into the buffer, with a view and an accessor for them; returns the accessor.
std::size_t Writer::append(const void* data, std::size_t size, Json accessor) {
    accessor["bufferView"] = root["bufferViews"].size();
    root["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", size}});
    buffer.append(static_cast<const char*>(data), size);
    buffer.resize((buffer.size() + 3) / 4 * 4, '\0');
    root["accessors"].push_back(std::move(accessor));
    return root["accessors"].size() - 1;
}

Json json(const vec3& v) { return {as_typed(v.x), as_typed(v.y), as_typed(v.z)}; }
Json json(const dvec3& v) { return {v.x + 0.0, v.y + 0.0, v.z + 0.0}; } // + 0: no "-0.0"

std::size_t Writer::vectors(const std::vector<vec3>& list) {
    Bounds<float> box;
    for (const vec3& v : list) box.add(v);
    return append(list.data(), list.size() * sizeof(vec3),
                  {{"componentType", kFloat},
                   {"count", list.size()},
                   {"type", "VEC3"},
                   {"min", {double(box.lo.x), double(box.lo.y), double(box.lo.z)}},
                   {"max", {double(box.hi.x), double(box.hi.y), double(box.hi.z)}}});
}

std::size_t Writer::times(const std::vector<float>& list) {
    return append(list.data(), list.size() * sizeof(float),
                  {{"componentType", kFloat},
                   {"count", list.size()},
                   {"type", "SCALAR"},
                   {"min", Json::array({double(list.front())})},
                   {"max", Json::array({double(list.back())})}});
}

std::size_t Writer::indices(const Mesh& mesh, bool inside_out) {
    std::vector<std::uint32_t> wide;
    for (const uvec3& t : mesh.triangles)
        wide.insert(wide.end(), {t.x, inside_out ? t.z : t.y, inside_out ? t.y : t.z});
    Json accessor = {{"componentType", kUnsignedInt}, {"count", wide.size()}, {"type", "SCALAR"}};
    if (mesh.positions.size() >= 65535) // the highest 16-bit index means "restart"
        return append(wide.data(), wide.size() * sizeof(std::uint32_t), std::move(accessor));
    const std::vector<std::uint16_t> narrow(wide.begin(), wide.end());
    accessor["componentType"] = kUnsignedShort;
    return append(narrow.data(), narrow.size() * sizeof(std::uint16_t), std::move(accessor));
}

/// glTF keeps the material with the triangles, and turns those of a mirrored node inside out.
std::size_t Writer::mesh_for(const Object& object) {
    const bool inside_out = glm::determinant(dmat3(object.world_from_object)) < 0;
    const auto [entry, is_new] = meshes.try_emplace({object.mesh, object.material, inside_out},
                                                    root["meshes"].size());
    if (!is_new) return entry->second;
    const Mesh& mesh = scene.meshes[object.mesh];
    Json attributes;
    attributes["POSITION"] = vectors({mesh.positions.begin(), mesh.positions.end()});
    attributes["NORMAL"] = vectors(mesh.normals);
    const std::size_t corners = indices(mesh, inside_out);
    const Json primitive = {
        {"attributes", attributes}, {"indices", corners}, {"material", object.material}};
    root["meshes"].push_back({{"name", mesh.name}, {"primitives", Json::array({primitive})}});
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

void Writer::add_motion(const Keys& keys, const dvec3& rest, std::size_t node) {
    using enum Keys::Interpolation;
    const bool is_cubic = keys.interpolation == cubic;
    std::vector<vec3> output;
    for (std::size_t i = 0; i < keys.times.size(); ++i) {
        if (is_cubic) output.emplace_back(keys.in_tangents[i]);
        output.emplace_back(rest + keys.values[i]);
        if (is_cubic) output.emplace_back(keys.out_tangents[i]);
    }
    const std::size_t input = times({keys.times.begin(), keys.times.end()});
    animated.push_back(
        {{"sampler", samplers.size()}, {"target", {{"node", node}, {"path", "translation"}}}});
    const char* name = is_cubic ? "CUBICSPLINE" : keys.interpolation == step ? "STEP" : "LINEAR";
    samplers.push_back({{"input", input}, {"output", vectors(output)}, {"interpolation", name}});
}

Json json(const dmat4& matrix) {
    Json numbers = Json::array();
    for (int i = 0; i < 16; ++i) numbers.push_back(matrix[i / 4][i % 4] + 0.0);
    return numbers;
}

/// Our marks (gltf_document.hpp), the sphere in node space; null when there is nothing to say.
Json extras(const Object& object) {
    Json ours;
    const dmat4& world = object.world_from_object;
    const double scale = glm::length(dvec3(world[0]));
    if (object.sphere && object.sphere->centre == dvec3(world[3]) && object.sphere->radius == scale)
        ours["sphere"] = true;
    else if (object.sphere) {
        const dvec3 centre = transform_point(glm::inverse(world), object.sphere->centre);
        ours["sphere"] = {centre.x, centre.y, centre.z, object.sphere->radius / scale};
    }
    if (!object.seen_by_camera) ours["seen_by_camera"] = false;
    return ours.is_null() ? ours : Json{{"catoptric", ours}};
}

/// A node that moves holds its translation apart; where the rest is more than a scale, that goes
/// into a child.
void Writer::add_object(const Object& object) {
    if (scene.meshes[object.mesh].triangles.empty()) return;
    const dmat4& world = object.world_from_object;
    const dvec3 rest(world[3]), scale(world[0][0], world[1][1], world[2][2]);
    const bool is_scale = dmat3(world) == glm::matrixCompMult(dmat3(world), dmat3(1));
    const std::optional<Keys> keys = keys_of(object.motion);
    const std::size_t index = nodes.size();
    root["scenes"][0]["nodes"].push_back(index);
    if (keys) add_motion(*keys, rest, index);

    Json node = {{"name", object.name}, {"mesh", mesh_for(object)}};
    if (const Json marks = extras(object); !marks.is_null()) node["extras"] = marks;
    if (is_scale && rest != dvec3(0)) node["translation"] = json(rest);
    if (is_scale && scale != dvec3(1)) node["scale"] = json(scale);
    if (!is_scale && keys) {
        nodes.push_back({{"name", object.name + "/motion"},
                         {"translation", json(rest)},
                         {"children", Json::array({index + 1})}});
        dmat4 unmoved = world;
        unmoved[3] = dvec4(0, 0, 0, 1);
        node["matrix"] = json(unmoved);
    } else if (!is_scale) {
        node["matrix"] = json(world);
    }
    nodes.push_back(std::move(node));
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
    root["scenes"][0]["nodes"].push_back(nodes.size());
    nodes.push_back({{"name", camera.name},
                     {"camera", root["cameras"].size()},
                     {"matrix", json(world)},
                     {"extras", {{"catoptric", {{"distance", distance}}}}}});
    root["cameras"].push_back({{"name", camera.name},
                               {"type", "perspective"},
                               {"perspective",
                                {{"yfov", glm::radians(camera.vertical_fov_degrees)},
                                 {"znear", distance / 1000}}}}); // glTF wants one; we clip nothing
}

/// Radiance above 1 needs the extension: the largest component is the strength.
void Writer::add_material(const Material& material) {
    const vec3& base = material.mirror ? material.reflectance : material.albedo;
    Json factor = json(base);
    factor.push_back(1);
    Json to = {{"name", material.name},
               {"pbrMetallicRoughness",
                {{"baseColorFactor", factor},
                 {"metallicFactor", material.mirror ? 1 : 0},
                 {"roughnessFactor", material.mirror ? 0 : 1}}}};
    if (!is_one_sided(material)) to["doubleSided"] = true;
    const dvec3 emission(material.emission);
    const double strength = std::max({emission.x, emission.y, emission.z, 1.0});
    if (emission != dvec3(0)) to["emissiveFactor"] = json(emission / strength);
    if (strength > 1) {
        to["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = strength;
        root["extensionsUsed"] = Json::array({"KHR_materials_emissive_strength"});
    }
    root["materials"].push_back(std::move(to));
}

std::string word(std::uint32_t value) {
    std::string bytes(4, '\0');
    for (std::size_t i = 0; i < 4; ++i) bytes[i] = static_cast<char>(value >> (8 * i) & 255);
    return bytes;
}

std::string chunk(std::string content, const char* type, char padding) {
    content.resize((content.size() + 3) / 4 * 4, padding);
    return word(static_cast<std::uint32_t>(content.size())) + std::string(type, 4) + content;
}

/// The GLB container of what the writer holds. glTF has no empty lists.
std::string packed(Writer& writer) {
    Json& root = writer.root;
    root["nodes"] = writer.nodes;
    root["buffers"][0]["byteLength"] = writer.buffer.size();
    if (!writer.samplers.empty())
        root["animations"][0] = {
            {"name", "motion"}, {"channels", writer.animated}, {"samplers", writer.samplers}};
    for (const char* list : {"nodes", "cameras", "materials", "meshes", "accessors", "bufferViews"})
        if (root[list].empty()) root.erase(list);
    const std::string body = chunk(root.dump(), "JSON", ' ') + chunk(writer.buffer, "BIN\0", '\0');
    check(body.size() < 0xffff0000u, Failure::io, "a .glb holds at most 4 GiB, this wants ",
          body.size(), " bytes");
    return "glTF" + word(2) + word(static_cast<std::uint32_t>(body.size() + 12)) + body;
}

} // namespace

void save_glb(const Scene& scene, const std::filesystem::path& path) {
    Writer writer{.scene = scene};
    writer.root = {{"asset", {{"version", "2.0"}, {"generator", "catoptric"}}},
                   {"scene", 0},
                   {"scenes", Json::array({{{"name", scene.name}, {"nodes", Json::array()}}})}};
    for (const char* list : {"nodes", "cameras", "materials", "meshes", "accessors", "bufferViews"})
        writer.root[list] = Json::array();
    for (const Material& material : scene.materials) writer.add_material(material);
    for (const Object& object : scene.objects) writer.add_object(object);
    for (const Camera& camera : scene.cameras) writer.add_camera(camera);
    write_file(path, packed(writer));
}

} // namespace catoptric::scene
