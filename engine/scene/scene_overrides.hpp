#pragma once

#include "scene/said_by.hpp"
#include "scene/scene.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

/// What a user says of a scene, on the command line or in a file beside it (scene_file.hpp).
namespace catoptric::scene {

/// Reflects this constant share of all light; the rest of the surface is dropped.
struct MirrorOverride {
    std::string pattern; ///< as `matches` takes it
    vec3 reflectance{1}; ///< in [0,1]
    bool operator==(const MirrorOverride&) const = default;
};

struct ExposureOverride {
    std::optional<double> stops; ///< none: "auto"
    bool operator==(const ExposureOverride&) const = default;
};

enum class Up { y, z };

inline constexpr double kMostStops = 64;   ///< of exposure, either way: 2^64 is finite
inline constexpr double kMostTurn = 36000; ///< degrees that an environment is turned, either way
inline constexpr double kMostScale = 1e30; ///< of what light is multiplied with

/// Each as the user gave it; what is empty was not said.
struct SceneOverrides {
    std::vector<MirrorOverride> mirrors; ///< a later one wins
    std::vector<std::string> lights;     ///< patterns
    std::optional<double> mirror_max_roughness;
    std::optional<bool> dielectric_mirrors;
    std::optional<std::string> environment; ///< "studio", "none", or a picture's file
    std::optional<double> environment_scale, environment_rotation;
    std::optional<ExposureOverride> exposure;
    std::optional<std::string> camera; ///< as camera_named takes it
    std::optional<Up> up;
    std::optional<std::string> animation; ///< name, or "none"
    std::optional<double> ambient;
    bool operator==(const SceneOverrides&) const = default;
};

/// Both, `stronger` where both say something; its mirrors and lights come after the others,
/// each pattern once.
SceneOverrides over(const SceneOverrides& stronger, const SceneOverrides& weaker);

/// Whether a whole name is the pattern, or what the pattern (fnmatch: * ? [...]) stands for; case
/// counts.
bool matches(const std::string& pattern, const std::string& name);

/// "PATTERN" or "PATTERN=REFLECTANCE", a number or r,g,b in [0,1]; a name may hold a '=' as long as
/// no number follows it. `option` begins the message. Throws `usage`.
MirrorOverride read_mirror_override(const std::string& option, const std::string& text);

/// The word of --mirror for what has this name: signs of patterns escaped, bytes that no terminal
/// shows as '?', of a long one the first 60 bytes.
std::string pattern_of(const std::string& name);

/// Throws as the file's, naming it and the key, for a pattern of mirrors or lights that `apply`
/// would not take.
void check_patterns(const Scene& scene, const SceneOverrides& overrides, const std::string& file);

/// Applies mirrors, lights, roughness and dielectrics, turns the scene, and finds its mirrors anew
/// (classify.hpp). What names a picture is left to app/resolved_scene.hpp. Throws `usage`, with the
/// nearest names, for a pattern without a match.
void apply(Scene& scene, const SceneOverrides& overrides);

/// Turns a scene whose up is +z so that it is +y: (x, y, z) becomes (x, z, -y), exactly.
void turn_z_up(Scene& scene);

/// Leaves `most` lights, the strongest at the centre of the bounds, at rest, of a mesh that lights
/// from several places some of them; what is left out is seen, but lights nothing. Adds the gap
/// "lights-left-out".
void leave_out_lights(Scene& scene, std::size_t most);

} // namespace catoptric::scene
