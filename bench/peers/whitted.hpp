#pragma once

#include <embree3/rtcore.h>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

/// Whitted ray tracing with Embree that equals technique `raytrace` (shaders/lib/whitted.glsl):
/// camera, lights, mirrors, order of rays and ray counts are the same. This header includes no
/// header of the engine, because whitted.cpp is compiled for this machine's processor alone.
namespace peers {

struct PeerVector3 {
    float x = 0, y = 0, z = 0;
};

struct PeerSphere {
    PeerVector3 centre;
    float radius = 0;
};

/// Texture coordinates of a point.
struct UvCoordinates {
    float u = 0, v = 0;
};

/// A texture of linear colours, row by row, which repeats along both axes and is sampled
/// bilinearly.
struct PeerAlbedoTexture {
    std::vector<PeerVector3> texels;
    int width = 0, height = 0;
};

/// The reflection and emission of an object's surface.
struct PeerSurfaceMaterial {
    PeerVector3 albedo, emission;
    /// Reflectance of a mirror at any angle, or of a smooth dielectric seen head-on; else 0.
    PeerVector3 reflectance;
    bool is_mirror = false;
    bool is_sharp = false;              ///< the surface is a smooth dielectric, whose F90 is 1
    bool turns = false;                 ///< the surface's normal turns to the viewer's side
    bool fades = false;                 ///< light fades towards the planes of the surface's facets
    std::optional<std::size_t> texture; ///< texture that multiplies the albedo
};

struct PeerSceneLight {
    PeerVector3 position, normal, intensity; ///< a zero normal means no cosine factor at the light
    bool is_spot = false;
    PeerVector3 axis;                   ///< direction in which a spot shines
    float cos_outer = 0, sharpness = 1; ///< sharpness: 1 / (cos inner - cos outer) of a spot
};

/// Numbers of the geometries in an Embree tree. Shadow rays pass through the lamps' triangles.
enum EmbreeGeometryNumber { kTriangles, kSpheres, kLamps };

/// A scene with point lights and spots.
struct WhittedTracerScene {
    RTCScene tree = nullptr;
    std::vector<std::array<PeerVector3, 3>> corners; ///< corners of each triangle
    std::vector<std::array<PeerVector3, 3>> normals; ///< normals at the corners of each triangle
    std::vector<std::array<UvCoordinates, 3>>
        places; ///< texture coordinates of each triangle's corners
    std::vector<std::uint32_t> triangle_objects;
    std::size_t first_lamp = 0; ///< first triangle of a lamp; lamps' triangles follow all others
    std::vector<PeerSphere> spheres;
    std::vector<std::uint32_t> sphere_objects;
    std::vector<PeerSurfaceMaterial> surfaces; ///< surface of each object
    std::vector<PeerAlbedoTexture>
        textures; ///< texture of each material; empty for a material without a texture
    std::vector<PeerSceneLight> lights;
    float ambient = 0;
    PeerVector3 eye, forward, right,
        down;                  ///< camera ray: forward + right * x + down * y, x and y in [-1, 1]
    int width = 0, height = 0; ///< size of the picture, multiples of 16
    int depth = 0;             ///< most mirror bounces; a path with more mirrors ends black
    float shadow_end = 1;      ///< share of the way to the light at which shadow rays end
    float facet_fade = 1;      ///< sine of the angle to a facet's plane within which light fades
    float lift = 0;            ///< distance from a surface at which rays that leave it start
};

struct PeerRayCounts {
    std::uint64_t primary = 0, mirror = 0, shadow = 0;
    std::uint64_t total_ray_count() const { return primary + mirror + shadow; }
};

struct PeerTracedPicture {
    std::vector<PeerVector3> pixels; ///< linear radiance, row by row
    PeerRayCounts rays;
};

/// Traces a picture with one camera ray through each pixel's centre. Each call to Embree traces
/// `width` rays: 1, 8 or 16. Each of `threads` threads takes tiles of 16x16 pixels from a shared
/// counter.
PeerTracedPicture trace_whitted_picture(const WhittedTracerScene& scene, int width, int threads);

} // namespace peers
