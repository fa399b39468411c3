// Tests of the list from which shaders draw points on lamps. The test decodes the texels as
// shaders/lib/lamps.glsl does.
#include "render/lamp_table.hpp"

#include "bvh/words.hpp"
#include "scene/build.hpp"

#include <gtest/gtest.h>

#include <map>

namespace {

using namespace catoptric;

struct LampScene {
    render::FrameGeometry geometry;
    std::vector<shared::Surface> surfaces;
};

/// Appends a triangle with a right angle at `corner` and legs of this length, as an object.
void add_right_triangle(LampScene& scene, vec3 corner, float leg, vec3 emission) {
    const auto first = static_cast<std::uint32_t>(scene.geometry.vertices.size());
    for (const vec3& p : {corner, corner + vec3(leg, 0, 0), corner + vec3(0, leg, 0)})
        scene.geometry.vertices.push_back({.position = p, .normal = {0, 0, 1}});
    render::DrawRange range;
    range.first_index = static_cast<std::uint32_t>(scene.geometry.indices.size());
    range.index_count = 3;
    for (std::uint32_t i = 0; i < 3; ++i) scene.geometry.indices.push_back(first + i);
    scene.geometry.ranges.push_back(range);
    shared::Surface surface{};
    surface.emission = emission;
    scene.surfaces.push_back(surface);
}

std::uint32_t count_table_triangles(const std::vector<vec4>& table) {
    return bvh::unpack_number(table[0].y);
}

/// Returns the probability with which the alias table draws each object.
std::map<std::uint32_t, double>
sum_alias_table_probabilities_by_object(const std::vector<vec4>& table) {
    const std::uint32_t count = count_table_triangles(table);
    std::map<std::uint32_t, double> result;
    const auto object = [&](std::uint32_t i) { return bvh::unpack_number(table[3 + 3 * i].w); };
    for (std::uint32_t i = 0; i < count; ++i) {
        const double share = table[1 + 3 * i].w;
        result[object(i)] += share / count;
        result[object(bvh::unpack_number(table[2 + 3 * i].w))] += (1 - share) / count;
    }
    return result;
}

TEST(LampTable, TrianglesAreDrawnByPower) {
    LampScene scene;
    add_right_triangle(scene, {0, 0, 0}, 1, {1, 0, 0});
    add_right_triangle(scene, {2, 0, 0}, 1, {0, 0, 0});  // this object emits no light
    add_right_triangle(scene, {4, 0, 0}, 3, {0, 1, 1});  // 18 times the power of the first lamp
    add_right_triangle(scene, {9, 0, 0}, 0, {1, 1, 1});  // this triangle has no area
    add_right_triangle(scene, {12, 0, 0}, 1, {0, 0, 7}); // 7 times the power of the first lamp
    const std::vector<vec4> table = render::make_lamp_table(scene.geometry, scene.surfaces);
    ASSERT_EQ(count_table_triangles(table), 3u);
    ASSERT_EQ(table.size(), 10u);
    const std::map<std::uint32_t, double> found = sum_alias_table_probabilities_by_object(table);
    const double total = .5 + 9 + 3.5;
    ASSERT_EQ(found.size(), 3u);
    EXPECT_NEAR(found.at(0), .5 / total, 1e-6);
    EXPECT_NEAR(found.at(2), 9 / total, 1e-6);
    EXPECT_NEAR(found.at(4), 3.5 / total, 1e-6);
    EXPECT_NEAR(table[0].x, 1 / total, 1e-7);
    EXPECT_EQ(vec3(table[4]), vec3(4, 0, 0));
    EXPECT_EQ(vec3(table[5]), vec3(3, 0, 0));
    EXPECT_EQ(vec3(table[6]), vec3(0, 3, 0));
}

TEST(LampTable, TrianglesInObjectSpaceAreListedInSceneUnits) {
    LampScene scene;
    add_right_triangle(scene, {1, 0, 0}, 1, {1, 1, 1});
    render::ObjectSpace own;
    own.scene_from_own = dmat3(2), own.centre = {10, 20, 30};
    scene.geometry.ranges[0].own = own;
    const std::vector<vec4> table = render::make_lamp_table(scene.geometry, scene.surfaces);
    ASSERT_EQ(table.size(), 4u);
    EXPECT_EQ(vec3(table[1]), vec3(12, 20, 30));
    EXPECT_EQ(vec3(table[2]), vec3(2, 0, 0));
    EXPECT_NEAR(table[0].x, 1 / (3 * .5 * 4), 1e-7);
}

TEST(LampTable, NoLampsOrTooManyTrianglesGiveAnEmptyList) {
    LampScene scene;
    add_right_triangle(scene, {0, 0, 0}, 1, {0, 0, 0});
    EXPECT_TRUE(render::make_lamp_table(scene.geometry, scene.surfaces).empty());
    scene.surfaces[0].emission = vec3(1);
    for (std::size_t i = 1; i <= render::kMaxLampTriangles; ++i) {
        scene.geometry.ranges.push_back(scene.geometry.ranges[0]);
        scene.surfaces.push_back(scene.surfaces[0]);
    }
    EXPECT_TRUE(render::make_lamp_table(scene.geometry, scene.surfaces).empty());
    scene.geometry.ranges.pop_back(), scene.surfaces.pop_back();
    EXPECT_EQ(count_table_triangles(render::make_lamp_table(scene.geometry, scene.surfaces)),
              render::kMaxLampTriangles);
}

} // namespace
