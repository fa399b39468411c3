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
    void add_members_to_hash(Number number) { bytes(std::as_bytes(std::span(&number, 1))); }
    void add_members_to_hash(const std::string& text) {
        add_members_to_hash(std::uint64_t(text.size()));
        bytes(std::as_bytes(std::span(text)));
    }
    template <glm::length_t size, typename Number, glm::qualifier q>
    void add_members_to_hash(const glm::vec<size, Number, q>& vector) {
        for (glm::length_t i = 0; i < size; ++i) add_members_to_hash(vector[i]);
    }
    void add_members_to_hash(const dmat4& matrix) {
        for (int column = 0; column < 4; ++column) add_members_to_hash(matrix[column]);
    }
    template <typename Item>
    void add_members_to_hash(const std::vector<Item>& list) {
        add_members_to_hash(std::uint64_t(list.size()));
        for (const Item& item : list) add_members_to_hash(item);
    }

    void add_members_to_hash(const Mesh& mesh) {
        add_members_to_hash(mesh.name), add_members_to_hash(mesh.positions),
            add_members_to_hash(mesh.normals), add_members_to_hash(mesh.triangles);
        add_members_to_hash(mesh.uv[0]), add_members_to_hash(mesh.uv[1]),
            add_members_to_hash(mesh.colours);
    }
    template <typename Thing>
    void add_members_to_hash(const std::optional<Thing>& thing) {
        add_members_to_hash(thing.has_value());
        if (thing) add_members_to_hash(*thing);
    }
    void add_members_to_hash(const Image& image) {
        add_members_to_hash(image.size), add_members_to_hash(image.texels);
    }
    void add_members_to_hash(const Texture& texture) {
        add_members_to_hash(hash_shared_object_once(texture.image.get()));
        add_members_to_hash(static_cast<int>(texture.wrap_u)),
            add_members_to_hash(static_cast<int>(texture.wrap_v));
        add_members_to_hash(texture.nearest), add_members_to_hash(texture.srgb),
            add_members_to_hash(texture.uv_set);
        add_members_to_hash(texture.u_row), add_members_to_hash(texture.v_row);
    }
    void add_members_to_hash(const Material& material) {
        visit_material_members(material,
                               [this](const auto& member) { add_members_to_hash(member); });
    }
    void add_members_to_hash(const std::monostate&) {}
    void add_members_to_hash(const HarmonicMotion& motion) {
        add_members_to_hash(motion.amplitude), add_members_to_hash(motion.period);
    }
    template <typename Value>
    void add_members_to_hash(const Track<Value>& keys) {
        add_members_to_hash(static_cast<int>(keys.interpolation));
        add_members_to_hash(keys.times), add_members_to_hash(keys.values),
            add_members_to_hash(keys.in_tangents), add_members_to_hash(keys.out_tangents);
    }
    void add_members_to_hash(const Keyframes& motion) {
        add_members_to_hash(hash_shared_object_once(motion.keys.get()));
        for (int column = 0; column < 3; ++column)
            add_members_to_hash(motion.world_from_keys[column]);
        add_members_to_hash(motion.rest), add_members_to_hash(motion.repeats);
    }
    void add_members_to_hash(const NodeRig::RigNode& node) {
        add_members_to_hash(node.parent), add_members_to_hash(node.parent_from_space);
        add_members_to_hash(node.translation), add_members_to_hash(node.rotation),
            add_members_to_hash(node.scale);
        add_members_to_hash(hash_shared_object_once(node.translations.get())),
            add_members_to_hash(hash_shared_object_once(node.rotations.get()));
        add_members_to_hash(hash_shared_object_once(node.scales.get()));
    }
    void add_members_to_hash(const NodeRig& rig) {
        add_members_to_hash(rig.nodes), add_members_to_hash(rig.repeats);
    }
    void add_members_to_hash(const RigAttachment& motion) {
        add_members_to_hash(hash_shared_object_once(motion.rig.get())),
            add_members_to_hash(std::uint64_t(motion.node));
        add_members_to_hash(motion.node_from_object);
    }
    /// Returns the hash of a shared object, computed once. Many objects may follow the same keys,
    /// and many materials may show the same image.
    template <typename Shared>
    std::uint64_t hash_shared_object_once(const Shared* shared) {
        const auto [entry, is_new] = known.try_emplace(shared, 0);
        if (!is_new || shared == nullptr) return entry->second;
        SceneHasher hasher;
        hasher.add_members_to_hash(*shared);
        return entry->second = hasher.state;
    }
    void add_members_to_hash(const Motion& motion) {
        add_members_to_hash(std::uint64_t(motion.index()));
        std::visit([this](const auto& kind) { add_members_to_hash(kind); }, motion);
    }
    void add_members_to_hash(PunctualLight::Kind kind) {
        add_members_to_hash(static_cast<int>(kind));
    }
    void add_members_to_hash(const Object& object) {
        add_members_to_hash(object.name), add_members_to_hash(std::uint64_t(object.mesh)),
            add_members_to_hash(std::uint64_t(object.material));
        add_members_to_hash(object.world_from_object), add_members_to_hash(object.motion);
        add_members_to_hash(object.sphere);
        add_members_to_hash(object.seen_by_camera), add_members_to_hash(object.mirror);
    }
    void add_members_to_hash(const Sphere& sphere) {
        add_members_to_hash(sphere.centre), add_members_to_hash(sphere.radius);
    }
    void add_members_to_hash(const PunctualLight& light) {
        visit_light_members(light, [this](const auto& member) { add_members_to_hash(member); });
    }
    void add_members_to_hash(const Environment& environment) {
        add_members_to_hash(environment.studio), add_members_to_hash(environment.size),
            add_members_to_hash(environment.texels);
        add_members_to_hash(environment.scale), add_members_to_hash(environment.rotation_degrees);
    }
    void add_members_to_hash(const Camera& camera) {
        add_members_to_hash(camera.name), add_members_to_hash(camera.eye),
            add_members_to_hash(camera.target), add_members_to_hash(camera.up);
        add_members_to_hash(camera.vertical_fov_degrees),
            add_members_to_hash(camera.orthographic_height);
        if (camera.follows.rig) add_members_to_hash(camera.follows);
    }
};

} // namespace

std::string hash_scene(const Scene& scene) {
    SceneHasher hasher;
    hasher.add_members_to_hash(scene.meshes);
    hasher.add_members_to_hash(scene.materials);
    hasher.add_members_to_hash(scene.objects);
    hasher.add_members_to_hash(scene.cameras);
    hasher.add_members_to_hash(scene.punctual);
    hasher.add_members_to_hash(hasher.hash_shared_object_once(scene.environment.get()));
    hasher.add_members_to_hash(scene.mirror_max_roughness);
    hasher.add_members_to_hash(scene.has_multiple_scattering);
    if (scene.light_samples != 1)
        hasher.add_members_to_hash(scene.light_samples); // scenes without this member keep the hash
                                                         // of earlier versions
    if (scene.environment_shadows != 0) {
        hasher.add_members_to_hash(std::string("environment-shadows"));
        hasher.add_members_to_hash(scene.environment_shadows);
    }
    if (scene.tints_glass_shadows) hasher.add_members_to_hash(std::string("glass-shadow tint"));
    hasher.add_members_to_hash(scene.exposure);
    std::string digits(16, '0');
    for (std::size_t i = 0; i < digits.size(); ++i)
        digits[i] = "0123456789abcdef"[(hasher.state >> (60 - 4 * i)) & 15];
    return digits;
}

} // namespace catoptric::scene
