// Compares our BVH traversal on the device, ray by ray, with two independent ray tracers: Embree on
// the CPU and, if the device has them, ray queries. This file calls each of the three ray tracers a
// witness.
//
// A ray at an edge has two correct answers, so witnesses may differ. If they differ, each answer is
// judged. An answer is founded if some ray within the rounding errors of a float gets the same
// answer in double precision. Otherwise the answer is unfounded.
#include "drivers/embree.hpp"
#include "drivers/ray_query.hpp"
#include "drivers/second_driver.hpp"
#include "drivers/witness_rays.hpp"
#include "support/process.hpp"

#include <gmock/gmock.h>

#include <iostream>

namespace {

using namespace catoptric;
using test::DeviceHit;
using test::DeviceRay;
using test::DeviceRayTracer;
using test::WitnessRayBatch;

/// Number of wrong answers that the test prints for each ray tracer and list of rays.
constexpr std::size_t kMaxListedAnswers = 3;

/// Largest allowed share of wrong answers of one ray tracer to a list of rays: answers that no ray
/// within rounding errors gets in double precision. The ray queries of lavapipe have the largest
/// share, for rays at the edges of the mesh `corridor`.
constexpr double kMaxUnfoundedShareAtEdges = 0.05;

struct RayWitness {
    std::string name;
    std::vector<DeviceHit> hits;
    std::size_t leaks = 0;      ///< misses from strictly inside a closed mesh
    std::size_t off = 0;        ///< hits outside their triangle by more than rounding errors
    std::size_t at_corners = 0; ///< unfounded answers to rays through a corner
    std::size_t at_edges = 0;   ///< unfounded answers to rays through an edge
    std::size_t elsewhere = 0;  ///< all other unfounded answers
    std::size_t count_unfounded_answers() const { return at_corners + at_edges + elsewhere; }
};

/// How the answers of two witnesses to one ray compare.
enum RayWitnessVerdict { kSameTriangle, kSamePlace, kOtherSurface, kHitOrMiss };
constexpr std::array kVerdictNames{"same triangle", "another at the same distance",
                                   "another surface", "hit or miss"};

dvec3 ray_origin(const DeviceRay& ray) { return dvec3(ray.origin); }
dvec3 ray_direction(const DeviceRay& ray) { return glm::normalize(dvec3(ray.direction)); }
std::array<dvec3, 3> list_corners(const bvh::Triangle& t) {
    return {dvec3(t.a), dvec3(t.b), dvec3(t.c)};
}

/// Returns the unit normal of the triangle, or zero if the triangle has no area.
dvec3 unit_normal_of_triangle(const bvh::Triangle& t) {
    const auto [a, b, c] = list_corners(t);
    const dvec3 normal = glm::cross(b - a, c - a);
    return normal == dvec3(0) ? normal : glm::normalize(normal);
}

double distance_to_nearest_corner(const bvh::Triangle& t, const DeviceRay& ray) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const dvec3& corner : list_corners(t))
        nearest = std::min(nearest,
                           glm::length(glm::cross(ray_direction(ray), corner - ray_origin(ray))));
    return nearest;
}

/// Returns the signed distances of the ray from the lines along the triangle's edges. All distances
/// have one sign if the ray passes through the triangle.
std::array<double, 3> signed_distances_to_edges(const bvh::Triangle& t, const DeviceRay& ray) {
    const auto c = list_corners(t);
    std::array<double, 3> result{};
    for (std::size_t i = 0; i < 3; ++i) {
        const dvec3 across = glm::cross(ray_direction(ray), c[(i + 1) % 3] - c[i]);
        if (across != dvec3(0))
            result[i] = glm::dot(glm::normalize(across), c[i] - ray_origin(ray));
    }
    return result;
}

/// Returns how far rounding errors of floats may move a ray at the triangle. The bound is 16
/// roundings of the distance to the farthest corner, as in make_box_ray
/// (shaders/lib/math/ray.glsl).
double ray_rounding_slack(const bvh::Triangle& t, const DeviceRay& ray) {
    double reach = 0;
    for (const dvec3& corner : list_corners(t))
        for (int axis = 0; axis < 3; ++axis)
            reach = std::max(reach, std::abs(corner[axis] - ray_origin(ray)[axis]));
    return double{f32::rounding_error_gamma_bound(16)} * reach;
}

/// Returns the error that roundings may cause in the ray parameter t. The error grows as the angle
/// between ray and triangle shrinks.
double ray_parameter_rounding_slack(const bvh::Triangle& t, const DeviceRay& ray) {
    return ray_rounding_slack(t, ray) /
           std::abs(glm::dot(unit_normal_of_triangle(t), dvec3(ray.direction)));
}

/// Returns whether a hit is wrong by more than rounding errors. Such a ray passes beside its
/// triangle, or t is not the parameter at which it meets the triangle's plane.
bool is_hit_wrong(const bvh::Triangle& t, const DeviceRay& ray, const DeviceHit& hit) {
    const auto [lowest, highest] = std::ranges::minmax(signed_distances_to_edges(t, ray));
    if (std::min(-lowest, highest) > ray_rounding_slack(t, ray)) return true;
    const dvec3 normal = unit_normal_of_triangle(t);
    const double exact = glm::dot(normal, dvec3(t.a) - ray_origin(ray)) /
                         glm::dot(normal, dvec3(ray.direction));
    const double limit = ray_parameter_rounding_slack(t, ray);
    return std::isfinite(limit) && !(std::abs(double{hit.t} - exact) <= limit);
}

RayWitnessVerdict compare_two_hits_of_ray(const WitnessRayBatch& batch, const DeviceRay& ray,
                                          const DeviceHit& a, const DeviceHit& b) {
    if (a.is_hit() != b.is_hit()) return kHitOrMiss;
    if (!a.is_hit() || a.triangle == b.triangle) return kSameTriangle;
    const double limit = ray_parameter_rounding_slack(batch.triangles[a.triangle], ray) +
                         ray_parameter_rounding_slack(batch.triangles[b.triangle], ray);
    return std::abs(double{a.t} - double{b.t}) <= limit ? kSamePlace : kOtherSurface;
}

/// Returns whether some ray within `distance` of the ray gets the same answer in double precision.
bool is_answer_backed_by_geometry(const WitnessRayBatch& batch, const bvh::Bvh& hierarchy,
                                  const DeviceRay& ray, const DeviceHit& answer, double distance) {
    constexpr int kTestedRingCount = 12, kAround = 16; // radii from distance / 2048, doubling
    const dvec3 side = glm::normalize(
        glm::cross(ray_direction(ray),
                   std::abs(ray_direction(ray).x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
    const dvec3 up = glm::cross(ray_direction(ray), side);
    for (int ring = 0; ring <= kTestedRingCount; ++ring)
        for (int i = 0; i < (ring == 0 ? 1 : kAround); ++i) {
            const double angle = 2 * std::numbers::pi * i / kAround,
                         radius = ring == 0 ? 0 : std::ldexp(distance, ring - kTestedRingCount);
            const dvec3 origin = ray_origin(ray) +
                                 radius * (std::cos(angle) * side + std::sin(angle) * up);
            const auto hit = bvh::find_closest_hit<double>(hierarchy,
                                                           {origin, dvec3(ray.direction), 0},
                                                           std::numeric_limits<double>::infinity());
            DeviceHit found;
            if (hit)
                found = {
                    static_cast<float>(hit->t), vec3(hit->barycentric), hit->triangle, 0, 1, 0};
            if (compare_two_hits_of_ray(batch, ray, found, answer) <= kSamePlace) return true;
        }
    return false;
}

/// Returns how far a ray may be moved to explain the answer of witness `which`. The distance covers
/// rounding errors at the triangle of the answer, and at nearer triangles that other witnesses hit.
double allowed_ray_distance(const WitnessRayBatch& batch, const std::vector<RayWitness>& witnesses,
                            std::size_t which, std::size_t i) {
    const DeviceHit& answer = witnesses[which].hits[i];
    double distance = 0;
    for (const RayWitness& witness : witnesses) {
        const DeviceHit& hit = witness.hits[i];
        if (hit.is_hit() && (!answer.is_hit() || hit.t <= answer.t))
            distance = std::max(distance,
                                ray_rounding_slack(batch.triangles[hit.triangle], batch.rays[i]));
    }
    return distance;
}

void print_unfounded_answer(const WitnessRayBatch& batch, const std::vector<RayWitness>& witnesses,
                            std::size_t which, std::size_t i) {
    std::cout << "    unfounded: " << witnesses[which].name << ", ray " << i << ": "
              << test::format_for_message(batch.rays[i]) << "\n";
    for (const RayWitness& witness : witnesses)
        std::cout << "      " << witness.name << ": " << test::format_for_message(witness.hits[i])
                  << "\n";
}

/// Counts an unfounded answer of the witness `charged` as near a corner, near an edge, or
/// elsewhere. Corners and edges are those of the triangles that witnesses hit.
void count_unfounded_answer(const WitnessRayBatch& batch, const std::vector<RayWitness>& witnesses,
                            RayWitness& charged, std::size_t i) {
    bool at_corner = false, at_edge = false;
    for (const RayWitness& witness : witnesses) {
        if (!witness.hits[i].is_hit()) continue;
        const bvh::Triangle& t = batch.triangles[witness.hits[i].triangle];
        const double limit = ray_rounding_slack(t, batch.rays[i]);
        at_corner = at_corner || distance_to_nearest_corner(t, batch.rays[i]) <= limit;
        for (const double edge : signed_distances_to_edges(t, batch.rays[i]))
            at_edge = at_edge || std::abs(edge) <= limit;
    }
    ++(at_corner ? charged.at_corners : at_edge ? charged.at_edges : charged.elsewhere);
}

void judge_unfounded_answers(const WitnessRayBatch& batch, const bvh::Bvh& hierarchy,
                             std::vector<RayWitness>& witnesses) {
    for (std::size_t i = 0; i < batch.rays.size(); ++i) {
        const auto differs = [&](const RayWitness& w) {
            return compare_two_hits_of_ray(batch, batch.rays[i], witnesses[0].hits[i], w.hits[i]) >
                   kSamePlace;
        };
        if (std::none_of(witnesses.begin(), witnesses.end(), differs)) continue;
        for (std::size_t k = 0; k < witnesses.size(); ++k) {
            if (is_answer_backed_by_geometry(batch, hierarchy, batch.rays[i], witnesses[k].hits[i],
                                             allowed_ray_distance(batch, witnesses, k, i)))
                continue;
            if (witnesses[k].count_unfounded_answers() < kMaxListedAnswers)
                print_unfounded_answer(batch, witnesses, k, i);
            count_unfounded_answer(batch, witnesses, witnesses[k], i);
        }
    }
}

void count_answers_unlike_all_witnesses(const WitnessRayBatch& batch, RayWitness& witness) {
    ASSERT_EQ(witness.hits.size(), batch.rays.size());
    for (std::size_t i = 0; i < batch.rays.size(); ++i) {
        const DeviceHit& hit = witness.hits[i];
        ASSERT_TRUE(!hit.is_hit() || hit.triangle < batch.triangles.size());
        witness.leaks += batch.inside && !hit.is_hit() ? 1 : 0;
        witness.off += hit.is_hit() &&
                               is_hit_wrong(batch.triangles[hit.triangle], batch.rays[i], hit)
                           ? 1
                           : 0;
    }
}

void print_witness_pair_agreement(const WitnessRayBatch& batch, const RayWitness& a,
                                  const RayWitness& b) {
    std::array<std::size_t, kVerdictNames.size()> counts{};
    for (std::size_t i = 0; i < batch.rays.size(); ++i)
        ++counts[compare_two_hits_of_ray(batch, batch.rays[i], a.hits[i], b.hits[i])];
    std::cout << "  " << a.name << " and " << b.name << ":";
    for (std::size_t kind = 0; kind < counts.size(); ++kind)
        std::cout << (kind ? ", " : " ") << counts[kind] << ' ' << kVerdictNames[kind];
    std::cout << "\n";
}

void compare_ray_tracers(const WitnessRayBatch& batch, const bvh::Bvh& hierarchy,
                         std::vector<RayWitness>& witnesses) {
    std::cout << "[ MEASURED ] " << batch.name << ": " << batch.rays.size() << " rays, "
              << batch.triangles.size() << " triangles\n";
    for (RayWitness& witness : witnesses) count_answers_unlike_all_witnesses(batch, witness);
    for (std::size_t a = 0; a < witnesses.size(); ++a)
        for (std::size_t b = a + 1; b < witnesses.size(); ++b)
            print_witness_pair_agreement(batch, witnesses[a], witnesses[b]);
    judge_unfounded_answers(batch, hierarchy, witnesses);
    for (const RayWitness& w : witnesses)
        std::cout << "  " << w.name << ": " << w.leaks << " leaks, " << w.off
                  << " off their triangle, unfounded " << w.at_corners << " at corners, "
                  << w.at_edges << " at edges, " << w.elsewhere << " elsewhere\n";
}

/// Adds three batches of rays for a closed mesh: from inside, from inside towards edges, and nearly
/// in the planes of triangles.
void add_batches_of_closed_mesh(std::vector<WitnessRayBatch>& batches, const std::string& name,
                                const test::ClosedMesh& closed, double scale, dvec3 offset,
                                test::RandomNumbers& numbers) {
    constexpr std::size_t kRaysPerBatch = 100000;
    const std::vector<bvh::Triangle> triangles =
        test::make_placed_triangles(closed.mesh, scale, offset).value();
    const std::vector<DeviceRay> inside = test::make_rays_inside_mesh(closed, scale, offset,
                                                                      kRaysPerBatch, numbers);
    batches.push_back({name + ", from inside", triangles, inside, true});
    batches.push_back({name + ", from inside at edges", triangles,
                       test::turn_rays_to_edges(inside, triangles, numbers), true});
    batches.push_back({name + ", grazing", triangles,
                       test::make_grazing_rays(triangles, kRaysPerBatch, numbers), false, true});
}

std::vector<WitnessRayBatch> batches() {
    test::RandomNumbers numbers(41);
    std::vector<WitnessRayBatch> result;
    const std::vector<bvh::Triangle> scene = test::list_built_in_triangles();
    result.push_back(
        {"built-in scene, anywhere", scene, test::make_rays_in_bounds(scene, 500000, numbers)});
    result.push_back({"built-in scene, at edges", scene,
                      test::turn_rays_to_edges(test::make_rays_in_bounds(scene, 300000, numbers),
                                               scene, numbers)});
    result.push_back({"built-in scene, grazing", scene,
                      test::make_grazing_rays(scene, 300000, numbers), false, true});
    add_batches_of_closed_mesh(result, "ball", test::make_closed_ball(), 1, dvec3(0), numbers);
    add_batches_of_closed_mesh(result, "torus", test::make_closed_torus(), 1, dvec3(0), numbers);
    add_batches_of_closed_mesh(result, "room", test::make_closed_box("room", 1), 1, dvec3(0),
                               numbers);
    add_batches_of_closed_mesh(result, "corridor", test::make_closed_box("corridor", 1000), 1,
                               dvec3(0), numbers);
    // Embree's own tests place a ball at this position, where neighbouring floats are 1/64 apart.
    add_batches_of_closed_mesh(result, "ball far out", test::make_closed_ball(), 100,
                               dvec3(148376, 1234, -223423), numbers);
    return result;
}

TEST(Witnesses, RayTracersAgreeRayByRay) {
    std::string reason;
    const std::unique_ptr<test::RayQueryDevice> device = test::RayQueryDevice::open(reason);
    std::optional<test::DriverRayQuery> ray_query;
    if (device) ray_query.emplace(*device);
    std::cout << "[ MEASURED ] walk on " << test::get_test_device().device.info().driver
              << ", Embree " << RTC_VERSION_STRING << ", "
              << (device ? "ray query on " + device->device_name() : reason) << "\n";
    std::size_t rays = 0, found = 0;
    for (const WitnessRayBatch& batch : batches()) {
        SCOPED_TRACE(batch.name);
        DeviceRayTracer kernel(batch.triangles);
        std::vector<RayWitness> witnesses{
            {"walk", kernel.find_closest_hits(batch.rays)},
            {"embree", test::EmbreeRayWitness(batch.triangles).find_closest_hits(batch.rays)}};
        if (ray_query)
            witnesses.push_back(
                {"ray query", ray_query->find_closest_hits(batch.triangles, batch.rays)});
        compare_ray_tracers(batch, kernel.traversed_bvh(), witnesses);
        EXPECT_EQ(witnesses[0].leaks, 0u);
        EXPECT_EQ(witnesses[0].count_unfounded_answers(), 0u);
        for (const RayWitness& witness : witnesses) {
            EXPECT_EQ(witness.off, 0u) << witness.name;
            EXPECT_EQ(witness.elsewhere, 0u) << witness.name;
            EXPECT_LE(static_cast<double>(witness.count_unfounded_answers()),
                      kMaxUnfoundedShareAtEdges * static_cast<double>(batch.rays.size()))
                << witness.name;
        }
        rays += batch.rays.size();
        found += static_cast<std::size_t>(
            std::count_if(witnesses[0].hits.begin(), witnesses[0].hits.end(),
                          [](const DeviceHit& h) { return h.is_hit(); }));
    }
    if (device) {
        EXPECT_THAT(device->validation_messages(), testing::IsEmpty());
    }
    std::cout << "[ MEASURED ] " << found << " of " << rays << " rays hit, "
              << (device ? "three" : "two") << " witnesses\n";
    EXPECT_GT(found, rays / 2);
}

/// Runs the test of this suite again on the second driver, which has ray queries.
TEST(Witnesses, RayTracersAgreeOnTheSecondDriver) {
    const auto environment = test::find_second_driver_environment();
    if (!environment) GTEST_SKIP() << test::kNoSecondDriverMessage;
    const test::ProcessResult ended = test::run_process(
        {.command = {std::filesystem::read_symlink("/proc/self/exe").string(),
                     "--gtest_filter=Witnesses.RayTracersAgreeRayByRay"},
         .environment = *environment});
    std::cout << ended.out;
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_THAT(ended.out, testing::HasSubstr("ray query on llvmpipe"));
    EXPECT_THAT(ended.out, testing::HasSubstr("Mesa 25"));
    EXPECT_THAT(ended.out, testing::HasSubstr("three witnesses"));
}

} // namespace
