// Tests of many coincident objects. The traversal steps of a ray must not grow with the number of
// copies.
#include "bvh/closest_hit.hpp"
#include "bvh/copies.hpp"
#include "import/load.hpp"
#include "render/space.hpp"
#include "session/rays.hpp"
#include "session/scene_info.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace catoptric {
namespace {

scene::Scene make_scene_with_coincident_triangles(std::size_t count) {
    scene::Scene scene;
    scene.name = "copies";
    scene.materials.emplace_back();
    scene.meshes.push_back({.name = "triangle",
                            .positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                            .normals = std::vector<vec3>(3, vec3(0, 0, 1)),
                            .triangles = {{0, 1, 2}}});
    for (std::size_t i = 0; i < count; ++i) scene.objects.push_back({.mesh = 0, .material = 0});
    return scene;
}

/// Counts the traversal steps of a grid of rays through the bounds of `count` coincident triangles.
std::size_t count_steps_past_copies(std::size_t count) {
    const scene::Scene scene = make_scene_with_coincident_triangles(count);
    const render::FrameGeometry geometry = render::make_geometry(scene,
                                                                 render::make_scene_units(scene));
    const bvh::Bvh tree = session::build_bvh_without(geometry, geometry.ranges.size());
    bvh::TraversalCounters steps;
    int hits = 0;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) {
            const vec3 low(tree.nodes[0]), high(tree.nodes[1]);
            const vec3 at = low +
                            (high - low) * vec3((float(x) + .5f) / 16, (float(y) + .5f) / 16, 0);
            const auto hit = bvh::find_closest_hit<float>(
                tree, {at + vec3(0, 0, 3), vec3(0, 0, -1), 0}, std::numeric_limits<float>::max(), 0,
                &steps);
            if (!hit) continue;
            ++hits;
            EXPECT_EQ(hit->object, 0u) << "the first of them is seen";
        }
    EXPECT_GT(hits, 100);
    return steps.total();
}

TEST(CopiesInOnePlace, ManyCopiesCostARayNoMoreStepsThanFewCopies) {
    const std::size_t few = count_steps_past_copies(8);
    EXPECT_EQ(count_steps_past_copies(2000), few);
    EXPECT_EQ(count_steps_past_copies(4000), few);
}

/// One masked copy is kept for each object. Where the mask of one object cuts out its surface, a
/// ray sees the copy of another object.
TEST(CopiesInOnePlace, CopiesOfMaskedSurfacesAreKept) {
    std::vector<bvh::Triangle> triangles;
    for (std::uint32_t i = 0; i < 40; ++i)
        triangles.push_back(
            {vec3(0), vec3(1, 0, 0), vec3(0, 1, 0), i / 2, i < 20 ? bvh::kAlphaMaskedFlag : 0});
    const bvh::Bvh tree = bvh::build(triangles, {}, bvh::CopyScope::across_objects);
    // Ten masked objects keep one copy each, and the other ten objects keep one copy together.
    EXPECT_EQ(bvh::count_triangles(tree), 11u);
    EXPECT_EQ(bvh::count_triangles(bvh::build(triangles)), 20u);
}

} // namespace
} // namespace catoptric
