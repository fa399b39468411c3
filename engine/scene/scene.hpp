#pragma once

#include "../core/export.hpp"
#include "../core/math.hpp"
#include "material.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

/// Scenes as plain data in doubles. World space is right-handed, in units of the file. A time
/// before or after all keys of a motion takes the first or last key.
namespace catoptric::scene {

/// translation(t) = amplitude * (1 - cos(2 pi t / period)), world units; 0 at t = 0.
struct HarmonicMotion {
    dvec3 amplitude{0};
    double period = 1; ///< seconds, > 0
};

enum class Interpolation { step, linear, cubic };

/// Values over time. Interpolation is step, linear, or cubic Hermite as in glTF's CUBICSPLINE.
template <typename Value>
struct Track {
    using Interpolation = scene::Interpolation;
    Interpolation interpolation = Interpolation::linear;
    std::vector<double> times; ///< seconds, increasing
    std::vector<Value> values;
    std::vector<Value> in_tangents, out_tangents; ///< only with `cubic`
};
using TranslationTrack = Track<dvec3>; ///< positions or scales

/// World-space translation from the place at rest: world_from_keys * (position - rest).
struct Keyframes {
    std::shared_ptr<const TranslationTrack> keys; ///< none, or keys without times: stands still
    dmat3 world_from_keys{1};
    dvec3 rest{0};
    /// Whether the motion starts again after the last key; false: the object stays there.
    bool repeats = true;
};

struct NodeRig; // hierarchy of moving nodes that a loader makes; internal

/// Attachment to a node of a rig: world_from_node * node_from_object replaces the transform at
/// rest, that of the first instant. For a camera, it carries eye, target and up.
struct RigAttachment {
    std::shared_ptr<const NodeRig> rig; ///< none: stands still
    std::size_t node = 0;
    dmat4 node_from_object{1};
    bool operator==(const RigAttachment&) const = default;
};

using Motion = std::variant<std::monostate, HarmonicMotion, Keyframes, RigAttachment>;

/// Picture around the scene, seen by every ray that leaves the scene: radiance by direction. The
/// picture is equirectangular: row 0 is at +y, the middle column at -z, and +x lies to its right.
/// Lookups are bilinear; they wrap horizontally and clamp at the poles.
struct Environment {
    std::string name; ///< file name; "studio" for the built-in environment, which has no texels
    bool studio = false;
    uvec2 size{0};
    std::vector<vec3> texels; ///< row-major, linear
    double scale = 1;
    double rotation_degrees = 0; ///< moves azimuth A to A + this; azimuth grows from -z to +x
};

/// Something in a scene file that is left out, approximated or added. Ids are fixed words:
/// "normal-texture", "rough-metal", "added-camera" ...
struct UnsupportedFeature {
    std::string id;
    std::uint64_t count = 0;
    std::string first; ///< first place, printable
    /// Indices into Scene::materials of the materials with this feature, if it concerns materials.
    std::vector<std::size_t> materials;
};

/// Triangles with a normal at each vertex, object space.
struct Mesh {
    std::string name;
    std::vector<dvec3> positions;
    std::vector<vec3> normals; ///< one per position, unit length
    std::vector<uvec3> triangles;
    /// Texture coordinates of texture spaces 0 and 1, v downwards: one per position, or none, which
    /// means (0, 0).
    std::array<std::vector<vec2>, 2> uv;
    std::vector<vec4> colours; ///< one per position, linear with alpha; none means 1
};

/// Exact sphere in world space, which an object's mesh approximates.
struct Sphere {
    dvec3 centre{0};
    double radius = 0;
};

struct Object {
    std::string name;
    std::size_t mesh = 0;     ///< index into Scene::meshes
    std::size_t material = 0; ///< index into Scene::materials
    dmat4 world_from_object{1};
    Motion motion;
    std::optional<Sphere> sphere; ///< set when the mesh stands for this sphere
    /// False: camera rays pass through the object, and all other rays meet it.
    bool seen_by_camera = true;
    /// True for glass, and for what reflects enough for a mirror at some angle (classify.hpp).
    /// Material::mirror marks mirrors whose reflectance is the same at every angle.
    bool mirror = false;
};

/// Camera that looks from `eye` to `target`; +x of the picture is cross(forward, up).
struct Camera {
    std::string name;
    dvec3 eye{0, 0, 0};
    dvec3 target{0, 0, 1};
    dvec3 up{0, 1, 0};
    double vertical_fov_degrees = 45;
    double orthographic_height = 0; ///< height of the picture, world units; 0: perspective
    RigAttachment follows;          ///< node that carries the camera
    bool operator==(const Camera&) const = default;
};

/// Light without a surface, as in KHR_lights_punctual. It shines along -z of its node.
struct PunctualLight {
    enum class Kind : std::uint8_t { point, spot, directional }; ///< ids: scene/light_kind.hpp
    std::string name;
    Kind kind = Kind::point;
    vec3 intensity{0}; ///< candela; lux (illuminance) for a directional light
    double range = std::numeric_limits<double>::infinity(); ///< where its light ends, world units
    double cos_inner = 1, cos_outer = 0;                    ///< cosines of a spot's half angles
    dmat4 world_from_light{1};
    Motion motion;
};

struct Scene {
    std::string name;
    std::vector<Mesh> meshes;
    std::vector<Material> materials;
    std::vector<Object> objects;
    std::vector<Camera> cameras;
    std::vector<PunctualLight> punctual;
    std::shared_ptr<const Environment> environment; ///< none: black
    float mirror_max_roughness = .6f;               ///< rougher surfaces are no mirrors
    bool has_multiple_scattering = false;           ///< rough lobes lose no light (Turquin 2019)
    bool tints_glass_shadows = false;               ///< glass attenuates the light of shadow rays
    int light_samples = 1;                          ///< points that replace each lamp
    int environment_shadows = 0;    ///< rays from traced surfaces to the environment; 0: no shadows
    std::optional<double> exposure; ///< stops, if the file gives them
    std::vector<UnsupportedFeature> unsupported;
    std::vector<std::string> warnings; ///< about features that the loader left out or repaired
    /// Real paths of the scene's files, its own first, read or not. No output may replace them.
    std::vector<std::filesystem::path> files;
};

/// Throws `Failure::bad_data`, with the place, unless all indices, list lengths and numbers are as
/// the types above say. Sessions, comparisons, savers and edits check a scene; the rest trusts it.
CATOPTRIC_API void check_scene(const Scene& scene);

/// Returns the scene `seconds` after its start, with every motion applied and none left. Pure.
/// Throws `Failure::usage` for a time that is not finite.
CATOPTRIC_API Scene scene_at(const Scene& scene, double seconds);
/// Returns whether the object is a mirror: numbered, captured, counted.
CATOPTRIC_API bool is_mirror(const Scene& scene, const Object& object);
/// Returns the indices into Scene::objects of the mirrors, in file order. Mirror n, counted from 1,
/// is entry n-1.
CATOPTRIC_API std::vector<std::size_t> mirrors(const Scene& scene);

/// Returns the world-space bounds, at rest, of the triangles of one object or all; maybe empty.
CATOPTRIC_API Bounds<double> bounds(const Scene& scene, const Object& object);
CATOPTRIC_API Bounds<double> bounds(const Scene& scene);

CATOPTRIC_API std::size_t triangle_count(const Scene& scene);

} // namespace catoptric::scene
