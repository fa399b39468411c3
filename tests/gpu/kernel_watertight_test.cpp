// Tests of watertightness. A ray that starts strictly inside a closed mesh and hits nothing has
// passed between two triangles, or past a box of the BVH.
#include "support/kernel.hpp"
#include "support/kernel_shapes.hpp"

#include <algorithm>
#include <iostream>

namespace {

using namespace catoptric;
using test::DeviceHit;
using test::DeviceRay;
using test::DeviceRayTracer;

constexpr std::size_t kRaysPerChunk = 1u << 18;

std::size_t count_rays_without_hit(const std::vector<DeviceRay>& rays,
                                   const std::vector<DeviceHit>& hits) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (hits[i].is_hit()) continue;
        if (count++ == 0)
            ADD_FAILURE() << "ray " << i << " leaks: " << test::format_for_message(rays[i]);
    }
    return count;
}

/// A test from Embree: spheres far from the origin, where neighbouring floats are 1/64 apart. The
/// smaller meshes are deformed by rounding, and some of their triangles have no area, but all
/// meshes stay closed.
TEST(KernelWatertight, N14_RaysCannotLeaveMeshSpheresFarFromTheOrigin) {
    constexpr std::size_t kWatertightRayCount = 1000000;
    const dvec3 centre(148376, 1234, -223423);
    std::size_t rays_in_all = 0, missed = 0, different = 0;
    for (const double radius : {2.0, 10.0, 100.0, 1e4}) {
        std::vector<bvh::Triangle> triangles;
        const scene::Mesh mesh = scene::ball("ball", 5);
        for (const uvec3& t : mesh.triangles) {
            const auto corner = [&](std::uint32_t i) {
                return vec3(mesh.positions[i] * radius + centre);
            };
            triangles.push_back({corner(t.x), corner(t.y), corner(t.z)});
        }
        DeviceRayTracer kernel(triangles);
        test::RandomNumbers numbers(14);
        for (std::size_t done = 0; done < kWatertightRayCount; done += kRaysPerChunk) {
            std::vector<DeviceRay> rays(std::min(kRaysPerChunk, kWatertightRayCount - done));
            for (DeviceRay& ray : rays) {
                ray.origin = vec3(centre + 0.5 * radius * dvec3(numbers.random_point_in_cube()));
                ray.direction = numbers.random_unit_direction();
            }
            const std::vector<DeviceHit> hits = kernel.find_closest_hits(rays);
            missed += count_rays_without_hit(rays, hits);
            different += test::count_wrong_hits(kernel, rays, hits, 0, 16);
            rays_in_all += rays.size();
        }
    }
    std::cout << "[ MEASURED ] N14 misses " << missed << " of " << rays_in_all
              << ", other than the mirror " << different << "\n";
    EXPECT_EQ(missed, 0u);
    EXPECT_EQ(different, 0u);
}

struct WatertightTestSetting {
    std::string name;
    double scale;
    dvec3 offset;
    const test::ClosedMesh* closed;
    std::vector<bvh::Triangle> triangles;
};

/// Returns rays from inside the mesh. Each ray aims at a corner or at a point on an edge.
std::vector<DeviceRay> make_rays_aimed_at_edges(const WatertightTestSetting& setting,
                                                std::size_t count, test::RandomNumbers& numbers) {
    std::vector<DeviceRay> rays(count);
    for (DeviceRay& ray : rays) {
        const bvh::Triangle& t =
            setting.triangles[numbers.random_integer_below(setting.triangles.size())];
        const std::size_t first = numbers.random_integer_below(3);
        const vec3 from = std::array{t.a, t.b, t.c}[first], to = std::array{t.b, t.c, t.a}[first];
        const vec3 target = numbers.random_word() % 4 == 0
                                ? from
                                : from + numbers.random_unit_fraction() * (to - from);
        ray.origin = test::random_point_inside(*setting.closed, setting.scale, setting.offset,
                                               numbers);
        ray.direction = target - ray.origin;
        if (numbers.random_word() % 2 == 0) ray.direction = glm::normalize(ray.direction);
    }
    return rays;
}

TEST(KernelWatertight, N15_RaysAtEdgesAndCornersCannotLeaveClosedMeshes) {
    constexpr std::size_t kWatertightRayCount = 10000000;
    const std::array meshes{test::make_closed_ball(), test::make_closed_torus(),
                            test::make_closed_box("room", 1),
                            test::make_closed_box("corridor", 1e5)};
    const dvec3 away = glm::normalize(dvec3(0.62, -0.11, -0.78));
    std::vector<WatertightTestSetting> settings;
    std::size_t left_out = 0;
    for (const test::ClosedMesh& closed : meshes)
        for (const double scale : {1e-4, 1e-2, 1.0, 1e2, 1e4})
            for (const double offset : {0.0, 1.0, 1e3, 1e6}) {
                const auto triangles = test::make_placed_triangles(closed.mesh, scale,
                                                                   offset * away);
                if (!triangles || !test::is_float_precise_enough(scale, offset * away)) {
                    // Leave out settings in which a triangle lost its area by rounding, or in which
                    // no float lies strictly inside the mesh.
                    ++left_out;
                    continue;
                }
                std::ostringstream name;
                name << closed.mesh.name << " x " << scale << " + " << offset;
                settings.push_back({name.str(), scale, offset * away, &closed, *triangles});
            }
    const std::size_t rays_each = (kWatertightRayCount + settings.size() - 1) / settings.size();
    std::size_t rays_in_all = 0, missed = 0, shadows_missed = 0, different = 0;
    test::RandomNumbers numbers(15);
    for (const WatertightTestSetting& setting : settings) {
        SCOPED_TRACE(setting.name);
        DeviceRayTracer kernel(setting.triangles);
        for (std::size_t done = 0; done < rays_each; done += kRaysPerChunk) {
            const std::vector<DeviceRay> rays = make_rays_aimed_at_edges(
                setting, std::min(kRaysPerChunk, rays_each - done), numbers);
            const std::vector<DeviceHit> hits = kernel.find_closest_hits(rays);
            missed += count_rays_without_hit(rays, hits);
            different += test::count_wrong_hits(kernel, rays, hits, 0, 16);
            if (done == 0)
                shadows_missed += count_rays_without_hit(rays, kernel.find_any_hits(rays));
            rays_in_all += rays.size();
        }
    }
    std::cout << "[ MEASURED ] N15 leaks " << missed << " of " << rays_in_all << " rays ("
              << shadows_missed << " of shadow rays), " << settings.size() << " meshes, "
              << left_out << " left out, other than the mirror " << different << "\n";
    EXPECT_GE(rays_in_all, kWatertightRayCount);
    EXPECT_GE(settings.size(), 60u);
    EXPECT_EQ(missed, 0u);
    EXPECT_EQ(shadows_missed, 0u);
    EXPECT_EQ(different, 0u);
}

/// Tests that the same rays do leak with a common triangle test and with common box tests. The test
/// above would therefore notice such gaps.
TEST(KernelWatertight, N15_TheSameRaysLeakWithCommonIntersectionTests) {
    const test::ClosedMesh ball = test::make_closed_ball();
    const dvec3 away(0.62, -0.11, -0.78);
    const WatertightTestSetting setting{"ball", 1, away, &ball,
                                        *test::make_placed_triangles(ball.mesh, 1, away)};
    DeviceRayTracer kernel(setting.triangles);
    test::RandomNumbers numbers(15);
    const std::vector<DeviceRay> rays = make_rays_aimed_at_edges(setting, 4 * kRaysPerChunk,
                                                                 numbers);
    const auto leaks = [&](std::uint32_t without) {
        kernel.rules = {{"without", without}};
        return std::ranges::count_if(kernel.find_closest_hits(rays),
                                     [](const DeviceHit& hit) { return !hit.is_hit(); });
    };
    const auto with = leaks(0), plain_triangles = leaks(1), plain_boxes = leaks(2);
    std::cout << "[ MEASURED ] N15 leaks of " << rays.size() << " rays: " << with
              << " with every rule, " << plain_triangles << " with plain triangles, " << plain_boxes
              << " with plain boxes\n";
    EXPECT_EQ(with, 0);
    EXPECT_GT(plain_triangles, 0);
    EXPECT_GT(plain_boxes, 0);
}

} // namespace
