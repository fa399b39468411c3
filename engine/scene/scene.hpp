#pragma once

#include "../core/export.hpp"
#include "../core/math.hpp"
#include "environment.hpp"
#include "material.hpp"
#include "motion.hpp"
#include "unsupported_feature.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// Scenes as plain data in world units, in double precision until they are rebased for the device.
/// World space is right-handed. Units are those of the file.
namespace catoptric::scene {

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
    /// True if enough of the surface is sharp and reflects enough for a mirror (classify.hpp),
    /// although its material is no mirror at every angle. A smooth dielectric that is no mirror
    /// also reflects.
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
    Follows follows;                ///< node that carries the camera
    bool operator==(const Camera&) const = default;
};

/// Light without a surface, as in KHR_lights_punctual. It shines along -z of its node.
struct Punctual {
    /// Kinds of the table in scene/light_kind.hpp. A kind with a file of its own has the next
    /// number.
    enum class Kind : std::uint8_t { point, spot, directional };
    std::string name;
    Kind kind = Kind::point;
    vec3 intensity{0}; ///< candela; lux (illuminance) for a directional light
    double range = std::numeric_limits<double>::infinity(); ///< where its light ends, world units
    double cos_inner = 1, cos_outer = 0;                    ///< cosines of a spot's half angles
    dmat4 world_from_light{1};
    Motion motion;
};

/// Light as the shading formula sees it: a point or a direction. A one-sided lamp also has a cosine
/// to its normal.
struct PointLight {
    dvec3 position{0};    ///< position of the light; for a lamp, the mean of its vertices
    dvec3 normal{0};      ///< of an open one-sided lamp: mean vertex normal, unit length or zero
    double area = 0;      ///< world units squared; 1 for a light without a surface
    bool is_lamp = false; ///< whether the light is a lamp, which has a mesh
    bool closed = false;  ///< true for a lamp whose every edge has two triangles
    /// For an open two-sided lamp: orthogonal unit axes, right-handed. `cosines` holds the mean
    /// |cosine| of the lamp's facets to each axis, over its area. Both are zero for any other
    /// light.
    dmat3 axes{0};
    dvec3 cosines{0};
    vec3 emission{0}; ///< radiance of a lamp; intensity or illuminance of a light without a surface
    dvec3 axis{0}; ///< unit direction in which a spot or directional light shines; zero: all around
    double range = std::numeric_limits<double>::infinity();
    double cos_inner = 1, cos_outer = -1;        ///< cosines of a spot's half angles
    bool directional = false;                    ///< infinitely far away; shines along `axis`
    Punctual::Kind kind = Punctual::Kind::point; ///< of a light without a surface
};

struct Scene {
    std::string name;
    std::vector<Mesh> meshes;
    std::vector<Material> materials;
    std::vector<Object> objects;
    std::vector<Camera> cameras;
    std::vector<Punctual> punctual;
    std::shared_ptr<const Environment> environment; ///< none: black
    float mirror_max_roughness = .1f;               ///< surfaces up to this roughness are sharp
    std::optional<double> exposure;                 ///< stops, if the file gives them
    std::vector<UnsupportedFeature> unsupported;
    /// Messages to the user about features that the loader left out or repaired.
    std::vector<std::string> warnings;
    /// Real paths of the scene's files, its own first. They include files that the scene names but
    /// that were not read. No output may be written over them.
    std::vector<std::filesystem::path> files;
};

/// Returns the scene `seconds` after its start. Every motion is applied to transforms, exact
/// spheres, cameras and lights without a surface, and none is left. Pure. Throws `Failure::usage`
/// for a time that is not finite.
CATOPTRIC_API Scene at(const Scene& scene, double seconds);
/// Returns one camera `seconds` after the start.
CATOPTRIC_API Camera camera_at(const Camera& camera, double seconds);

/// Returns whether some object, light or camera moves.
CATOPTRIC_API bool is_animated(const Scene& scene);
/// Returns the longest period of all motions, in seconds; 0 if nothing moves.
CATOPTRIC_API double period(const Scene& scene);

/// Returns whether the object is a mirror: numbered, captured, counted.
CATOPTRIC_API bool is_mirror(const Scene& scene, const Object& object);
/// Returns the indices into Scene::objects of the mirrors, in file order. Mirror n, counted from 1,
/// is entry n-1.
CATOPTRIC_API std::vector<std::size_t> mirrors(const Scene& scene);

/// Returns the scene's lights: one for each connected component of each mesh that lights, in file
/// order, then the lights without a surface. Vertices connect through a shared index or an
/// identical position. Vertices at one position count once in the mean. Triangles without area, and
/// vertices that only they use, contribute nothing.
CATOPTRIC_API std::vector<PointLight> lights(const Scene& scene);

/// Returns how much of a light's area shines in the unit direction `along`, away from it, 0 to 1:
///   - A lamp with a mean normal: the cosine to that normal.
///   - An open two-sided lamp: mean |cosine| of its facets, exact for a board, a tube and a ball.
///   - Any other lamp, mainly a closed one: a quarter, the mean over all directions of the share
///     that a convex body shows.
///   - A light without a surface: 1.
CATOPTRIC_API double share_towards(const PointLight& light, const dvec3& along);

/// Returns the world-space bounds, at rest, of one object's triangles or of all objects. They are
/// empty if there are no triangles.
CATOPTRIC_API Bounds<double> bounds(const Scene& scene, const Object& object);
CATOPTRIC_API Bounds<double> bounds(const Scene& scene);

CATOPTRIC_API std::size_t triangle_count(const Scene& scene);

/// Returns the camera for a file without one. It looks at the centre of the bounds at rest, from
/// the front, 30 degrees to the right and 20 degrees above. The vertical field of view is 40
/// degrees. The eye is as near as the eight corners of the bounds stay within 90 % of the picture's
/// height and width. The picture is `aspect` times as wide as it is high. Positions are rounded to
/// about a millionth of the distance, so that they are short to type.
CATOPTRIC_API Camera default_camera(const Scene& scene, double aspect = 1);

/// Returns the 64-bit FNV-1a hash of names, geometry, materials, motion, cameras, lights and
/// environment, as 16 hex digits. The scene's own name, its warnings and its files do not count: a
/// copied file has the same hash.
CATOPTRIC_API std::string hash(const Scene& scene);

} // namespace catoptric::scene
