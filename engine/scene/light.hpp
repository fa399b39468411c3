#pragma once

#include "scene/scene.hpp"

#include <limits>
#include <optional>
#include <vector>

namespace catoptric::scene {

/// Light as the shading formula sees it: a point or a direction. A one-sided lamp also has a cosine
/// to its normal.
struct PointLight {
    dvec3 position{0};    ///< for a lamp, the mean of its vertices
    dvec3 normal{0};      ///< of an open one-sided lamp: mean vertex normal, unit length or zero
    double area = 0;      ///< world units squared; 1 for a light without a surface
    bool is_lamp = false; ///< has a mesh
    bool closed = false;  ///< true for a lamp whose every edge has two triangles
    /// For an open two-sided lamp: orthogonal unit axes, right-handed. `cosines` holds the mean
    /// |cosine| of the lamp's facets to each axis, over its area. Both are zero for any other
    /// light.
    dmat3 axes{0};
    dvec3 cosines{0};
    /// Of a lamp: orthogonal half axes of a box, longest first, world units. Points spread evenly
    /// in the box of an open lamp have the second moments of its area about `position`; those of a
    /// closed lamp, less a quarter of its smallest. Zero for a light without a surface.
    dmat3 half_axes{0};
    vec3 emission{0}; ///< radiance of a lamp; intensity or illuminance of a light without a surface
    dvec3 axis{0}; ///< unit direction in which a spot or directional light shines; zero: all around
    double range = std::numeric_limits<double>::infinity();
    double cos_inner = 1, cos_outer = -1; ///< cosines of a spot's half angles
    bool directional = false;             ///< infinitely far away; shines along `axis`
    PunctualLight::Kind kind = PunctualLight::Kind::point; ///< of a light without a surface
};

/// Returns the scene's lights: Scene::light_samples lights for each connected component of each
/// mesh that lights, in file order, then the lights without a surface. Vertices connect through a
/// shared index or an identical position. Vertices at one position count once in the mean.
/// Triangles without area, and vertices that only they use, contribute nothing.
std::vector<PointLight> list_lights(const Scene& scene);

/// Returns how much of a light's area shines in the unit direction `along`, away from it, 0 to 1:
///   - A lamp with a mean normal: the cosine to that normal.
///   - An open two-sided lamp: mean |cosine| of its facets, exact for a board, a tube and a ball.
///   - Any other lamp, mainly a closed one: a quarter, the mean over all directions of the share
///     that a convex body shows.
///   - A light without a surface: 1.
double light_share(const PointLight& light, const dvec3& along);

/// Returns for each triangle the index of its light; nothing for a triangle without area. The index
/// counts the lights that `list_lights` makes of this mesh alone, from 0.
std::vector<std::optional<std::size_t>> triangle_lights(const Mesh& mesh,
                                                        const dmat4& world_from_object);

} // namespace catoptric::scene
