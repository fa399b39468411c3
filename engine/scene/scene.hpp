#pragma once

#include "core/math.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

/// A scene is plain data in world units, in double precision until it is rebased for the device.
/// World space is right-handed; units are whatever the file uses.
namespace catoptric::scene {

/// Triangles with a normal at each vertex, object space.
struct Mesh {
    std::string name;
    std::vector<dvec3> positions;
    std::vector<vec3> normals; ///< one per position, unit length
    std::vector<uvec3> triangles;
};

/// Lambertian surface, light, or perfect mirror (contract: "Light and materials").
struct Material {
    std::string name;
    vec3 albedo{0};   ///< kd in [0,1]
    vec3 emission{0}; ///< radiance Ke; non-zero makes each connected mesh a light
    bool mirror = false;
    vec3 reflectance{1};    ///< of a mirror, in [0,1]
    bool two_sided = false; ///< of a light: shines to both sides, without a cosine
};

/// Whether the surface is only there from its front, for eyes and rays that see: a light that
/// shines to one side. Anything else has two sides, and all but a light casts its shadow from both.
bool is_one_sided(const Material& material);

/// translation(t) = amplitude * (1 - cos(2 pi t / period)), world units; 0 at t = 0.
struct Harmonic {
    dvec3 amplitude{0};
    double period = 1; ///< seconds, > 0
};

/// Places in time, cubic Hermite as glTF's CUBICSPLINE (or linear or step).
struct Keys {
    enum class Interpolation { step, linear, cubic } interpolation = Interpolation::linear;
    std::vector<double> times; ///< seconds, increasing
    std::vector<dvec3> values;
    std::vector<dvec3> in_tangents, out_tangents; ///< only with `cubic`
};

/// World-space translation through keys, world_from_keys * (place - rest), relative to the object's
/// place at rest; repeats after the last key. Objects share the keys that they follow.
struct Keyframes {
    std::shared_ptr<const Keys> keys; ///< none, or without a time: stands still
    dmat3 world_from_keys{1};
    dvec3 rest{0};
};

using Motion = std::variant<std::monostate, Harmonic, Keyframes>;

/// An exact sphere in world space, where the object's mesh approximates one.
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
    bool seen_by_camera = true;   ///< false: camera rays pass through, everything else meets it
};

/// Looks from `eye` to `target`; +x of the picture is cross(forward, up).
struct Camera {
    std::string name;
    dvec3 eye{0, 0, 0};
    dvec3 target{0, 0, 1};
    dvec3 up{0, 1, 0};
    double vertical_fov_degrees = 45;
    bool operator==(const Camera&) const = default;
};

/// One light as the shading formula sees it: a point with a one-sided cosine.
/// `normal` zero means no cosine at the light.
struct PointLight {
    dvec3 position{0}; ///< mean of the mesh's vertices
    dvec3 normal{0};   ///< mean of the vertex normals, unit length or zero
    double area = 0;   ///< world units squared
    vec3 emission{0};  ///< radiance
};

struct Scene {
    std::string name;
    std::vector<Mesh> meshes;
    std::vector<Material> materials;
    std::vector<Object> objects;
    std::vector<Camera> cameras;
    std::vector<std::string> warnings; ///< what the loader left out or repaired, for the user
    /// Real paths of the files that it was loaded from, the scene's own first, also of those that
    /// it names without their being read. Nothing else may be written there.
    std::vector<std::filesystem::path> files;
};

/// The keys with their places and tangents as the world has them, relative to the object's rest.
Keys in_the_world(const Keyframes& motion);

/// The scene as it stands `seconds` after its start: every motion applied to the transforms (and
/// to the exact spheres), none left. Pure. A time that is not finite is `Failure::usage`.
Scene at(const Scene& scene, double seconds);

/// True when some object moves.
bool is_animated(const Scene& scene);
/// The longest period of all motions, seconds; 0 when nothing moves.
double period(const Scene& scene);

/// Indices into Scene::objects of the mirrors, in file order; mirror n (from 1) is entry n-1.
std::vector<std::size_t> mirrors(const Scene& scene);

/// One light for each connected component of each emissive object's mesh, in file order. Vertices
/// connect through a shared index or an identical position (which then counts once in the mean);
/// triangles without area, and vertices that only they use, contribute nothing.
std::vector<PointLight> lights(const Scene& scene);

/// World-space bounds, at rest, of one object's triangles or of everything; empty for nothing.
Bounds<double> bounds(const Scene& scene, const Object& object);
Bounds<double> bounds(const Scene& scene);

std::size_t triangle_count(const Scene& scene);

/// Where a file has no camera: along the axis of the bounds' smallest extent, whole bounds in view
/// of a square picture. Stands on the positive side, as glTF models face +z.
Camera default_camera(const Scene& scene);

/// 64-bit FNV-1a over names, geometry, materials, motion and cameras as 16 hex digits. The scene's
/// own name, its warnings and its files do not count: a copied file has the same hash.
std::string hash(const Scene& scene);

} // namespace catoptric::scene
