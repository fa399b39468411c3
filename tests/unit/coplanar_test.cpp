// Tests that no two objects of a shipped scene overlap in one plane. Chance would decide which of
// the two a picture shows.
#include "import/load.hpp"
#include "scene/built_in.hpp"
#include "scene/scene.hpp"
#include "scene/transform.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

namespace {

using namespace catoptric;
using namespace catoptric::scene;

struct PlanarFacet {
    std::array<dvec3, 3> corners;
    dvec3 normal;
    std::size_t object;
};

/// Returns whether two coplanar triangles overlap by more than `slack`. Uses separating axes: the
/// direction across each edge.
bool do_facets_overlap(const PlanarFacet& a, const PlanarFacet& b, double slack) {
    for (const PlanarFacet* from : {&a, &b})
        for (int i = 0; i < 3; ++i) {
            const dvec3 edge = from->corners[(i + 1) % 3] - from->corners[i];
            const dvec3 across = glm::normalize(glm::cross(from->normal, edge));
            const auto span = [&](const PlanarFacet& of) {
                std::array<double, 3> at{};
                for (int k = 0; k < 3; ++k) at[k] = glm::dot(across, of.corners[k]);
                return std::ranges::minmax(at);
            };
            const auto mine = span(a), other = span(b);
            if (mine.max <= other.min + slack || other.max <= mine.min + slack) return false;
        }
    return true;
}

TEST(ShippedScenes, NoTwoObjectsOverlapInOnePlane) {
    for (const BuiltInScene& built_in : built_in_scenes()) {
        const std::string name = built_in.name;
        const Scene scene = load(name);
        const double size = glm::length(bounds(scene).extent()), slack = 1e-6 * size;
        // Groups facets by plane. The key is the rounded normal and the rounded distance from the
        // origin. Opposite normals share a key.
        std::map<std::array<long, 4>, std::vector<PlanarFacet>> planes;
        for (std::size_t i = 0; i < scene.objects.size(); ++i) {
            const Object& object = scene.objects[i];
            const Mesh& mesh = scene.meshes[object.mesh];
            for (const uvec3& t : mesh.triangles) {
                PlanarFacet facet{.object = i};
                for (int k = 0; k < 3; ++k)
                    facet.corners[k] = transform_point(object.world_from_object,
                                                       mesh.positions[t[k]]);
                facet.normal = normalized_or_zero(glm::cross(facet.corners[1] - facet.corners[0],
                                                             facet.corners[2] - facet.corners[0]));
                if (facet.normal == dvec3(0)) continue;
                if (glm::dot(facet.normal, dvec3(.9, .7, .3)) < 0) facet.normal = -facet.normal;
                const double height = glm::dot(facet.normal, facet.corners[0]) / (4 * slack);
                const dvec3 n = facet.normal * 1e5;
                // Two overlapping steps of distance, so that equal planes at a step's border share
                // a step.
                for (const double half : {-.25, .25})
                    planes[{std::lround(n.x), std::lround(n.y), std::lround(n.z),
                            std::lround(height + half)}]
                        .push_back(facet);
            }
        }
        for (const auto& [plane, facets] : planes)
            for (std::size_t i = 0; i < facets.size(); ++i)
                for (std::size_t j = 0; j < i; ++j) {
                    if (facets[i].object == facets[j].object) continue;
                    EXPECT_FALSE(do_facets_overlap(facets[i], facets[j], 100 * slack))
                        << name << ": " << scene.objects[facets[i].object].name << " and "
                        << scene.objects[facets[j].object].name;
                }
    }
}

} // namespace
