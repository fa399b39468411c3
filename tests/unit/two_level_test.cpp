// Tests of two-level trees: properties of a flat tree must also hold for instances in object space.
#include "bvh/closest_hit.hpp"
#include "bvh/tlas.hpp"
#include "scene/build.hpp"
#include "support/crowd.hpp"
#include "support/numbers.hpp"
#include "support/special_values.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace catoptric::bvh {
namespace {

std::vector<Triangle> make_two_level_ball_triangles(int levels) {
    return *test::make_placed_triangles(scene::ball("ball", levels), .5, dvec3(0));
}

/// A tree with one instance at a random place. The instance has a size of 1e-8 to 1 and is rotated,
/// squeezed and mirrored.
struct TwoLevelBvhTest {
    explicit TwoLevelBvhTest(const Bvh& tree, test::RandomNumbers& numbers)
        : instance{.tree = &tree,
                   .scene_from_own = test::random_scaled_rotation(
                       numbers, std::pow(10., numbers.random_number_between(-8, 0)),
                       numbers.random_number_between(.1f, 1)),
                   .centre = dvec3(numbers.random_point_in_cube()) +
                             1e-9 * dvec3(numbers.random_point_in_cube()),
                   .shift = 100},
          whole(assemble_two_level(build({}, {vec3(-1), vec3(1)}), std::span(&instance, 1))),
          place(detail::read_placement<float>(whole, index_of_instance_record())) {}
    std::uint32_t index_of_instance_record() const {
        return static_cast<std::uint32_t>(count_nodes(whole)) - 1 - f32::kBvhNodesPerInstance;
    }
    BvhInstance instance;
    Bvh whole;
    f32::ObjectPlacement place;
};

/// Row N15 of the stress test: a ray from strictly inside a closed mesh must hit the mesh. A ray
/// that hits nothing is a leak.
TEST(TwoLevel, ClosedMeshesInObjectSpaceDoNotLeak) {
    const std::vector<Triangle> triangles = make_two_level_ball_triangles(3);
    const Bvh tree = build(triangles);
    test::RandomNumbers numbers(31);
    for (int k = 0; k < 200; ++k) {
        const TwoLevelBvhTest alone(tree, numbers);
        for (int i = 0; i < 300; ++i) {
            const Triangle& aim = triangles[numbers.random_integer_below(triangles.size())];
            const vec3 at = i % 3 ? aim.a + (aim.b - aim.a) * numbers.random_unit_fraction()
                                  : aim.a;
            const vec3 from = .3f * numbers.random_point_in_cube();
            vec3 low;
            const vec3 origin = f32::add_offset_to_object_centre(
                alone.place, f32::rotate_to_scene_offset(alone.place, from), low);
            const f32::Ray ray{origin, f32::rotate_to_scene_offset(alone.place, at - from), 0};
            ASSERT_TRUE(
                find_closest_hit<float>(alone.whole, ray, test::kFloatInfinity, 0, nullptr, low))
                << "thing " << k << ", ray " << i;
        }
    }
}

/// Row N17 of the stress test: a ray that leaves a ball must not meet the surface that it leaves.
/// Each hit must also be a hit of the exact ray, which is traced in double precision.
TEST(TwoLevel, RayDoesNotMeetTheSurfaceThatItLeaves) {
    std::size_t met = 0;
    const std::vector<Triangle> triangles = make_two_level_ball_triangles(3);
    const Bvh tree = build(triangles);
    test::RandomNumbers numbers(32);
    for (int k = 0; k < 200; ++k) {
        const TwoLevelBvhTest alone(tree, numbers);
        for (int i = 0; i < 300; ++i) {
            const auto number = static_cast<std::uint32_t>(
                numbers.random_integer_below(triangles.size()));
            const Triangle& t = triangles[number];
            vec3 error;
            const vec3 own = f32::triangle_hit_point(t.a, t.b, t.c,
                                                     numbers.random_barycentric_weights(), error);
            const vec3 arm = f32::rotate_to_scene_offset(alone.place, own);
            vec3 facet = f32::facet_normal(f32::rotate_to_scene_offset(alone.place, t.a),
                                           f32::rotate_to_scene_offset(alone.place, t.b),
                                           f32::rotate_to_scene_offset(alone.place, t.c));
            if (dot(facet, arm) < 0) facet = -facet;
            vec3 direction = numbers.random_unit_direction();
            if (dot(direction, facet) < 0) direction = -direction;
            vec3 low;
            const vec3 origin = f32::add_offset_to_object_centre(
                alone.place,
                f32::ray_spawn_origin(arm, f32::offset_rounding_error(alone.place, own, error),
                                      facet, direction),
                low);
            const f32::Ray ray{origin, direction, 100 + number + 1};
            const auto hit = find_closest_hit<float>(alone.whole, ray, test::kFloatInfinity, 0,
                                                     nullptr, low);
            if (!hit) continue;
            // The ball is a subdivided tetrahedron and not convex everywhere, so the ray may meet
            // it again. The ray in double precision must then meet it, too.
            const f64::Ray exact{
                dvec3(own), dvec3(f32::transform_offset_to_object_space(alone.place, direction)),
                number + 1};
            const auto wanted = find_closest_hit<double>(tree, exact, 1e300);
            ASSERT_TRUE(wanted) << "thing " << k << ", ray " << i << " of " << number << " meets "
                                << hit->triangle - 100 << " at " << hit->t;
            ++met;
        }
    }
    EXPECT_LT(met, 6000u) << "a tenth";
}

/// The instances are so large that floats in scene units are precise enough. Rays must meet the
/// same triangles in a two-level tree and in one flat tree.
TEST(TwoLevel, RaysMeetTheSameTrianglesAsInAFlatTree) {
    test::RandomNumbers numbers(33);
    const std::vector<Triangle> shape = make_two_level_ball_triangles(2);
    const Bvh tree = build(shape);
    std::vector<Triangle> room, all;
    for (int i = 0; i < 40; ++i) {
        const vec3 a = 2.0f * numbers.random_point_in_cube();
        room.push_back(
            {a, a + numbers.random_point_in_cube(), a + numbers.random_point_in_cube(), 0, 0});
    }
    all = room;
    std::vector<BvhInstance> instances;
    for (std::uint32_t k = 0; k < 30; ++k) {
        const auto first = static_cast<std::uint32_t>(all.size());
        instances.push_back({&tree, test::random_scaled_rotation(numbers, .5, .6),
                             2.0 * dvec3(numbers.random_point_in_cube()), k + 1,
                             k % 5 == 0 ? kHiddenFromCameraFlag : 0, first});
        for (const Triangle& t : shape) {
            const auto put = [&](const vec3& p) {
                return vec3(instances[k].centre + instances[k].scene_from_own * dvec3(p));
            };
            all.push_back({put(t.a), put(t.b), put(t.c), k + 1, instances[k].flags});
        }
    }
    const Bvh flat = build(room), one = build(all), two = assemble_two_level(flat, instances);
    std::vector<BvhInstance> backwards(instances.rbegin(), instances.rend());
    const Bvh other = assemble_two_level(flat, backwards);
    std::size_t found = 0, apart = 0;
    for (int i = 0; i < 20000; ++i) {
        const f32::Ray ray{3.0f * numbers.random_point_in_cube(), numbers.random_unit_direction(),
                           0};
        const std::uint32_t skipped = i % 2 ? kHiddenFromCameraFlag : 0;
        const auto wanted = find_closest_hit<float>(one, ray, test::kFloatInfinity, skipped),
                   hit = find_closest_hit<float>(two, ray, test::kFloatInfinity, skipped),
                   again = find_closest_hit<float>(other, ray, test::kFloatInfinity, skipped);
        ASSERT_EQ(hit.has_value(), again.has_value());
        ASSERT_EQ(hit.has_value(), has_any_hit<float>(two, ray, test::kFloatInfinity, skipped));
        if (hit) {
            ASSERT_EQ(hit->t, again->t);
            ASSERT_EQ(hit->triangle, again->triangle);
            ASSERT_EQ(hit->object, again->object);
        }
        found += wanted.has_value();
        const bool same = wanted.has_value() == hit.has_value() &&
                          (!hit ||
                           (wanted->triangle == hit->triangle && wanted->object == hit->object &&
                            std::abs(wanted->t - hit->t) < 1e-4f));
        apart += !same;
    }
    EXPECT_GT(found, 2000u);
    EXPECT_LE(apart, 10u) << "at edges, where either is right";
}

/// Row N2b of the stress test: scaling the scene or the object spaces by a power of two changes no
/// bit of a hit except in t.
TEST(TwoLevel, ScalingByPowersOfTwoChangesNoHit) {
    test::RandomInstanceScene crowd(35);
    const std::vector<test::InstanceSceneRay> rays = crowd.make_random_rays(1000);
    const Bvh whole = crowd.build_scene_bvh();
    std::size_t found = 0;
    const auto walk = [](const Bvh& bvh, const test::InstanceSceneRay& r) {
        return find_closest_hit<float>(bvh, r.ray, r.t_max, 0, nullptr, r.low);
    };
    for (int k = -20; k <= 20; ++k)
        for (const bool scene : {true, false}) {
            const float s = std::ldexp(1.0f, k), in_scene = scene ? s : 1, in_own = scene ? 1 : s;
            const Bvh scaled = crowd.build_scene_bvh(in_scene, in_own);
            ASSERT_EQ(count_nodes(scaled), count_nodes(whole));
            for (std::size_t i = 0; i < rays.size(); ++i) {
                const bool direction = i % 8 < 4;
                auto wanted = walk(whole, rays[i]);
                if (wanted && !direction) wanted->t *= in_scene;
                ASSERT_EQ(walk(scaled, test::scale_ray_of_scene(rays[i], in_scene, direction)),
                          wanted)
                    << (scene ? "scene" : "own spaces") << " x 2^" << k << ", ray " << i;
                found += wanted.has_value();
            }
        }
    EXPECT_GT(found, 41 * rays.size());
}

TEST(TwoLevel, TreeWithoutInstancesStaysFlat) {
    const Bvh flat = build(make_two_level_ball_triangles(1)), same = assemble_two_level(flat, {});
    EXPECT_EQ(same.nodes.size(), flat.nodes.size());
    EXPECT_EQ(same.triangles, flat.triangles);
}

TEST(TwoLevel, LowPartIsTheRoundingErrorOfAFloat) {
    test::RandomNumbers numbers(34);
    for (int i = 0; i < 1000; ++i) {
        const dvec3 v = dvec3(numbers.random_point_in_cube()) +
                        1e-8 * dvec3(numbers.random_point_in_cube());
        const vec3 low = float_rounding_error(v);
        for (int k = 0; k < 3; ++k) {
            const volatile float high = static_cast<float>(v[k]);
            EXPECT_NEAR(double{high} + double{low[k]}, v[k], 1e-15);
        }
    }
}

TEST(TwoLevel, StretchOfKnownMatricesIsInBounds) {
    EXPECT_EQ(rounding_amplification(dmat3(.25)), 1);
    EXPECT_LE(rounding_amplification(dmat3(.6, .8, 0, -.8, .6, 0, 0, 0, 1)), 2);
    EXPECT_GT(rounding_amplification(dmat3(1, 0, 0, 1, 1e-3, 0, 0, 0, 1)), 1000);
    EXPECT_EQ(rounding_amplification(dmat3(0)), std::numeric_limits<double>::infinity());
}

} // namespace
} // namespace catoptric::bvh
