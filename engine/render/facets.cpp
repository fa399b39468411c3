#include "render/facets.hpp"

#include "core/shader_math.hpp"
#include "scene/transform.hpp"

#include <algorithm>
#include <cmath>

namespace catoptric::render {

bool normals_differ_from_facets(const scene::Mesh& mesh) {
    const double least = std::sqrt(1 - f64::kFacetFadeSine * f64::kFacetFadeSine);
    return std::ranges::any_of(mesh.triangles, [&](const uvec3& t) {
        const dvec3& a = mesh.positions[t.x];
        const dvec3 facet = scene::normalized_or_zero(
            glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a));
        const auto leaves = [&](std::uint32_t corner) {
            return std::abs(glm::dot(facet, dvec3(mesh.normals[corner]))) < least;
        };
        return facet != dvec3(0) && (leaves(t.x) || leaves(t.y) || leaves(t.z));
    });
}

} // namespace catoptric::render
