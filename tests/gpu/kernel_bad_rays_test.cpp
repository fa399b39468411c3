// Tests of invalid rays, such as rays with NaN. They must miss, and must cost no more traversal
// steps than valid rays.
#include "support/kernel.hpp"
#include "support/kernel_shapes.hpp"

#include <algorithm>
#include <iostream>

namespace {

using namespace catoptric;
using test::DeviceHit;
using test::DeviceRay;
using test::DeviceRayTracer;

std::vector<bvh::Triangle> make_ball_triangles() {
    return *test::make_placed_triangles(scene::ball("ball", 5), 1, dvec3(0));
}

float& ray_component(DeviceRay& ray, std::size_t i) {
    return i < 3   ? ray.origin[static_cast<int>(i)]
           : i < 6 ? ray.direction[static_cast<int>(i) - 3]
                   : ray.t_max;
}

struct TraversalStepCounts {
    double mean = 0;
    std::uint32_t most = 0;
};

TraversalStepCounts count_traversal_steps(const std::vector<DeviceHit>& hits) {
    TraversalStepCounts result;
    for (const DeviceHit& hit : hits) {
        result.mean += hit.steps / static_cast<double>(hits.size());
        result.most = std::max(result.most, hit.steps);
    }
    return result;
}

/// Returns rays with random origins and directions. A `reach` of 0.5 puts all origins inside the
/// ball.
std::vector<DeviceRay> make_ordinary_rays(std::size_t count, float reach) {
    test::RandomNumbers numbers(16);
    std::vector<DeviceRay> rays(count);
    for (DeviceRay& ray : rays) {
        ray.origin = reach * numbers.random_point_in_cube();
        ray.direction = numbers.random_unit_direction();
    }
    return rays;
}

TEST(KernelBadRays, N16_NanAndInfinityMissInBoundedTime) {
    DeviceRayTracer kernel(make_ball_triangles());
    const std::vector<DeviceRay> normal = make_ordinary_rays(10000, 0.5f);
    const TraversalStepCounts usual = count_traversal_steps(kernel.find_closest_hits(normal));
    std::vector<DeviceRay> bad;
    // The bit patterns are quiet and signalling NaNs of both signs, and the two infinities. The
    // loop skips an infinite t_max, because a ray with infinite t_max is valid.
    for (const std::uint32_t word : {0x7fc00000u, 0xffc00000u, 0x7f800001u, 0xff800001u,
                                     0x7fffffffu, 0x7f800000u, 0xff800000u})
        for (std::size_t i = 0; i < 7; ++i)
            for (std::size_t k = 0; k < 200 && !(i == 6 && word == 0x7f800000u); ++k) {
                bad.push_back(normal[k]);
                ray_component(bad.back(), i) = std::bit_cast<float>(word);
            }
    for (std::size_t k = 0; k < 200; ++k) {
        bad.push_back(normal[k]);
        bad.back().direction = vec3(k % 2 == 0 ? 0.0f : -0.0f);
        bad.push_back(normal[k]);
        bad.back().t_max = k % 2 == 0 ? 0.0f : -0.0f;
        bad.push_back(normal[k]);
        bad.back().t_max = -1;
    }
    for (const bool shadow : {false, true}) {
        const std::vector<DeviceHit> hits = shadow ? kernel.find_any_hits(bad)
                                                   : kernel.find_closest_hits(bad);
        std::size_t found = 0;
        for (std::size_t i = 0; i < bad.size(); ++i)
            if ((hits[i].is_hit() || hits[i].has_reached_step_limit()) && found++ == 0)
                ADD_FAILURE() << "ray " << i << ", " << test::format_for_message(bad[i]) << ": "
                              << test::format_for_message(hits[i]);
        const TraversalStepCounts steps = count_traversal_steps(hits);
        std::cout << "[ MEASURED ] N16 " << (shadow ? "shadow rays: " : "nearest: ") << found
                  << " of " << bad.size() << " bad rays do not miss, at most " << steps.most
                  << " steps; normal rays take " << usual.mean << ", at most " << usual.most
                  << "\n";
        EXPECT_EQ(found, 0u);
        EXPECT_LE(steps.most, 2.5 * usual.mean);
    }
}

/// Tests that the sign of a zero coordinate of a ray changes neither its hit nor, beyond the bound,
/// its number of steps.
TEST(KernelBadRays, N16_NegativeZeroActsAsZero) {
    DeviceRayTracer kernel(make_ball_triangles());
    std::vector<DeviceRay> positive = make_ordinary_rays(60000, 1.2f);
    for (std::size_t i = 0; i < positive.size(); ++i) {
        ray_component(positive[i], i % 6) = 0.0f;
        if (i % 4 == 0)
            // Some rays lie along an axis or in a coordinate plane, or start at the centre.
            ray_component(positive[i], (i + 1) % 6) = 0.0f;
        if (i % 8 == 0) ray_component(positive[i], (i + 2) % 6) = 0.0f;
    }
    std::vector<DeviceRay> negative = positive;
    for (DeviceRay& ray : negative)
        for (std::size_t i = 0; i < 6; ++i)
            if (ray_component(ray, i) == 0) ray_component(ray, i) = -0.0f;
    const std::vector<DeviceHit> expected = kernel.find_closest_hits(positive),
                                 hits = kernel.find_closest_hits(negative);
    std::size_t other = 0, found = 0;
    std::uint64_t steps = 0, usual = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        found += hits[i].is_hit() ? 1 : 0;
        steps += hits[i].steps, usual += expected[i].steps;
        // Hits may differ in the sign of a weight that is exactly 0, because == ignores that sign.
        const bool alike = hits[i].outcome == expected[i].outcome && hits[i].t == expected[i].t &&
                           hits[i].barycentric == expected[i].barycentric &&
                           hits[i].triangle == expected[i].triangle;
        if (!alike && other++ == 0)
            ADD_FAILURE() << "ray " << i << ", " << test::format_for_message(negative[i])
                          << "\n  -0: " << test::format_for_message(hits[i])
                          << "\n  +0: " << test::format_for_message(expected[i]);
    }
    std::cout << "[ MEASURED ] N16 -0: " << other << " of " << hits.size()
              << " hits differ from +0 (" << found << " hits), " << steps << " against " << usual
              << " steps\n";
    EXPECT_EQ(other, 0u);
    EXPECT_GT(found, hits.size() / 2);
    EXPECT_LE(static_cast<double>(steps), 2.5 * static_cast<double>(usual));
}

} // namespace
