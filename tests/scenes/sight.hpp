#pragma once

#include "app/rays.hpp"
#include "app/run.hpp"
#include "bvh/closest_hit.hpp"
#include "render/geometry.hpp"
#include "render/space.hpp"

#include <vector>

/// What rays of a request's camera meet, on the processor, apart from what the device computes.
namespace scenes {

using namespace catoptric;

/// Rays a pixel's side: the middle one goes through the pixel's centre.
inline constexpr std::uint32_t kFine = 3;

struct Seen {
    int object = -1;            ///< -1: nothing
    float distance = 0;         ///< along the ray, scene units
    vec3 place{0};              ///< scene units
    vec3 facet{0}, normal{0};   ///< unit; `normal` on the side that is looked at
    int cut = 0;                ///< surfaces that the ray passed where they are cut out
    std::uint32_t shadowed = 0; ///< bit n: light n, which the surface faces, is hidden from it
    std::uint64_t texels = 0;   ///< differs where a texture that is not filtered does
    bool sharp = false;         ///< smooth enough to be reflected in
    vec4 texel{0};              ///< base colour's, as the file has it, 0..1; alpha last
};

class Sight {
public:
    /// At the request's instant. Costs a hierarchy over all triangles.
    explicit Sight(const app::Request& request);

    /// kFine x kFine rays a pixel, row by row; some two microseconds a ray, more with lights.
    std::vector<Seen> look() const;
    /// Width of a pixel so far away, scene units.
    float pixel_at(float distance) const;

private:
    struct Met {
        bvh::Hit<float> hit;
        vec4 uv{0};
        float alpha = 1;
    };
    /// The first thing that is not cut out at the place; `cut`: how many were.
    std::optional<Met> meet(f32::Ray ray, float farthest, std::uint32_t skipped, int& cut) const;
    Seen see(const f32::Ray& ray) const;
    std::uint32_t shadows(const Seen& seen, std::uint32_t triangle) const;
    const scene::Material& material_of(std::uint32_t object) const {
        return now_.materials[now_.objects[object].material];
    }

    scene::Scene now_;
    render::Space space_;
    render::Geometry geometry_;
    std::vector<uvec3> triangles_; ///< by original number: corners in the geometry's lists
    bvh::Bvh tree_;
    shared::View view_;
    uvec2 size_;
    std::vector<scene::PointLight> lights_;
};

} // namespace scenes
