// Tests of extreme geometry: triangles of random bits, and many triangles at the same place.
#include "core/error.hpp"
#include "scene/repair.hpp"
#include "support/kernel.hpp"
#include "support/kernel_shapes.hpp"
#include "support/process.hpp"

#include <algorithm>
#include <chrono>
#include <iostream>
#include <set>

namespace {

using namespace catoptric;
using test::DeviceHit;
using test::DeviceRay;
using test::DeviceRayTracer;

float random_float_of_bits(test::RandomNumbers& numbers) {
    return std::bit_cast<float>(numbers.random_word());
}
vec3 random_vector_of_bits(test::RandomNumbers& numbers) {
    const float x = random_float_of_bits(numbers), y = random_float_of_bits(numbers);
    return {x, y, random_float_of_bits(numbers)};
}

/// Returns the triangles that remain after a scene loader has repaired a mesh of `triangles`. Adds
/// the number of triangles without area to `dropped`.
std::vector<bvh::Triangle> repair_triangles_as_loader(const std::vector<bvh::Triangle>& triangles,
                                                      std::size_t& dropped) {
    scene::Mesh mesh{.name = "bits"};
    for (const bvh::Triangle& t : triangles) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), {dvec3(t.a), dvec3(t.b), dvec3(t.c)});
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    dropped += scene::repair_mesh(mesh);
    for (const vec3& normal : mesh.normals) EXPECT_TRUE(f32::is_finite(normal));
    std::vector<bvh::Triangle> result;
    for (const uvec3& t : mesh.triangles)
        result.push_back(
            {vec3(mesh.positions[t.x]), vec3(mesh.positions[t.y]), vec3(mesh.positions[t.z])});
    return result;
}

/// Returns rays for tests of invalid input. Every second ray consists of random bits. The other
/// rays start at random points and aim at corners of the triangles.
std::vector<DeviceRay> make_rays_at_triangles(const std::vector<bvh::Triangle>& triangles,
                                              test::RandomNumbers& numbers) {
    std::vector<DeviceRay> rays(128);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        rays[i].origin = i % 2 == 0 ? random_vector_of_bits(numbers)
                                    : numbers.random_point_in_cube();
        rays[i].direction = i % 2 == 0
                                ? random_vector_of_bits(numbers)
                                : triangles[numbers.random_integer_below(triangles.size())].b -
                                      rays[i].origin;
        if (i % 4 == 0) rays[i].t_max = random_float_of_bits(numbers);
    }
    return rays;
}

TEST(KernelGeometry, N19_TrianglesOfRandomBitsAreDroppedOrTracedInBoundedSteps) {
    constexpr std::size_t kRandomMeshCount = 1000, kTriangles = 60;
    std::size_t not_finite = 0, flat = 0, kept = 0, hits = 0;
    std::uint32_t most_steps = 0;
    for (std::size_t seed = 0; seed < kRandomMeshCount; ++seed) {
        SCOPED_TRACE(seed);
        test::RandomNumbers numbers(seed);
        std::vector<bvh::Triangle> triangles(kTriangles);
        for (bvh::Triangle& t : triangles)
            t = {random_vector_of_bits(numbers), random_vector_of_bits(numbers),
                 random_vector_of_bits(numbers)};
        std::set<std::size_t> finite;
        std::vector<bvh::Triangle> good;
        for (std::size_t i = 0; i < kTriangles; ++i) {
            const bvh::Triangle& t = triangles[i];
            if (!f32::is_finite(t.a) || !f32::is_finite(t.b) || !f32::is_finite(t.c)) continue;
            finite.insert(i);
            good.push_back(t);
        }
        // Build a BVH of all triangles without repair, and check the loader's result on the finite
        // triangles.
        DeviceRayTracer kernel(triangles);
        const bvh::Bvh& hierarchy = kernel.traversed_bvh();
        ASSERT_EQ(hierarchy.dropped, kTriangles - finite.size());
        ASSERT_EQ(bvh::count_triangles(hierarchy), finite.size());
        for (const vec4& corner : hierarchy.triangles) ASSERT_TRUE(f32::is_finite(vec3(corner)));
        const std::vector<bvh::Triangle> area = repair_triangles_as_loader(good, flat);
        ASSERT_EQ(bvh::build(area).dropped, 0u);
        not_finite += hierarchy.dropped;
        kept += area.size();

        const std::vector<DeviceRay> rays = make_rays_at_triangles(triangles, numbers);
        for (const DeviceHit& hit : kernel.find_closest_hits(rays)) {
            ASSERT_FALSE(hit.has_reached_step_limit());
            most_steps = std::max(most_steps, hit.steps);
            ASSERT_LE(hit.steps, bvh::count_nodes(hierarchy) + bvh::count_triangles(hierarchy))
                << "nothing is looked at twice";
            if (!hit.is_hit()) continue;
            ++hits;
            ASSERT_TRUE(hit.t > 0 && std::isfinite(hit.t));
            ASSERT_TRUE(finite.contains(hit.triangle));
        }
        for (const DeviceRay& ray : rays) test::find_hit_on_cpu(hierarchy, ray);
    }
    std::cout << "[ MEASURED ] N19 " << kRandomMeshCount << " seeds: " << not_finite
              << " triangles dropped as not finite, " << flat << " without an area, " << kept
              << " kept; " << hits << " hits, at most " << most_steps << " steps\n";
    EXPECT_GT(not_finite, 0u);
    EXPECT_GT(hits, 0u);
}

const bvh::Triangle kOne{{-1, -1, 1}, {1, -1, 1}, {0, 1, 1}};

std::vector<bvh::Triangle> make_triangle_copies(std::size_t count, bool of_one_object) {
    std::vector<bvh::Triangle> result(count, kOne);
    for (std::size_t i = 0; i < count; ++i)
        result[i].object = of_one_object ? 0 : static_cast<std::uint32_t>(count - i);
    return result;
}

/// Returns rays that start on either side of the triangle. Some of the rays hit the triangle, and
/// the other rays pass beside it.
std::vector<DeviceRay> make_rays_at_triangle_copies() {
    test::RandomNumbers numbers(21);
    std::vector<DeviceRay> rays(256);
    for (DeviceRay& ray : rays) {
        ray.origin = {0.4f * numbers.random_number_between(-1, 1),
                      0.4f * numbers.random_number_between(-1, 1),
                      numbers.random_word() % 2 == 0 ? 0.0f : 2.0f};
        ray.direction = vec3(0.3f, 0.3f, 1) * numbers.random_point_in_cube();
    }
    return rays;
}

/// Tests 100,000 copies of one triangle. A ray meets all copies at the same t, so it would have to
/// test every copy. Copies of one object cannot be distinguished, so the BVH keeps one copy.
TEST(KernelGeometry, N21_CopiesOfOneTriangleAreTracedAsOne) {
    const std::vector<bvh::Triangle> triangles = make_triangle_copies(100000, true);
    const auto start = std::chrono::steady_clock::now();
    bvh::Bvh hierarchy = bvh::build(triangles);
    const std::chrono::duration<double> build = std::chrono::steady_clock::now() - start;
    DeviceRayTracer kernel(std::move(hierarchy));
    const std::vector<DeviceRay> rays = make_rays_at_triangle_copies();
    const std::vector<DeviceHit> hits = kernel.find_closest_hits(rays),
                                 shadows = kernel.find_any_hits(rays);
    std::size_t found = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_FALSE(hits[i].has_reached_step_limit())
            << "gave up after " << hits[i].steps << " steps";
        ASSERT_EQ(hits[i].triangle, 0u);
        ASSERT_EQ(hits[i].is_hit(), shadows[i].is_hit());
        found += hits[i].is_hit() ? 1 : 0;
    }
    std::cout << "[ MEASURED ] N21 100,000 copies: build " << build.count() << " s, " << found
              << " of " << rays.size() << " rays hit, all of them triangle 0\n";
    EXPECT_EQ(test::count_wrong_hits(kernel, rays, hits), 0u);
    EXPECT_GT(found, rays.size() / 4);
    EXPECT_LT(found, rays.size());
    EXPECT_LT(build.count(), 5);
}

/// Tests that the BVH keeps all copies that belong to different objects. If a ray can test all
/// copies within its step limit, the lowest number wins. Otherwise the ray reports that it gave up.
/// Its neighbouring lanes may give up too, because the driver ends their loops as well.
TEST(KernelGeometry, N21_CopiesInDifferentObjectsAreAllKept) {
    const std::vector<DeviceRay> rays = make_rays_at_triangle_copies();
    for (const std::size_t count : {std::size_t{5000}, std::size_t{100000}}) {
        DeviceRayTracer kernel(make_triangle_copies(count, false));
        ASSERT_EQ(bvh::count_triangles(kernel.traversed_bvh()), count);
        const std::vector<DeviceHit> hits = kernel.find_closest_hits(rays);
        std::size_t found = 0, gave_up = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const DeviceHit expected = test::find_hit_on_cpu(kernel.traversed_bvh(), rays[i]);
            gave_up += hits[i].has_reached_step_limit() ? 1 : 0;
            found += expected.is_hit() ? 1 : 0;
            ASSERT_EQ(expected.triangle, 0u);
            ASSERT_TRUE(hits[i].has_reached_step_limit() ||
                        test::is_hit_of_cpu(rays[i], hits[i], expected))
                << i << ' ' << test::format_for_message(hits[i]);
        }
        std::cout << "[ MEASURED ] case N21, copies of one triangle in " << count
                  << " objects: " << found << " rays hit, " << gave_up
                  << " ended at the limit of steps\n";
        EXPECT_GT(found, rays.size() / 4);
        if (count < 60000)
            EXPECT_EQ(gave_up, 0u);
        else
            EXPECT_GE(gave_up, found);
    }
}

/// Tests a ball whose triangles are in the list three times, the third time with the corners in
/// another order. Among hits of equal t the lowest number must win, whichever leaf holds it. No ray
/// may hit the second copy. The test prints a checksum of all hits, which the next test compares.
TEST(KernelGeometry, N21_LowestNumberWinsAmongCoplanarDuplicates) {
    std::vector<bvh::Triangle> triangles = *test::make_placed_triangles(scene::ball("ball", 5), 1,
                                                                        dvec3(0));
    const std::size_t once = triangles.size();
    for (std::size_t i = 0; i < once; ++i) triangles.push_back(triangles[i]);
    for (std::size_t i = 0; i < once; ++i)
        triangles.push_back({triangles[i].b, triangles[i].c, triangles[i].a, 1});
    DeviceRayTracer kernel(triangles);
    test::RandomNumbers numbers(22);
    std::vector<DeviceRay> rays(50000);
    for (DeviceRay& ray : rays) {
        ray.origin = 0.5f * numbers.random_point_in_cube();
        const bvh::Triangle& t = triangles[numbers.random_integer_below(once)];
        ray.direction = numbers.random_word() % 2 == 0
                            ? numbers.random_unit_direction()
                            : t.a + numbers.random_unit_fraction() * (t.b - t.a) - ray.origin;
    }
    const std::vector<DeviceHit> hits = kernel.find_closest_hits(rays);
    std::size_t not_lowest = 0;
    std::uint64_t checksum = 14695981039346656037u; // offset basis of the FNV-1a hash
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const auto lowest = bvh::find_closest_hit<float>(
            kernel.traversed_bvh(), {rays[i].origin, rays[i].direction, 0}, rays[i].t_max);
        // Which of two equal triangles is nearer depends on the last bit of t.
        const bool second = hits[i].triangle >= once && hits[i].triangle < 2 * once,
                   same = lowest &&
                          (test::computes_like_cpp()
                               ? hits[i].triangle == lowest->triangle && hits[i].t == lowest->t
                               : test::is_hit_of_cpu(rays[i], hits[i],
                                                     {lowest->t, {}, 0, hits[i].object, 1}));
        not_lowest += same && !second ? 0 : 1;
        for (const std::uint32_t word : std::bit_cast<std::array<std::uint32_t, 8>>(hits[i]))
            checksum = (checksum ^ word) * 1099511628211u;
    }
    std::cout << "[ MEASURED ] N21 coplanar: " << not_lowest << " of " << rays.size()
              << " rays do not meet the lowest number; checksum " << checksum << "\n";
    EXPECT_EQ(not_lowest, 0u);
}

TEST(KernelGeometry, N21_OneAndTwoDriverThreadsAgree) {
    if (!test::get_test_device().device.is_cpu())
        GTEST_SKIP() << "only a software driver can be told its number of threads";
    const auto checksum = [](const char* threads) {
        const test::ProcessResult ended = test::run_process(
            {.command = {"/proc/self/exe", "--gtest_filter=KernelGeometry."
                                           "N21_LowestNumberWinsAmongCoplanarDuplicates"},
             .environment = {{"LP_NUM_THREADS", threads}}});
        EXPECT_EQ(ended.exit_code, 0) << ended.out << ended.err;
        const std::size_t at = ended.out.find("checksum ");
        EXPECT_NE(at, std::string::npos) << ended.out;
        return at == std::string::npos ? ended.out
                                       : ended.out.substr(at, ended.out.find('\n', at) - at);
    };
    EXPECT_EQ(checksum("1"), checksum("2"));
}

} // namespace
