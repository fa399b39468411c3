#include "scene/light_kind.hpp"
#include "scene/material_facts.hpp"
#include "scene/motion.hpp"
#include "scene/scene.hpp"

#include <cstdint>
#include <span>
#include <type_traits>
#include <unordered_map>

namespace catoptric::scene {

namespace {

/// 64-bit FNV-1a hash. Lists and texts include their length, so that neighbouring values cannot run
/// together.
struct SceneHasher {
    std::uint64_t state = 14695981039346656037ull;
    std::unordered_map<const void*, std::uint64_t> known;

    void bytes(std::span<const std::byte> data) {
        for (const std::byte byte : data)
            state = (state ^ std::to_integer<std::uint64_t>(byte)) * 1099511628211ull;
    }
    template <typename Number>
    requires std::is_arithmetic_v<Number>
    void add(Number number) { bytes(std::as_bytes(std::span(&number, 1))); }
    void add(const std::string& text) {
        add(std::uint64_t(text.size()));
        bytes(std::as_bytes(std::span(text)));
    }
    template <glm::length_t size, typename Number, glm::qualifier q>
    void add(const glm::vec<size, Number, q>& vector) {
        for (glm::length_t i = 0; i < size; ++i) add(vector[i]);
    }
    void add(const dmat4& matrix) {
        for (int column = 0; column < 4; ++column) add(matrix[column]);
    }
    template <typename Item>
    void add(const std::vector<Item>& list) {
        add(std::uint64_t(list.size()));
        for (const Item& item : list) add(item);
    }

    void add(const Mesh& mesh) {
        add(mesh.name), add(mesh.positions), add(mesh.normals), add(mesh.triangles);
        add(mesh.uv[0]), add(mesh.uv[1]), add(mesh.colours);
    }
    template <typename Thing>
    void add(const std::optional<Thing>& thing) {
        add(thing.has_value());
        if (thing) add(*thing);
    }
    void add(const Image& image) { add(image.size), add(image.texels); }
    void add(const Texture& texture) {
        add(add_once(texture.image.get()));
        add(static_cast<int>(texture.wrap_u)), add(static_cast<int>(texture.wrap_v));
        add(texture.nearest), add(texture.srgb), add(texture.uv_set);
        add(texture.u_row), add(texture.v_row);
    }
    void add(const Material& material) {
        visit_material_members(material, [this](const auto& member) { add(member); });
    }
    void add(const std::monostate&) {}
    void add(const HarmonicMotion& motion) { add(motion.amplitude), add(motion.period); }
    template <typename Value>
    void add(const Track<Value>& keys) {
        add(static_cast<int>(keys.interpolation));
        add(keys.times), add(keys.values), add(keys.in_tangents), add(keys.out_tangents);
    }
    void add(const Keyframes& motion) {
        add(add_once(motion.keys.get()));
        for (int column = 0; column < 3; ++column) add(motion.world_from_keys[column]);
        add(motion.rest), add(motion.repeats);
    }
    void add(const NodeRig::RigNode& node) {
        add(node.parent), add(node.parent_from_space);
        add(node.translation), add(node.rotation), add(node.scale);
        add(add_once(node.translations.get())), add(add_once(node.rotations.get()));
        add(add_once(node.scales.get()));
    }
    void add(const NodeRig& rig) { add(rig.nodes), add(rig.repeats); }
    void add(const RigAttachment& motion) {
        add(add_once(motion.rig.get())), add(std::uint64_t(motion.node));
        add(motion.node_from_object);
    }
    /// Returns the hash of a shared object, computed once. Many objects may follow the same keys,
    /// and many materials may show the same image.
    template <typename Shared>
    std::uint64_t add_once(const Shared* shared) {
        const auto [entry, is_new] = known.try_emplace(shared, 0);
        if (!is_new || shared == nullptr) return entry->second;
        SceneHasher hasher;
        hasher.add(*shared);
        return entry->second = hasher.state;
    }
    void add(const Motion& motion) {
        add(std::uint64_t(motion.index()));
        std::visit([this](const auto& kind) { add(kind); }, motion);
    }
    void add(PunctualLight::Kind kind) { add(static_cast<int>(kind)); }
    void add(const Object& object) {
        add(object.name), add(std::uint64_t(object.mesh)), add(std::uint64_t(object.material));
        add(object.world_from_object), add(object.motion);
        add(object.sphere);
        add(object.seen_by_camera), add(object.mirror);
    }
    void add(const Sphere& sphere) { add(sphere.centre), add(sphere.radius); }
    void add(const PunctualLight& light) {
        visit_light_members(light, [this](const auto& member) { add(member); });
    }
    void add(const Environment& environment) {
        add(environment.studio), add(environment.size), add(environment.texels);
        add(environment.scale), add(environment.rotation_degrees);
    }
    void add(const Camera& camera) {
        add(camera.name), add(camera.eye), add(camera.target), add(camera.up);
        add(camera.vertical_fov_degrees), add(camera.orthographic_height);
        if (camera.follows.rig) add(camera.follows);
    }
};

} // namespace

std::string hash_scene(const Scene& scene) {
    SceneHasher hasher;
    hasher.add(scene.meshes);
    hasher.add(scene.materials);
    hasher.add(scene.objects);
    hasher.add(scene.cameras);
    hasher.add(scene.punctual);
    hasher.add(hasher.add_once(scene.environment.get()));
    hasher.add(scene.mirror_max_roughness);
    hasher.add(scene.has_multiple_scattering);
    if (scene.light_samples != 1)
        hasher.add(scene.light_samples); // scenes without this member keep the hash
                                         // of earlier versions
    if (scene.environment_shadows != 0) {
        hasher.add(std::string("environment-shadows"));
        hasher.add(scene.environment_shadows);
    }
    if (scene.tints_glass_shadows) hasher.add(std::string("glass-shadow tint"));
    hasher.add(scene.exposure);
    std::string digits(16, '0');
    for (std::size_t i = 0; i < digits.size(); ++i)
        digits[i] = "0123456789abcdef"[(hasher.state >> (60 - 4 * i)) & 15];
    return digits;
}

} // namespace catoptric::scene
