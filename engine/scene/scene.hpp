#pragma once

#include "../core/export.hpp"
#include "../core/math.hpp"
#include "environment.hpp"
#include "material.hpp"
#include "motion.hpp"
#include "unsupported_feature.hpp"

#include <array>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
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
    /// Of texture spaces 0 and 1, v downwards: one per position, or none, which is (0, 0).
    std::array<std::vector<vec2>, 2> uv;
    std::vector<vec4> colours; ///< one per position, linear with alpha, or none, which is 1
};

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
    /// Enough of its surface is sharp and reflects enough to be a mirror (see classify.hpp), though
    /// its material is none at every angle. A smooth dielectric that is none reflects, too.
    bool mirror = false;
};

/// Looks from `eye` to `target`; +x of the picture is cross(forward, up).
struct Camera {
    std::string name;
    dvec3 eye{0, 0, 0};
    dvec3 target{0, 0, 1};
    dvec3 up{0, 1, 0};
    double vertical_fov_degrees = 45;
    double orthographic_height = 0; ///< of the picture, world units; 0: in perspective
    Follows follows;                ///< the node that it rides on
    bool operator==(const Camera&) const = default;
};

/// A light without a surface, as KHR_lights_punctual has them, along -z of its node.
struct Punctual {
    enum class Kind { point, spot, directional };
    std::string name;
    Kind kind = Kind::point;
    vec3 intensity{0}; ///< candela; of a directional light illuminance, lux
    double range = std::numeric_limits<double>::infinity(); ///< world units: where it ends
    double cos_inner = 1, cos_outer = 0;                    ///< of a spot's half angles
    dmat4 world_from_light{1};
    Motion motion;
};

/// One light as the shading formula sees it: a point, with a one-sided cosine where it is that of a
/// lamp; or a direction.
struct PointLight {
    dvec3 position{0};    ///< mean of the mesh's vertices
    dvec3 normal{0};      ///< of a one-sided lamp: mean of the vertex normals, unit length or zero
    double area = 0;      ///< world units squared; 1 for a light without a surface
    bool is_lamp = false; ///< has a surface
    bool closed = false;  ///< of a lamp: every edge has two triangles
    /// Of an open lamp of two sides: orthogonal unit axes, right-handed, and the mean over its area
    /// of the facets' |cosine| to each; zero: of any other light.
    dmat3 axes{0};
    dvec3 cosines{0};
    vec3 emission{0}; ///< radiance; intensity or illuminance of a light without a surface
    dvec3 axis{0};    ///< where a spot or a directional light shines to, unit; zero: all around
    double range = std::numeric_limits<double>::infinity();
    double cos_inner = 1, cos_outer = -1; ///< of a spot
    bool directional = false;             ///< from infinitely far, against `axis`
};

struct Scene {
    std::string name;
    std::vector<Mesh> meshes;
    std::vector<Material> materials;
    std::vector<Object> objects;
    std::vector<Camera> cameras;
    std::vector<Punctual> punctual;
    std::shared_ptr<const Environment> environment; ///< none: black
    float mirror_max_roughness = .1f;               ///< what is no rougher is sharp
    std::optional<double> exposure;                 ///< stops, where the file says
    std::vector<UnsupportedFeature> unsupported;
    std::vector<std::string> warnings; ///< what the loader left out or repaired, for the user
    /// Real paths of the files that it was loaded from, the scene's own first, also of those that
    /// it names without their being read. Nothing else may be written there.
    std::vector<std::filesystem::path> files;
};

/// The scene as it stands `seconds` after its start: every motion applied to the transforms (and
/// to the exact spheres), cameras and lights without a surface too, none left. Pure. A time that is
/// not finite is `Failure::usage`.
CATOPTRIC_API Scene at(const Scene& scene, double seconds);
/// The same of one camera.
CATOPTRIC_API Camera camera_at(const Camera& camera, double seconds);

/// True when some object, light or camera moves.
CATOPTRIC_API bool is_animated(const Scene& scene);
/// The longest period of all motions, seconds; 0 when nothing moves.
CATOPTRIC_API double period(const Scene& scene);

/// Whether the object is a mirror: numbered, captured, counted.
CATOPTRIC_API bool is_mirror(const Scene& scene, const Object& object);
/// Indices into Scene::objects of the mirrors, in file order; mirror n (from 1) is entry n-1.
CATOPTRIC_API std::vector<std::size_t> mirrors(const Scene& scene);

/// One light for each connected component of each mesh that lights, in file order, then the others.
/// Vertices
/// connect through a shared index or an identical position (which then counts once in the mean);
/// triangles without area, and vertices that only they use, contribute nothing.
CATOPTRIC_API std::vector<PointLight> lights(const Scene& scene);

/// Returns how much of a light's area shines in the unit direction `along`, away from it, 0 to 1.
/// A lamp with a mean normal: the cosine to it. An open one of two sides: the mean |cosine| of its
/// facets, exact for a board, a tube and a ball. Any other lamp, first of all a closed one: a
/// quarter, which is the mean over all directions of what a convex body shows. A light without a
/// surface: 1.
CATOPTRIC_API double share_towards(const PointLight& light, const dvec3& along);

/// World-space bounds, at rest, of one object's triangles or of everything; empty for nothing.
CATOPTRIC_API Bounds<double> bounds(const Scene& scene, const Object& object);
CATOPTRIC_API Bounds<double> bounds(const Scene& scene);

CATOPTRIC_API std::size_t triangle_count(const Scene& scene);

/// Where a file has no camera: a three-quarter view of the centre of the bounds at rest, from the
/// front right and above (30 degrees, 20 degrees), vertical field of view 40 degrees, as near as
/// the bounds' eight corners lie within 90 % of the height and width of a picture `aspect` times as
/// wide as it is high. Rounded to about a millionth of its distance, so that it can be typed.
CATOPTRIC_API Camera default_camera(const Scene& scene, double aspect = 1);

/// 64-bit FNV-1a over names, geometry, materials, motion and cameras as 16 hex digits. The scene's
/// own name, its warnings and its files do not count: a copied file has the same hash.
CATOPTRIC_API std::string hash(const Scene& scene);

} // namespace catoptric::scene
