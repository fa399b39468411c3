// Tests that the device and the C++ version of the BVH traversal find the same hits, bit for bit.
#include "import/load.hpp"
#include "scene/built_in.hpp"
#include "session/rays.hpp"
#include "support/kernel.hpp"
#include "support/kernel_shapes.hpp"

#include <iostream>

namespace {

using namespace catoptric;
using test::DeviceHit;
using test::DeviceRay;
using test::DeviceRayTracer;

std::vector<DeviceRay> make_random_rays_in_box(std::size_t count, vec3 lo, vec3 hi, unsigned seed) {
    test::RandomNumbers numbers(seed);
    std::vector<DeviceRay> rays(count);
    for (DeviceRay& ray : rays) {
        ray.origin = lo + (hi - lo) * vec3(numbers.random_unit_fraction(),
                                           numbers.random_unit_fraction(),
                                           numbers.random_unit_fraction());
        ray.direction = numbers.random_unit_direction();
        if (numbers.random_word() % 4 == 0) ray.t_max = numbers.random_number_between(0, 1);
    }
    return rays;
}

TEST(KernelMirror, HitsInTheBuiltInSceneEqualTheCppTraversal) {
    const scene::Scene room = scene::make_cornell();
    const render::FrameGeometry geometry = render::make_geometry(room,
                                                                 render::make_scene_units(room));
    DeviceRayTracer kernel(session::build_bvh_without(geometry, geometry.ranges.size()));
    const std::vector<DeviceRay> rays = make_random_rays_in_box(
        100000, vec3(kernel.traversed_bvh().nodes[0]), vec3(kernel.traversed_bvh().nodes[1]), 1);
    for (const std::uint32_t skipped :
         {0u, bvh::kHiddenFromCameraFlag, bvh::kHiddenFromCameraFlag | bvh::kOneSidedFlag}) {
        const std::vector<DeviceHit> hits = kernel.find_closest_hits(rays, skipped),
                                     shadows = kernel.find_any_hits(rays, skipped);
        const std::size_t different = test::count_wrong_hits(kernel, rays, hits, skipped);
        std::size_t found = 0, other_shadows = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            found += hits[i].is_hit() ? 1 : 0;
            other_shadows += hits[i].is_hit() == shadows[i].is_hit() ? 0 : 1;
        }
        std::cout << "[ MEASURED ] mirror: " << different << " of " << rays.size()
                  << " rays differ, " << found << " hits\n";
        EXPECT_EQ(different, 0u);
        EXPECT_EQ(other_shadows, 0u)
            << "a shadow ray finds something where the same ray has a nearest hit";
        EXPECT_GT(found, rays.size() / 2);
    }
}

/// The tree stores triangles that cast no shadow in a separate subtree.
TEST(KernelMirror, HitsWithATreeOfShadowlessTrianglesEqualTheCppTraversal) {
    test::RandomNumbers numbers(6);
    std::vector<bvh::Triangle> triangles(2000);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const vec3 centre = numbers.random_point_in_cube();
        triangles[i] = {centre + 0.1f * numbers.random_point_in_cube(),
                        centre + 0.1f * numbers.random_point_in_cube(),
                        centre + 0.1f * numbers.random_point_in_cube()};
        if (i % 20 == 0) triangles[i].flags = bvh::kCastsNoShadowFlag;
    }
    DeviceRayTracer kernel(triangles);
    const std::vector<DeviceRay> rays = make_random_rays_in_box(20000, vec3(-1), vec3(1), 7);
    std::size_t found[2] = {};
    for (const std::uint32_t skipped : {0u, bvh::kCastsNoShadowFlag}) {
        const std::vector<DeviceHit> hits = kernel.find_closest_hits(rays, skipped),
                                     shadows = kernel.find_any_hits(rays, skipped);
        EXPECT_EQ(test::count_wrong_hits(kernel, rays, hits, skipped), 0u);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            ASSERT_EQ(hits[i].is_hit(), shadows[i].is_hit()) << i;
            found[skipped == 0 ? 0 : 1] += hits[i].is_hit() ? 1 : 0;
        }
    }
    EXPECT_GT(found[0], found[1]) << "some rays meet only triangles without shadows";
}

/// Scales triangles and rays by a power of two. Every rounding stays the same, so a hit keeps all
/// its bits, except that t may scale too.
TEST(KernelMirror, N2b_ScalingByPowersOfTwoChangesNoBit) {
    test::RandomNumbers numbers(2);
    std::vector<bvh::Triangle> triangles(2000);
    for (bvh::Triangle& t : triangles) {
        const vec3 centre = numbers.random_point_in_cube();
        t = {centre + 0.1f * numbers.random_point_in_cube(),
             centre + 0.1f * numbers.random_point_in_cube(),
             centre + 0.1f * numbers.random_point_in_cube()};
    }
    std::vector<DeviceRay> rays(20000);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const bvh::Triangle& aim = triangles[numbers.random_integer_below(triangles.size())];
        rays[i].origin = 2.0f * numbers.random_point_in_cube();
        rays[i].direction = i % 2 == 0 ? aim.a + numbers.random_unit_fraction() * (aim.b - aim.a) -
                                             rays[i].origin
                                       : numbers.random_unit_direction();
    }
    const std::vector<DeviceHit> one = DeviceRayTracer(triangles).find_closest_hits(rays);
    std::size_t changed = 0, found = 0;
    for (int k = -20; k <= 20; ++k) {
        const float s = std::ldexp(1.0f, k);
        std::vector<bvh::Triangle> scaled = triangles;
        for (bvh::Triangle& t : scaled) t.a *= s, t.b *= s, t.c *= s;
        std::vector<DeviceRay> moved = rays;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            moved[i].origin *= s;
            // Half of the directions keep their length, so their t scales.
            if (i % 4 < 2) moved[i].direction *= s;
        }
        const std::vector<DeviceHit> hits = DeviceRayTracer(scaled).find_closest_hits(moved);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            DeviceHit expected = one[i];
            if (i % 4 >= 2) expected.t *= s;
            found += hits[i].is_hit() ? 1 : 0;
            if (!test::are_equal_hits(hits[i], expected) && changed++ == 0)
                ADD_FAILURE() << "x 2^" << k << ", ray " << i << ", "
                              << test::format_for_message(rays[i])
                              << "\n  at 1: " << test::format_for_message(one[i])
                              << "\n  scaled: " << test::format_for_message(hits[i]);
        }
    }
    std::cout << "[ MEASURED ] N2b " << changed << " of " << 41 * rays.size() << " hits changed, "
              << found << " hits\n";
    EXPECT_EQ(changed, 0u);
    EXPECT_GT(found, 41 * rays.size() / 4);
}

} // namespace
