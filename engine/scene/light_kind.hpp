#pragma once

#include "scene/light.hpp"

#include <cstdint>
#include <string_view>
#include <vector>

/// Table of the kinds of lights without a surface. A kind is one row: its names in glTF and
/// reports, its parameters, and how much it emits in a direction. The .cpp of a kind registers it,
/// so that the code that reads, writes, hashes, compares, describes and uploads lights needs no
/// edit. shaders/lib/light_kinds.glsl shades with the kinds.
namespace catoptric::scene {

namespace gltf {
class JsonObject;
}

/// The two numbers of a light whose meaning depends on its kind: `cos_outer` and `sharpness` of
/// shared::Light.
struct LightShaderNumbers {
    float cos_outer = -3; ///< no cosine is below it, so all directions are lit
    float sharpness = 1;
};

struct LightKind {
    /// Number of the kind, which no other kind may have. A new kind takes the next free number.
    PunctualLight::Kind id = PunctualLight::Kind::point;
    /// Name in reports and `info`, and `type` of KHR_lights_punctual.
    std::string_view name;
    /// For a kind that glTF lacks: the `type` as which other programs read the light. The name is
    /// then stored in `extras`. Empty: the name is the type.
    std::string_view gltf_type = {};
    std::uint32_t shader_kind = 0; ///< shared::kLight... of the shaders
    bool is_aimed = true;          ///< whether the light shines along -z of its node
    /// Whether the light is infinitely far away. Such a light reaches everything, and its shadow
    /// views look along its axis. Any other light reaches as far as its range, and its shadow views
    /// are the faces of a cube.
    bool is_parallel = false;
    /// Returns the share of its intensity that the light emits at an angle with this cosine to its
    /// axis. Null: 1, and the light has no cone.
    double (*share)(const PointLight& light, double cosine) = nullptr;
    /// Returns the numbers with which the shaders compute the same share. Null: the defaults.
    LightShaderNumbers (*shader_numbers)(const PointLight& light) = nullptr;
    /// Reads the kind's parameters from a light of KHR_lights_punctual. Throws `bad_data`. May be
    /// null. save_glb writes a cone for each light with the type "spot".
    void (*read)(const gltf::JsonObject& light, PunctualLight& to) = nullptr;
};

/// Define it at namespace scope: the kind enters the table while the program starts.
struct RegisteredLightKind {
    explicit RegisteredLightKind(const LightKind& kind);
};

/// Returns all kinds by `id`.
const std::vector<LightKind>& light_kinds();
/// Throws `internal` for a kind that is not in the table.
const LightKind& find_light_kind(PunctualLight::Kind id);
/// Returns the type of a kind in KHR_lights_punctual.
std::string_view gltf_type_of(const LightKind& kind);

/// Reads the angles of the object "spot". Throws `bad_data`.
void read_spot_cone(const gltf::JsonObject& light, PunctualLight& to);

/// Calls `visit` with each member of a light, in the order of declaration. Hashes follow from these
/// lists; a member that is missing here does not compile.
template <typename Visit>
inline void visit_light_members(const PunctualLight& light, Visit&& visit) {
    const auto& [name, kind, intensity, range, cos_inner, cos_outer, world_from_light,
                 motion] = light;
    visit(name), visit(kind), visit(intensity), visit(range), visit(cos_inner), visit(cos_outer);
    visit(world_from_light), visit(motion);
}
template <typename Visit>
inline void visit_light_members(const PointLight& light, Visit&& visit) {
    const auto& [position, normal, area, is_lamp, closed, axes, cosines, half_axes, emission, axis,
                 range, cos_inner, cos_outer, directional, kind] = light;
    visit(position), visit(normal), visit(area), visit(is_lamp), visit(closed), visit(axes);
    visit(cosines), visit(half_axes), visit(emission), visit(axis), visit(range);
    visit(cos_inner), visit(cos_outer), visit(directional), visit(kind);
}

/// Returns whether two lights shine in the same way. Compares lights as scene::scene_at leaves
/// them: without motion. Names do not count.
bool have_equal_emission(const PunctualLight& a, const PunctualLight& b);

} // namespace catoptric::scene
