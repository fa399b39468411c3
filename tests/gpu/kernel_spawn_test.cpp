// Tests of points on triangles and of the rays that start there, computed on the device.
#include "support/kernel.hpp"
#include "support/kernel_shapes.hpp"

#include <algorithm>
#include <iostream>

namespace {

using namespace catoptric;
using test::DeviceHit;
using test::DeviceRay;
using test::DeviceRayTracer;
using test::LeavingRayOrigin;
using test::SurfacePointQuery;

struct SelfHitCounts {
    /// Counts of self-intersections: `named` with Ray::leaves, which names the triangle that the
    /// ray leaves, and `unnamed` without.
    std::size_t rays = 0, named = 0, unnamed = 0;
};

/// Traces 1000 rays from random points of the triangle into random directions, and counts their
/// hits on the same triangle.
void count_self_hits_of_leaving_rays(const bvh::Triangle& triangle, test::RandomNumbers& numbers,
                                     SelfHitCounts& count, const gpu::ShaderConstants& rules = {}) {
    constexpr std::size_t kSpawnedRayCount = 1000;
    DeviceRayTracer kernel(std::span(&triangle, 1));
    kernel.rules = rules;
    std::vector<SurfacePointQuery> starts(kSpawnedRayCount);
    for (SurfacePointQuery& start : starts)
        start = {numbers.random_barycentric_weights(), 0, numbers.random_unit_direction()};
    const std::vector<LeavingRayOrigin> leavings = kernel.compute_ray_origins(starts);
    std::vector<DeviceRay> rays;
    for (std::size_t i = 0; i < kSpawnedRayCount; ++i)
        for (const std::uint32_t leaves : {0u, 1u})
            rays.push_back(
                {.origin = leavings[i].origin, .direction = starts[i].direction, .leaves = leaves});
    const std::vector<DeviceHit> hits = kernel.find_closest_hits(rays);
    for (std::size_t i = 0; i < rays.size(); ++i)
        if (hits[i].is_hit()) ++(rays[i].leaves == 0 ? count.unnamed : count.named);
    count.rays += kSpawnedRayCount;
}

void print_self_hits(const char* what, const SelfHitCounts& hits) {
    std::cout << "[ MEASURED ] N17 " << what << ": self hits " << hits.named << " of " << hits.rays
              << " rays that name their triangle, " << hits.unnamed << " ("
              << static_cast<double>(hits.unnamed) /
                     static_cast<double>(std::max<std::size_t>(hits.rays, 1))
              << " of them) of those that do not\n";
}

/// Tests triangles whose coordinates each have a random magnitude. Half of these triangles are
/// slivers, 30 to 1e9 times longer than high. The error bound of the origin must avoid
/// self-intersections even if the ray does not name its triangle.
TEST(KernelSpawn, N17_RaysLeaveTrianglesOfAnyMagnitude) {
    test::RandomNumbers numbers(17);
    SelfHitCounts count;
    for (int i = 0; i < 1000; ++i) {
        bvh::Triangle t;
        for (vec3* corner : {&t.a, &t.b, &t.c})
            for (int k = 0; k < 3; ++k) (*corner)[k] = numbers.random_log_uniform_number(-8, 8);
        count_self_hits_of_leaving_rays(t, numbers, count);
    }
    print_self_hits("coordinates of 1e-8 .. 1e8", count);
    EXPECT_EQ(count.named, 0u);
    EXPECT_EQ(count.unnamed, 0u);
}

/// Tests triangles of any size, at the origin or away from it by up to a thousand times their size.
TEST(KernelSpawn, N17_RaysLeaveTrianglesOfAnySize) {
    test::RandomNumbers numbers(18);
    SelfHitCounts count;
    for (int i = 0; i < 500; ++i) {
        const float size = std::pow(10.0f, numbers.random_number_between(-8, 8));
        const vec3 centre = size * numbers.random_log_uniform_number(-2, 3) *
                            numbers.random_unit_direction();
        bvh::Triangle t;
        for (vec3* corner : {&t.a, &t.b, &t.c})
            *corner = centre + size * numbers.random_point_in_cube();
        count_self_hits_of_leaving_rays(t, numbers, count);
    }
    print_self_hits("triangles of sizes 1e-8 .. 1e8", count);
    EXPECT_EQ(count.named, 0u);
    EXPECT_EQ(count.unnamed, 0u);
}

/// Tests that a fixed offset of ray origins is not enough: far from the scene's origin, rounding
/// removes the offset. `without` selects the rule in shaders/lib/plain.glsl that uses the fixed
/// offset.
TEST(KernelSpawn, N17_FixedOffsetLetsRaysHitTheirOwnTriangle) {
    test::RandomNumbers numbers(18);
    SelfHitCounts count;
    const vec3 centre(3e5f, -2e5f, 1e5f);
    for (int i = 0; i < 20; ++i) {
        bvh::Triangle t;
        for (vec3* corner : {&t.a, &t.b, &t.c})
            *corner = centre + 1e3f * numbers.random_point_in_cube();
        count_self_hits_of_leaving_rays(t, numbers, count,
                                        {{"without", 3u}, {"fixed_offset", 1e-3f}});
    }
    print_self_hits("with an offset of 1e-3", count);
    EXPECT_GT(count.unnamed, 0u);
}

/// Tests two parallel triangles in front of a ray. A ray passes through the triangle that it names
/// as its start, although that triangle lies ahead, and through no other triangle.
TEST(KernelSpawn, N17_RayPassesThroughTheTriangleItNames) {
    const std::vector<bvh::Triangle> triangles{{{-1, -1, 1}, {1, -1, 1}, {0, 1, 1}},
                                               {{-1, -1, 2}, {1, -1, 2}, {0, 1, 2}}};
    DeviceRayTracer kernel(triangles);
    std::vector<DeviceRay> rays;
    for (const std::uint32_t leaves : {0u, 1u, 2u})
        rays.push_back({.direction = {0, 0, 1}, .leaves = leaves});
    const std::vector<DeviceHit> hits = kernel.find_closest_hits(rays);
    EXPECT_EQ(hits[0].t, 1);
    EXPECT_EQ(hits[1].t, 2);
    EXPECT_EQ(hits[2].t, 1);
}

/// Returns the difference between two numbers in units in the last place (ulp) of a float as large
/// as `scale`.
double difference_in_ulps(double found, double exact, double scale) {
    return std::abs(found - exact) / (std::ldexp(1.0, std::ilogb(scale)) * 0x1p-23);
}
double difference_in_ulps(const vec3& found, const dvec3& exact, double scale) {
    return std::max({difference_in_ulps(double{found.x}, exact.x, scale),
                     difference_in_ulps(double{found.y}, exact.y, scale),
                     difference_in_ulps(double{found.z}, exact.z, scale)});
}

/// Compares 256 rays on the device with the same computation in doubles. Errors are in ulp of 1 for
/// weights and normal, of the largest coordinate for the point, and of t for t. No ray is flatter
/// than 30 degrees to the triangle. At such angles a rounding of a corner moves the hit by at most
/// twice as much.
TEST(KernelHit, N18_HitsLieWithin16UlpOfDoublePrecision) {
    test::RandomNumbers numbers(19);
    const bvh::Triangle t{{-0.83f, -0.61f, 0.13f}, {0.94f, -0.47f, -0.22f}, {0.07f, 0.89f, 0.31f}};
    const dvec3 a(t.a), b(t.b), c(t.c), n = glm::normalize(glm::cross(b - a, c - a));
    DeviceRayTracer kernel(std::span(&t, 1));
    std::vector<DeviceRay> rays(256);
    for (DeviceRay& ray : rays) {
        const dvec3 w(numbers.random_barycentric_weights());
        dvec3 from;
        do from = dvec3(numbers.random_unit_direction());
        while (std::abs(glm::dot(from, n)) < 0.5);
        const dvec3 target = w.x * a + w.y * b + w.z * c;
        ray.origin = vec3(target + from * double{numbers.random_number_between(0.5f, 2)});
        ray.direction = vec3(target) - ray.origin;
    }
    const std::vector<test::DeviceHit> hits = kernel.find_closest_hits(rays);
    std::vector<SurfacePointQuery> starts;
    for (const test::DeviceHit& hit : hits)
        starts.push_back({.weights = hit.barycentric, .place = 0, .direction = vec3(0, 0, 1)});
    const std::vector<LeavingRayOrigin> points = kernel.compute_ray_origins(starts);
    struct WorstRayOriginError {
        double t = 0, weights = 0, point = 0, normal = 0;
    } worst;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        double exact_t;
        dvec3 weights, error;
        const bool met = f64::intersect_triangle_watertight(
            a, b, c, dvec3(rays[i].origin), f64::make_ray_shear(dvec3(rays[i].direction)), exact_t,
            weights);
        ASSERT_EQ(hits[i].is_hit(), met) << test::format_for_message(rays[i]);
        if (!met) continue; // a ray aimed at an edge passes beside it because of rounding
        const dvec3 exact = f64::normalise_barycentric(weights);
        worst.t = std::max(worst.t, difference_in_ulps(double{hits[i].t}, exact_t, exact_t));
        worst.weights = std::max(worst.weights, difference_in_ulps(hits[i].barycentric, exact, 1));
        worst.point = std::max(
            worst.point, difference_in_ulps(points[i].point,
                                            f64::triangle_hit_point(a, b, c, exact, error), 0.94));
        worst.normal = std::max(
            worst.normal, difference_in_ulps(points[i].normal, f64::facet_normal(a, b, c), 1));
    }
    std::cout << "[ MEASURED ] N18 ulp from double: t " << worst.t << ", weights " << worst.weights
              << ", point " << worst.point << ", normal " << worst.normal << "\n";
    EXPECT_LE(worst.t, 16);
    EXPECT_LE(worst.weights, 16);
    EXPECT_LE(worst.point, 16);
    EXPECT_LE(worst.normal, 16);
    EXPECT_GT(worst.t, 0) << "the device's answers are rounded; were they asked for?";
}

} // namespace
