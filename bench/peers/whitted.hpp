#pragma once

#include <embree3/rtcore.h>

#include <array>
#include <cstdint>
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

/// What an object does with light.
struct Surface {
    Vector albedo, emission, reflectance;
    bool is_mirror = false;
};

/// A scene with one point light, one-sided. Geometry 0 of `tree` are triangles, geometry 1 spheres.
struct Whitted {
    RTCScene tree = nullptr;
    std::vector<std::array<Vector, 3>> normals; ///< of triangles, at their corners
    std::vector<std::uint32_t> triangle_objects;
    std::vector<Sphere> spheres;
    std::vector<std::uint32_t> sphere_objects;
    std::vector<Surface> surfaces; ///< of objects
    Vector light_position, light_normal, light_intensity;
    float ambient = 0;
    Vector eye, forward, right,
        down;                  ///< direction = forward + right * x + down * y, x and y in [-1, 1]
    int width = 0, height = 0; ///< multiples of 16
    int depth = 0;             ///< mirror bounces; a path that meets more ends black
    float shadow_end = 1;      ///< of the way to the light
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
