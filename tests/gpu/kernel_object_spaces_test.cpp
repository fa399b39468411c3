// Tests of meshes in their own object spaces. The device must traverse their trees as the C++
// version does, bit for bit. Scaling by a power of two must not change a hit.
#include "support/crowd.hpp"
#include "support/kernel.hpp"

#include <iostream>

namespace {

using namespace catoptric;
using test::DeviceHit;
using test::DeviceRay;
using test::DeviceRayTracer;
using test::InstanceSceneRay;
using test::RandomInstanceScene;

/// The rays of a crowd in the layout that the kernel reads.
struct RayBatch {
    explicit RayBatch(const std::vector<InstanceSceneRay>& from) {
        for (const InstanceSceneRay& ray : from) {
            rays.push_back({ray.ray.origin, ray.t_max, ray.ray.direction, ray.ray.leaves});
            lows.emplace_back(ray.low, 0.0f);
        }
    }
    std::vector<DeviceRay> rays;
    std::vector<vec4> lows;
};

std::size_t count_found_hits(const std::vector<DeviceHit>& hits) {
    return static_cast<std::size_t>(std::ranges::count_if(hits, &DeviceHit::is_hit));
}

TEST(KernelOwnSpaces, HitsEqualTheCppTraversal) {
    RandomInstanceScene crowd(41);
    const RayBatch batch(crowd.make_random_rays(40000));
    DeviceRayTracer kernel(crowd.build_scene_bvh());
    for (const std::uint32_t skipped :
         {0u, bvh::kHiddenFromCameraFlag, bvh::kHiddenFromCameraFlag | bvh::kOneSidedFlag}) {
        const std::vector<DeviceHit> hits = kernel.find_closest_hits(batch.rays, skipped,
                                                                     batch.lows),
                                     shadows = kernel.find_any_hits(batch.rays, skipped,
                                                                    batch.lows);
        EXPECT_EQ(test::count_wrong_hits(kernel, batch.rays, hits, skipped, 1, batch.lows), 0u);
        std::size_t inside = 0, other_shadows = 0;
        for (std::size_t i = 0; i < hits.size(); ++i) {
            inside += hits[i].is_hit() && hits[i].object > 0;
            other_shadows += hits[i].is_hit() != shadows[i].is_hit();
        }
        std::cout << "[ MEASURED ] own spaces: " << count_found_hits(hits) << " hits, " << inside
                  << " of them in one\n";
        EXPECT_EQ(other_shadows, 0u);
        EXPECT_GT(inside, hits.size() / 4);
    }
}

/// Tests that rays need both floats of their origins. Without the low parts, rays start beside
/// small objects, and some hits differ.
TEST(KernelOwnSpaces, OriginsNeedTheSumOfTwoFloats) {
    RandomInstanceScene crowd(41);
    const RayBatch batch(crowd.make_random_rays(40000));
    DeviceRayTracer kernel(crowd.build_scene_bvh());
    const std::vector<DeviceHit> with = kernel.find_closest_hits(batch.rays, 0, batch.lows),
                                 without = kernel.find_closest_hits(batch.rays);
    std::size_t different = 0;
    for (std::size_t i = 0; i < with.size(); ++i)
        different += !test::are_equal_hits(with[i], without[i]);
    EXPECT_GT(different, with.size() / 100);
}

/// Scales either the lengths of the scene or those of the object spaces by a power of two. Every
/// rounding stays the same, so hits keep their bits.
TEST(KernelOwnSpaces, N2b_ScalingByPowersOfTwoChangesNoBit) {
    RandomInstanceScene crowd(42);
    const std::vector<InstanceSceneRay> rays = crowd.make_random_rays(10000);
    const RayBatch batch(rays);
    const std::vector<DeviceHit> one =
        DeviceRayTracer(crowd.build_scene_bvh()).find_closest_hits(batch.rays, 0, batch.lows);
    std::size_t changed = 0, hit = 0;
    for (int k = -20; k <= 20; k += 4)
        for (const bool scene : {true, false}) {
            const float s = std::ldexp(1.0f, k), in_scene = scene ? s : 1, in_own = scene ? 1 : s;
            std::vector<InstanceSceneRay> moved;
            for (std::size_t i = 0; i < rays.size(); ++i)
                // Half of the directions keep their length, so their t scales.
                moved.push_back(test::scale_ray_of_scene(rays[i], in_scene, i % 8 < 4));
            const RayBatch next(moved);
            const std::vector<DeviceHit> hits = DeviceRayTracer(
                                                    crowd.build_scene_bvh(in_scene, in_own))
                                                    .find_closest_hits(next.rays, 0, next.lows);
            hit += count_found_hits(hits);
            for (std::size_t i = 0; i < hits.size(); ++i) {
                DeviceHit expected = one[i];
                if (i % 8 >= 4) expected.t *= in_scene;
                if (!test::are_equal_hits(hits[i], expected) && changed++ == 0)
                    ADD_FAILURE() << (scene ? "scene" : "own spaces") << " x 2^" << k << ", ray "
                                  << i << "\n  at 1: " << test::format_for_message(one[i])
                                  << "\n  scaled: " << test::format_for_message(hits[i]);
            }
        }
    std::cout << "[ MEASURED ] N2b own spaces: " << changed << " of " << 22 * rays.size()
              << " hits changed, " << hit << " hits\n";
    EXPECT_EQ(changed, 0u);
    EXPECT_GT(hit, 22 * rays.size() / 2);
}

/// Tests objects that have an exact sphere. Rays hit the spheres if kStandsForSphereFlag
/// is among the skipped flags, and the meshes otherwise.
TEST(KernelOwnSpaces, ExactSpheresAreHitInTheirObjectSpaces) {
    RandomInstanceScene crowd(43);
    for (bvh::BvhInstance& thing : crowd.list_instances())
        if (thing.object % 2 == 0) thing.radius = .5f, thing.flags = bvh::kStandsForSphereFlag;
    const RayBatch batch(crowd.make_random_rays(20000));
    DeviceRayTracer kernel(crowd.build_scene_bvh());
    EXPECT_EQ(test::count_wrong_hits(kernel, batch.rays,
                                     kernel.find_closest_hits(batch.rays, 0, batch.lows), 0, 1,
                                     batch.lows),
              0u);
    const std::vector<DeviceHit> hits = kernel.find_closest_hits(
        batch.rays, bvh::kStandsForSphereFlag, batch.lows);
    std::size_t different = 0, on_spheres = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const vec3 low(batch.lows[i]);
        const DeviceRay& ray = batch.rays[i];
        DeviceHit wanted = test::find_hit_on_cpu(kernel.traversed_bvh(), ray,
                                                 bvh::kStandsForSphereFlag, low);
        float nearest = wanted.is_hit() ? wanted.t : ray.t_max, t;
        for (const bvh::BvhInstance& thing : crowd.list_instances())
            if (thing.radius > 0 &&
                f32::intersect_sphere_robustly(vec3(0), thing.radius,
                                               f32::transform_ray_to_object_space(
                                                   test::make_placement_of_instance(thing),
                                                   {ray.origin, ray.direction, ray.leaves}, low),
                                               nearest, t))
                nearest = t, wanted = {t, vec3(0), 0, thing.object, 1};
        on_spheres += wanted.is_hit() && wanted.object > 0 && wanted.object % 2 == 0;
        // The device's square root rounds differently from that of C++, so t may differ slightly.
        const float apart = std::abs(wanted.t - hits[i].t);
        different += wanted.is_hit() != hits[i].is_hit() || wanted.object != hits[i].object ||
                     !(apart <= 1e-5f * std::max(wanted.t, 1e-3f));
    }
    EXPECT_LE(different, test::computes_like_cpp() ? 10u : hits.size() / test::kRaysPerOtherHit)
        << "where rays graze";
    EXPECT_GT(on_spheres, hits.size() / 10);
}

} // namespace
