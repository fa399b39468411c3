#include "scene/glass_body.hpp"

#include "scene/material_facts.hpp"
#include "scene/topology.hpp"

#include <algorithm>
#include <cmath>

namespace catoptric::scene {

namespace {

/// A body that fills less than this share of its bounds is hollow or oblique, so rays leave it
/// nearly unbent.
constexpr double kMinSolidShare = .3;
/// A body that fills at most this share of its bounds may be a ball: a ball fills pi / 6 = .524 of
/// them, a cube 1.
constexpr double kMaxBallShare = .65;
constexpr double kMaxBallStretch = 1.25; ///< most by which the longest side of a ball's bounds may
                                         ///< exceed the shortest

} // namespace

double closed_volume(const Mesh& mesh) {
    if (!is_closed_surface(mesh.positions, mesh.triangles)) return 0;
    double volume = 0; // sum of signed tetrahedra
    const dvec3 origin = mesh.positions.empty() ? dvec3(0) : dvec3(mesh.positions.front());
    for (const uvec3& t : mesh.triangles) {
        const dvec3 a = dvec3(mesh.positions[t.x]) - origin,
                    b = dvec3(mesh.positions[t.y]) - origin,
                    c = dvec3(mesh.positions[t.z]) - origin;
        volume += glm::dot(a, glm::cross(b, c)) / 6;
    }
    return std::abs(volume);
}

std::optional<GlassBody> choose_glass_body(const Scene& scene, const Object& object,
                                           double volume) {
    const Material& material = scene.materials[object.material];
    if (!is_glass(material)) return std::nullopt;
    if (!material.solid || volume == 0) return GlassBody::thin;
    const dvec3 size = bounds(scene, object).extent();
    const double longest = std::max({size.x, size.y, size.z}),
                 shortest = std::min({size.x, size.y, size.z}), whole = size.x * size.y * size.z;
    if (!(whole > 0)) return GlassBody::thin;
    const double scale = std::abs(glm::determinant(dmat3(object.world_from_object))),
                 share = volume * scale / whole;
    if (!(share >= kMinSolidShare)) return GlassBody::thin;
    return share <= kMaxBallShare && longest <= kMaxBallStretch * shortest ? GlassBody::sphere
                                                                           : GlassBody::box;
}

} // namespace catoptric::scene
