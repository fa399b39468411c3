#pragma once

#include "scene/scene.hpp"
#include "scene/setting_origin.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

/// Scene overrides, which a user gives on the command line or in a file beside the scene
/// (scene_file.hpp).
namespace catoptric::scene {

/// Mirror that reflects a constant share of all light. The rest of the object's material is
/// dropped.
struct MirrorOverride {
    std::string pattern; ///< a pattern as `matches` takes it
    vec3 reflectance{1}; ///< in [0,1]; of a rough mirror, seen head-on
    float roughness = 0; ///< in [0,1]; 0: a perfect mirror at every angle, else a metal's lobe
    bool operator==(const MirrorOverride&) const = default;
};

/// Returns the material of an object that the override makes a mirror: a perfect mirror, or metal.
Material make_mirror_material(std::string name, const MirrorOverride& wish);

struct ExposureOverride {
    std::optional<double> stops; ///< none: "auto"
    bool operator==(const ExposureOverride&) const = default;
};

enum class UpAxis { y, z };

inline constexpr double kMaxExposureStops =
    64; ///< limit of exposure in either direction; 2^64 is finite
inline constexpr double kMaxRotationDegrees =
    36000;                                     ///< limit of an environment's rotation, degrees
inline constexpr double kMaxLightScale = 1e30; ///< limit of factors that scale light
inline constexpr int kMaxLightSamples =
    128; ///< most points that replace a lamp (shared::kMaxLights)

inline constexpr int kMaxEnvironmentShadows = 1024; ///< most rays to the environment

/// Overrides as the user gave them. An empty member was not given.
struct SceneOverrides {
    std::vector<MirrorOverride> mirrors; ///< a later override wins over an earlier one
    std::vector<std::string> lights;     ///< patterns of objects that become lights
    std::optional<double> mirror_max_roughness;
    std::optional<bool> dielectric_mirrors;
    std::optional<bool> multiple_scattering; ///< "turquin" in files and on the command line
    std::optional<bool> tints_glass_shadows; ///< "tint" in files and on the command line
    std::optional<int> light_samples;        ///< points for each lamp, 1 to kMaxLightSamples
    std::optional<int> environment_shadows;  ///< rays, 0 to kMaxEnvironmentShadows
    std::optional<std::string> environment;  ///< "studio", "none", or a picture's file
    std::optional<double> environment_scale, environment_rotation;
    std::optional<ExposureOverride> exposure;
    std::optional<std::string> camera; ///< a camera as `find_camera` takes it
    std::optional<UpAxis> up;
    std::optional<std::string> animation; ///< name, or "none"
    std::optional<double> ambient;
    bool operator==(const SceneOverrides&) const = default;
};

/// Returns both sets of overrides combined. `stronger` wins where both give a value. Its mirrors
/// and lights come after those of `weaker`, each pattern once.
SceneOverrides combine(const SceneOverrides& stronger, const SceneOverrides& weaker);

/// Returns whether a whole name equals the pattern or matches it (fnmatch: * ? [...]); case counts.
bool matches(const std::string& pattern, const std::string& name);

/// Reads "PATTERN[=REFLECTANCE][,roughness=NUMBER]", where REFLECTANCE is a number or r,g,b in
/// [0,1] and NUMBER is in [0,1]. A name may contain '=' as long as no number follows it. `option`
/// begins the error message. Throws `usage`.
MirrorOverride parse_mirror_override(const std::string& option, const std::string& text);

/// Returns the value of --mirror that selects this name. Pattern characters are escaped. Bytes that
/// a terminal does not show become '?'. A name longer than 60 bytes is reduced to its beginning.
std::string mirror_pattern(const std::string& name);

/// Checks the patterns of mirrors and lights that come from a file. Throws `bad_data`, naming file
/// and key, for a pattern that `apply_overrides` would not accept.
void check_patterns(const Scene& scene, const SceneOverrides& overrides, const std::string& file);

/// Applies the overrides of mirrors, lights, roughness and dielectrics, turns the scene if +z is
/// up, and finds its mirrors again (classify.hpp). Overrides that name a picture are left to
/// session/resolved_scene.hpp. Throws `usage`, with the nearest names, for a pattern without a
/// match, or a mirror rougher than the scene's mirrors may be.
void apply_overrides(Scene& scene, const SceneOverrides& overrides);

/// Turns a scene from +z up to +y up: (x, y, z) becomes (x, z, -y), exactly.
void turn_to_y_up(Scene& scene);

/// Keeps the `most` lights that are strongest at the centre of the bounds, at rest. A mesh that
/// lights from several places may keep some of them. The other lights stay visible but light
/// nothing. Adds the unsupported feature "lights-left-out".
void drop_weakest_lights(Scene& scene, std::size_t most);

} // namespace catoptric::scene
