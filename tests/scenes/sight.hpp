#pragma once

#include "bvh/closest_hit.hpp"
#include "render/geometry.hpp"
#include "render/space.hpp"
#include "scene/light.hpp"
#include "session/rays.hpp"
#include "session/run.hpp"

#include <vector>

/// Finds what rays of a request's camera meet. The host does this, independently of the device.
namespace scenes {

using namespace catoptric;

/// Rays along each side of a pixel. The middle ray goes through the pixel's centre.
inline constexpr std::uint32_t kRaysAlongPixelEdge = 3;

struct SeenSurface {
    int object = -1;            ///< index; -1: the ray meets nothing
    float distance = 0;         ///< distance along the ray, scene units
    vec3 place{0};              ///< scene units
    vec3 facet{0}, normal{0};   ///< unit vectors; `normal` faces the camera
    int cut = 0;                ///< cut-out surfaces that the ray passed through
    std::uint32_t shadowed = 0; ///< bit n: faces light n, but lies in its shadow
    std::uint64_t texels = 0;   ///< hash of the texels of unfiltered textures
    bool sharp = false;         ///< smooth enough to show reflections
    vec4 texel{0};              ///< base colour as in the file, 0 to 1; alpha last
};

class SceneSurfaceCaster {
public:
    /// Prepares the scene at the request's time. Builds a BVH over all triangles.
    explicit SceneSurfaceCaster(const session::Request& request);

    /// Returns what kRaysAlongPixelEdge x kRaysAlongPixelEdge rays per pixel meet, row by row. A
    /// ray takes about two microseconds, more with lights.
    std::vector<SeenSurface> find_surfaces_seen_by_camera() const;
    /// Returns the width of a pixel at a distance, both in scene units.
    float pixel_at(float distance) const;

private:
    struct CutOutSurface {
        bvh::RayHit<float> hit;
        vec4 uv{0};
        float alpha = 1;
    };
    /// Returns the first hit outside the cut-out parts of surfaces. `cut` becomes the number of
    /// cut-out surfaces before the hit.
    std::optional<CutOutSurface> find_first_solid_hit(f32::Ray ray, float farthest,
                                                      std::uint32_t skipped, int& cut) const;
    SeenSurface find_surface_seen_by_ray(const f32::Ray& ray) const;
    std::uint32_t find_lights_hidden_from_place(const SeenSurface& seen,
                                                std::uint32_t triangle) const;
    const scene::Material& material_of_object(std::uint32_t object) const {
        return current_scene_.materials[current_scene_.objects[object].material];
    }

    scene::Scene current_scene_;
    render::SceneUnits space_;
    render::FrameGeometry geometry_;
    std::vector<uvec3> triangles_; ///< indices of the corners of each triangle
    bvh::Bvh tree_;
    shared::View view_;
    uvec2 size_;
    std::vector<scene::PointLight> lights_;
};

} // namespace scenes
