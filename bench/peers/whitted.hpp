#pragma once

#include <embree3/rtcore.h>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

/// What `raytrace` traces (shaders/lib/whitted.glsl), traced by Embree: same camera, light, mirrors
/// and order of events, rays counted alike. No header of the engine is named here, so that
/// whitted.cpp can be compiled for this machine's processor alone.
namespace peers {

struct Vector {
    float x = 0, y = 0, z = 0;
};

struct Sphere {
    Vector centre;
    float radius = 0;
};

/// A place in the space of a texture.
struct Place {
    float u = 0, v = 0;
};

/// Linear colours, row by row, that repeat along both axes and are mixed between four.
struct Texture {
    std::vector<Vector> texels;
    int width = 0, height = 0;
};

/// What an object does with light.
struct Surface {
    Vector albedo, emission;
    Vector reflectance; ///< of a mirror at any angle, of what is sharp straight on; else 0
    bool is_mirror = false;
    bool is_sharp = false;              ///< reflects as Schlick says, all of it along the surface
    bool turns = false;                 ///< its normal turns to who looks
    bool fades = false;                 ///< light at it fades towards its facets' planes
    std::optional<std::size_t> texture; ///< by which its albedo is multiplied
};

struct Light {
    Vector position, normal, intensity; ///< normal zero: no cosine at the light
    bool is_spot = false;
    Vector axis;                        ///< of a spot, along which it shines
    float cos_outer = 0, sharpness = 1; ///< 1 / (cos inner - cos outer)
};

/// Numbers of geometries in a tree. Shadow rays pass through lamps' triangles.
enum GeometryNumber { kTriangles, kSpheres, kLamps };

/// A scene with point lights and spots.
struct Whitted {
    RTCScene tree = nullptr;
    std::vector<std::array<Vector, 3>> corners; ///< of triangles
    std::vector<std::array<Vector, 3>> normals; ///< likewise, at their corners
    std::vector<std::array<Place, 3>> places;   ///< likewise
    std::vector<std::uint32_t> triangle_objects;
    std::size_t first_lamp = 0; ///< of triangles: those of lamps follow all others
    std::vector<Sphere> spheres;
    std::vector<std::uint32_t> sphere_objects;
    std::vector<Surface> surfaces; ///< of objects
    std::vector<Texture> textures; ///< of materials, of which some have none
    std::vector<Light> lights;
    float ambient = 0;
    Vector eye, forward, right,
        down;                  ///< direction = forward + right * x + down * y, x and y in [-1, 1]
    int width = 0, height = 0; ///< multiples of 16
    int depth = 0;             ///< mirror bounces; a path that meets more ends black
    float shadow_end = 1;      ///< of the way to the light
    float facet_fade = 1;      ///< sine of the angle to a facet's plane within which light fades
    float lift = 0;            ///< how far off a surface rays start that leave it
};

struct RayCounts {
    std::uint64_t primary = 0, mirror = 0, shadow = 0;
    std::uint64_t all() const { return primary + mirror + shadow; }
};

struct Traced {
    std::vector<Vector> pixels; ///< linear radiance, row by row
    RayCounts rays;
};

/// One ray through each pixel's centre. `width`: rays in a call of Embree's, 1, 8 or 16. `threads`
/// take tiles of 16x16 pixels from one counter.
Traced trace(const Whitted& scene, int width, int threads);

} // namespace peers
