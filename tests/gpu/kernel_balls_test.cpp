// Tests of balls among the triangles of a BVH. Rays must intersect balls as exact spheres, both on
// the device and in the C++ version of the traversal.
#include "support/kernel.hpp"
#include "support/numbers.hpp"

namespace {

using namespace catoptric;
using test::DeviceHit;
using test::DeviceRay;
using test::DeviceRayTracer;

constexpr std::uint32_t kTriangleAndBallCount =
    150; ///< number of triangles, and also the number of balls

/// Returns triangles and balls in turn, at random places in a cube of edge 2. Some balls are hidden
/// from the camera, some are far away, and some are large.
std::vector<bvh::Triangle> draw_triangles_and_balls(test::RandomNumbers& numbers) {
    std::vector<bvh::Triangle> things;
    for (std::uint32_t i = 0; i < 2 * kTriangleAndBallCount; ++i) {
        const vec3 place = numbers.random_point_in_cube();
        if (i % 2 == 0) {
            things.push_back({place, place + .3f * numbers.random_point_in_cube(),
                              place + .3f * numbers.random_point_in_cube(), i});
            continue;
        }
        const float radius = i % 10 == 1 ? 3.0f
                                         : .01f + .1f * std::abs(numbers.random_point_in_cube().x);
        things.push_back(bvh::make_sphere(i % 14 == 1 ? 50.0f * place : place, radius, i,
                                          i % 6 == 1 ? bvh::kHiddenFromCameraFlag : 0));
    }
    return things;
}

/// Returns rays with random origins and directions. Every fourth ray grazes a ball.
std::vector<DeviceRay> make_rays_among_balls(std::span<const bvh::Triangle> things,
                                             test::RandomNumbers& numbers) {
    std::vector<DeviceRay> rays(6000);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        DeviceRay& ray = rays[i];
        ray.origin = 2.0f * numbers.random_point_in_cube();
        ray.direction = numbers.random_point_in_cube();
        if (i % 4 != 0) continue;
        const bvh::Triangle& ball =
            things[2 * numbers.random_integer_below(kTriangleAndBallCount) + 1];
        if (i % 8 == 0) { // a ray along an axis, close to where the ball touches its bounding box
            const int along = static_cast<int>(i / 8 % 3), across = (along + 1) % 3;
            ray.origin = ball.a, ray.direction = vec3(0);
            ray.origin[across] += .9999f * ball.b.x;
            ray.origin[along] -= 3 + ball.b.x, ray.direction[along] = 1;
            continue;
        }
        const vec3 to = ball.a - ray.origin, beside = glm::cross(to, ray.direction);
        ray.direction = to + ball.b.x / glm::length(beside) * beside;
    }
    return rays;
}

/// Returns the first hit of a ray, found by testing all triangles and balls without a BVH.
DeviceHit find_nearest_hit_by_search(std::span<const bvh::Triangle> things, const DeviceRay& from,
                                     std::uint32_t skipped) {
    const f32::Ray ray{from.origin, from.direction, 0};
    const f32::TriangleTestRayShear shear = f32::make_ray_shear(from.direction);
    DeviceHit best;
    best.t = from.t_max;
    for (std::uint32_t i = 0; i < things.size(); ++i) {
        const bvh::Triangle& thing = things[i];
        float t;
        vec3 weights(1, 0, 0);
        const bool meets = (thing.flags & bvh::kSpherePrimitiveFlag) != 0
                               ? f32::intersect_sphere_robustly(thing.a, thing.b.x, ray,
                                                                f32::kLargestFloat, t)
                               : f32::intersect_triangle_watertight(thing.a, thing.b, thing.c,
                                                                    ray.origin, shear, t, weights);
        if (!meets || (thing.flags & skipped) != 0 || t >= best.t) continue;
        best = {t, f32::normalise_barycentric(weights), i, thing.object, 1, 0};
    }
    return best.is_hit() ? best : DeviceHit();
}

void expect_nearest_hits(DeviceRayTracer& kernel, std::span<const bvh::Triangle> things,
                         const std::vector<DeviceRay>& rays) {
    for (const std::uint32_t skipped : {0u, bvh::kHiddenFromCameraFlag}) {
        const std::vector<DeviceHit> hits = kernel.find_closest_hits(rays, skipped),
                                     shadows = kernel.find_any_hits(rays, skipped);
        EXPECT_EQ(test::count_wrong_hits(kernel, rays, hits, skipped), 0u);
        const std::size_t largest = test::computes_like_cpp()
                                        ? 0
                                        : rays.size() / test::kRaysPerOtherHit;
        std::size_t others = 0, on_balls = 0, other_shadows = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const DeviceHit wanted = find_nearest_hit_by_search(things, rays[i], skipped);
            on_balls += wanted.is_hit() && wanted.object % 2 == 1;
            other_shadows += shadows[i].is_hit() != wanted.is_hit();
            if (!test::is_hit_of_cpu(rays[i], hits[i], wanted) && others++ == largest)
                ADD_FAILURE() << "ray " << i << ", " << test::format_for_message(rays[i])
                              << "\n  with a tree: " << test::format_for_message(hits[i])
                              << "\n  without: " << test::format_for_message(wanted);
        }
        EXPECT_LE(others, largest);
        EXPECT_LE(other_shadows, largest);
        EXPECT_GT(on_balls, rays.size() / 4);
    }
}

TEST(KernelBalls, RaysHitBallsAsExactSpheres) {
    test::RandomNumbers numbers(51);
    const std::vector<bvh::Triangle> things = draw_triangles_and_balls(numbers);
    DeviceRayTracer kernel(things);
    expect_nearest_hits(kernel, things, make_rays_among_balls(things, numbers));
}

/// Tests a refitted tree after its balls have moved and grown.
TEST(KernelBalls, RaysHitMovedBallsInARefittedTree) {
    test::RandomNumbers numbers(52);
    std::vector<bvh::Triangle> things = draw_triangles_and_balls(numbers);
    bvh::Bvh tree = bvh::build(things);
    for (bvh::Triangle& thing : things) {
        const vec3 by = .2f * numbers.random_point_in_cube();
        thing.a += by;
        if ((thing.flags & bvh::kSpherePrimitiveFlag) != 0)
            thing.b.x *= 1.5f;
        else
            thing.b += by, thing.c += by;
    }
    bvh::refit(tree, things);
    DeviceRayTracer kernel(std::move(tree));
    expect_nearest_hits(kernel, things, make_rays_among_balls(things, numbers));
}

} // namespace
