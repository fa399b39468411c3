#include "bvh/box.hpp"
#include "bvh/bvh.hpp"
#include "bvh/closest_hit.hpp"
#include "bvh/words.hpp"
#include "support/hierarchies.hpp"
#include "support/numbers.hpp"
#include "support/special_values.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <random>

namespace catoptric::bvh {
namespace {

using test::expect_valid_bvh, test::have_equal_bytes, test::make_random_triangles;

/// Builds a ball by dividing the faces of an octahedron `levels` times. Neighbouring faces compute
/// the midpoint of their shared edge from the same two corners, so both get the same floats.
std::vector<Triangle> make_divided_octahedron(int levels, float scale = 1, vec3 offset = vec3(0)) {
    std::vector<std::array<vec3, 3>> faces;
    for (int i = 0; i < 8; ++i) {
        const vec3 x((i & 1) != 0 ? -1 : 1, 0, 0), y(0, (i & 2) != 0 ? -1 : 1, 0);
        faces.push_back({x, y, vec3(0, 0, (i & 4) != 0 ? -1 : 1)});
    }
    const auto middle = [](vec3 a, vec3 b) { return glm::normalize(a + b); };
    for (int level = 0; level < levels; ++level) {
        std::vector<std::array<vec3, 3>> finer;
        for (const auto& [a, b, c] : faces) {
            const vec3 ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        faces = std::move(finer);
    }
    std::vector<Triangle> result;
    for (const auto& [a, b, c] : faces)
        result.push_back({a * scale + offset, b * scale + offset, c * scale + offset});
    return result;
}

TEST(Bvh, BoxOutsideTheCoreGrowsByTwiceTheRoundingErrorOfItsDistance) {
    const BoundingBox core{vec3(-1), vec3(3)}; // its middle is (1, 1, 1)
    EXPECT_EQ(box_padding({vec3(-1), vec3(3)}, core), 0);
    const float gamma = f32::rounding_error_gamma_bound(16);
    // The largest distances from the middle along an axis are 6 - 1 and 1 - (-9).
    EXPECT_FLOAT_EQ(box_padding({{0, 0, 2}, {1, 1, 6}}, core), 2 * gamma * 5);
    EXPECT_FLOAT_EQ(box_padding({{0, -9, 2}, {1, 1, 6}}, core), 2 * gamma * 10);
}

TEST(Bvh, TreeIsSoundForAnyTriangleCount) {
    for (std::size_t count : {0, 1, 2, 3, 4, 5, 8, 9, 100, 5000}) {
        SCOPED_TRACE(count);
        const Bvh bvh = build(make_random_triangles(count, 1));
        expect_valid_bvh(bvh, count);
        EXPECT_EQ(bvh.dropped, 0u);
    }
}

/// Counts how many triangles cast shadows among those stored before the given place.
std::size_t count_casters_before(const Bvh& bvh, std::size_t place) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < place; ++i)
        count += (unpack_number(bvh.triangles[3 * i + 2].w) & kCastsNoShadowFlag) == 0 ? 1 : 0;
    return count;
}

TEST(Bvh, AFewTrianglesWithoutShadowsGetATreeOfTheirOwn) {
    constexpr std::size_t kTriangleCount = 20000; // more than one task reads
    for (const std::size_t shadowless : {0, 1, 7, 256, 257, 20000}) {
        SCOPED_TRACE(shadowless);
        std::vector<Triangle> triangles = make_random_triangles(kTriangleCount, 31);
        for (std::size_t i = 0; i < shadowless; ++i)
            triangles[7919 * i % kTriangleCount].flags = kCastsNoShadowFlag;
        for (std::size_t i = 3; i < kTriangleCount; i += 1000)
            if (triangles[i].flags == 0) triangles[i].b.x = test::kFloatInfinity;
        const Bvh bvh = build(triangles, {}, kMaxLeafTriangles, 1);
        const std::size_t stored = kTriangleCount - bvh.dropped,
                          casters = stored - std::min(shadowless, stored);
        expect_valid_bvh(bvh, stored);
        EXPECT_TRUE(have_equal_bytes(bvh.nodes, build(triangles, {}, kMaxLeafTriangles, 3).nodes));
        const bool is_apart = shadowless > 0 && shadowless <= kMaxShadowless;
        const std::uint32_t first = float_to_bits(bvh.nodes[3].x),
                            second = float_to_bits(bvh.nodes[3].y);
        EXPECT_EQ(first, is_apart ? float_to_bits(bvh.nodes[4].w) : f32::kBvhRoot);
        EXPECT_EQ(second, is_apart ? float_to_bits(bvh.nodes[5].w) : f32::kBvhEmptyChild);
        EXPECT_EQ(count_casters_before(bvh, stored), casters);
        EXPECT_EQ(count_casters_before(bvh, casters) == casters,
                  is_apart || shadowless % kTriangleCount == 0)
            << "casters come first";
    }
}

TEST(Bvh, RaysMissAnEmptyTree) {
    const Bvh bvh = build({});
    EXPECT_FALSE(find_closest_hit<float>(bvh, {vec3(0), vec3(1)}, test::kFloatInfinity));
    EXPECT_FALSE(has_any_hit<float>(bvh, {vec3(0), vec3(1)}, test::kFloatInfinity));
}

TEST(Bvh, EqualInputsGiveEqualBytes) {
    const Bvh a = build(make_random_triangles(3000, 2)), b = build(make_random_triangles(3000, 2));
    EXPECT_TRUE(have_equal_bytes(a.nodes, b.nodes));
    EXPECT_TRUE(have_equal_bytes(a.triangles, b.triangles));
}

TEST(Bvh, RaysThatSkipOneSidedTrianglesMissALampFromBehind) {
    const Triangle lamp{{-1, -1, 1}, {1, -1, 1}, {0, 1, 1}, 0, kOneSidedFlag}; // the lamp faces +z
    const Bvh bvh = build(std::vector{lamp});
    const auto meets = [&](double from, std::uint32_t skipped) {
        const dvec3 origin(0, 0, from), direction(0, 0, 1 - from);
        const bool in_double = find_closest_hit<double>(bvh, {origin, direction, 0},
                                                        test::kFloatInfinity, skipped)
                                   .has_value();
        const Ray<float> ray{vec3(origin), vec3(direction), 0};
        EXPECT_EQ(find_closest_hit<float>(bvh, ray, test::kFloatInfinity, skipped).has_value(),
                  in_double);
        EXPECT_EQ(brute_force_hit<float>(bvh, ray, test::kFloatInfinity, skipped).has_value(),
                  in_double);
        return in_double;
    };
    EXPECT_TRUE(meets(3, kOneSidedFlag));
    EXPECT_FALSE(meets(-1, kOneSidedFlag));
    EXPECT_TRUE(meets(3, kCastsNoShadowFlag));
    EXPECT_TRUE(meets(-1, kCastsNoShadowFlag)) << "whichever side it turns, it casts a shadow";
}

TEST(Bvh, HitsReportNumberAndObjectAndRespectFlags) {
    const Triangle near{{-1, -1, 1}, {1, -1, 1}, {0, 1, 1}, 7, kHiddenFromCameraFlag};
    const Triangle far{{-1, -1, 2}, {1, -1, 2}, {0, 1, 2}, 0x1ffffffe, 0};
    const Bvh bvh = build(std::vector{far, near});
    const Ray<float> ray{vec3(0), vec3(0, 0, 1)};
    const auto first = find_closest_hit<float>(bvh, ray, test::kFloatInfinity);
    ASSERT_TRUE(first);
    EXPECT_EQ(first->triangle, 1u);
    EXPECT_EQ(first->object, 7u);
    EXPECT_EQ(first->t, 1);
    const auto seen = find_closest_hit<float>(bvh, ray, test::kFloatInfinity,
                                              kHiddenFromCameraFlag);
    ASSERT_TRUE(seen);
    EXPECT_EQ(seen->triangle, 0u) << "camera rays pass through";
    EXPECT_EQ(seen->object, 0x1ffffffeu);
    EXPECT_EQ(vec3(bvh.triangles[3 * seen->place]), far.a);
    EXPECT_TRUE(has_any_hit<float>(bvh, ray, 1.5f)) << "hidden ones throw shadows";
    EXPECT_FALSE(has_any_hit<float>(bvh, ray, 1)) << "t_max is excluded";
}

TEST(Bvh, NonFiniteTrianglesAreDroppedAndCounted) {
    std::vector<Triangle> triangles = make_random_triangles(100, 3);
    triangles[10].b.y = test::kFloatNan;
    triangles[20].c.x = test::kFloatInfinity;
    triangles[99].a.z = -test::kFloatInfinity;
    const Bvh bvh = build(triangles);
    EXPECT_EQ(bvh.dropped, 3u);
    expect_valid_bvh(bvh, 97);
}

TEST(Bvh, BuildSurvivesCornersOfRandomBits) {
    std::mt19937 bits(4);
    for (int round = 0; round < 200; ++round) {
        std::vector<Triangle> triangles(60);
        std::size_t finite = 0;
        for (Triangle& t : triangles) {
            bool good = true;
            for (vec3* corner : {&t.a, &t.b, &t.c})
                for (int k = 0; k < 3; ++k) {
                    (*corner)[k] = std::bit_cast<float>(static_cast<std::uint32_t>(bits()));
                    good = good && std::isfinite((*corner)[k]);
                }
            finite += good ? 1 : 0;
        }
        const Bvh bvh = build(triangles);
        EXPECT_EQ(bvh.dropped, triangles.size() - finite);
        expect_valid_bvh(bvh, finite);
        find_closest_hit<float>(bvh, {vec3(1), vec3(1, 2, 3)}, test::kFloatInfinity);
    }
}

TEST(Bvh, LowestNumberWinsAmongCoincidentTriangles) {
    std::vector<Triangle> copies(100000, {{-1, -1, 1}, {1, -1, 1}, {0, 1, 1}});
    for (std::size_t i = 0; i < copies.size(); ++i)
        copies[i].object = static_cast<std::uint32_t>(copies.size() -
                                                      i); // distinct objects keep all copies
    const auto start = std::chrono::steady_clock::now();
    const Bvh bvh = build(copies);
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    EXPECT_LT(time.count(), 5);
    expect_valid_bvh(bvh, copies.size());
    const auto hit = find_closest_hit<float>(bvh, {vec3(0), vec3(0, 0, 1)}, test::kFloatInfinity);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->triangle, 0u);
    TraversalCounters steps;
    EXPECT_TRUE(has_any_hit<float>(bvh, {vec3(0), vec3(0, 0, 1)}, test::kFloatInfinity, 0, &steps));
    EXPECT_LE(steps.total(), kMaxTreeDepth + kMaxLeafTriangles);
}

TEST(Bvh, CopiesWithinOneObjectAreStoredOnce) {
    // Copies at two depths, each with two corner orders, two objects and two sets of flags: 16
    // distinct triangles.
    std::vector<Triangle> triangles;
    for (std::uint32_t i = 0; i < 8000; ++i) {
        Triangle t{{-1, -1, 1},
                   {1, -1, 1},
                   {0, 1, 1},
                   i / 2 % 2,
                   i / 4 % 2 == 0 ? 0 : kHiddenFromCameraFlag};
        if (i % 2 == 0) std::swap(t.a, t.b);
        if (i / 8 % 2 == 0) t.a.z = t.b.z = t.c.z = 2;
        triangles.push_back(t);
    }
    const Bvh bvh = build(triangles);
    expect_valid_bvh(bvh, 16);
    EXPECT_EQ(bvh.copies, triangles.size() - 16);
    EXPECT_EQ(bvh.dropped, 0u);
    for (std::size_t i = 0; i < 16; ++i)
        EXPECT_LT(unpack_number(bvh.triangles[3 * i + 1].w), 16u)
            << "the lowest number of each stays";
    const std::vector<Triangle> few(kMaxLeafTriangles, triangles.front());
    EXPECT_EQ(build(few).copies, 0u) << "a leaf has room for them";
}

TEST(Bvh, LowestNumberWinsAmongCopiesInDifferentLeaves) {
    std::vector<Triangle> triangles = make_divided_octahedron(4);
    const std::vector<Triangle> original = triangles;
    triangles.insert(triangles.end(), original.begin(), original.end());
    const Bvh bvh = build(triangles);
    test::RandomNumbers random(5);
    for (int i = 0; i < 2000; ++i) {
        const auto hit = find_closest_hit<float>(
            bvh, {0.5f * random.random_point_in_cube(), random.random_unit_direction()},
            test::kFloatInfinity);
        ASSERT_TRUE(hit);
        ASSERT_LT(hit->triangle, original.size());
    }
}

/// Splits by cost alone would cut off the largest four octaves of sizes at each level. The tree
/// would then have 62 levels.
TEST(Bvh, DepthIsBoundedForGeometricallyShrinkingTriangles) {
    std::vector<Triangle> triangles;
    for (int i = 0; i < 2000; ++i) {
        const float x = std::ldexp(1.0f, i / 8 - 125) * (1 + 0.1f * static_cast<float>(i % 8));
        triangles.push_back({{x, 0, 0}, {1.1f * x, 0, 0}, {x, 0.1f * x, 0}});
    }
    expect_valid_bvh(build(triangles), triangles.size());
}

template <typename Real>
void expect_equal_to_brute_force(const std::vector<Triangle>& triangles, int rays, unsigned seed) {
    const Bvh bvh = build(triangles);
    test::RandomNumbers random(seed);
    int hits = 0;
    for (int i = 0; i < rays; ++i) {
        const vec3 origin = 2.0f * random.random_point_in_cube();
        // Most rays aim at edges and corners of triangles, which lie on the faces of bounding
        // boxes.
        const Triangle& aim = triangles[random.random_integer_below(triangles.size())];
        const float along = i % 4 == 0 ? 0 : random.random_number_between(0, 1);
        const vec3 target = i % 4 == 1 ? random.random_point_in_cube()
                                       : aim.a + along * (aim.b - aim.a);
        Ray<Real> ray{Vec3<Real>(origin), Vec3<Real>(target - origin)};
        if (i % 8 == 0) ray.direction[i / 8 % 3] = i % 16 == 0 ? Real(0) : Real(-0.0);
        const Real t_max = i % 2 == 0 ? Real(test::kFloatInfinity)
                                      : Real(random.random_number_between(0, 1.5f));
        const auto tree = find_closest_hit<Real>(bvh, ray, t_max);
        const auto all = brute_force_hit<Real>(bvh, ray, t_max);
        ASSERT_EQ(tree, all) << "ray " << i;
        ASSERT_EQ(has_any_hit<Real>(bvh, ray, t_max), all.has_value()) << "ray " << i;
        hits += all ? 1 : 0;
    }
    EXPECT_GT(hits, rays / 10);
}

TEST(ClosestHit, TreeHitsEqualBruteForceHitsBitForBit) {
    expect_equal_to_brute_force<float>(make_random_triangles(500, 6), 10000, 7);
    expect_equal_to_brute_force<double>(make_random_triangles(500, 6), 5000, 8);
    expect_equal_to_brute_force<float>(make_divided_octahedron(3), 10000, 9);
}

/// Triangles without shadows are out of the way of shadow rays. No other hit changes.
TEST(ClosestHit, ShadowRaysDoNotWalkTrianglesWithoutShadows) {
    std::vector<Triangle> triangles = make_random_triangles(500, 6);
    for (std::size_t i = 0; i < 90; ++i) triangles[5 * i].flags = kCastsNoShadowFlag;
    std::vector<Triangle> casters = triangles;
    std::erase_if(casters, [](const Triangle& t) { return t.flags != 0; });
    const Bvh bvh = build(triangles), only_casters = build(casters);
    test::RandomNumbers random(17);
    std::size_t blocked = 0;
    for (int i = 0; i < 5000; ++i) {
        const Ray<float> ray{2.0f * random.random_point_in_cube(), random.random_unit_direction()};
        TraversalCounters steps, steps_of_casters;
        const bool is_blocked = has_any_hit<float>(bvh, ray, 2, kCastsNoShadowFlag, &steps);
        ASSERT_EQ(is_blocked,
                  has_any_hit<float>(only_casters, ray, 2, kCastsNoShadowFlag, &steps_of_casters));
        ASSERT_TRUE(is_blocked || steps.total() == steps_of_casters.total()) << "the same tree";
        for (const std::uint32_t skipped : {0u, kCastsNoShadowFlag})
            ASSERT_EQ(find_closest_hit<float>(bvh, ray, test::kFloatInfinity, skipped),
                      brute_force_hit<float>(bvh, ray, test::kFloatInfinity, skipped));
        blocked += is_blocked ? 1 : 0;
    }
    EXPECT_GT(blocked, 100u);
}

/// Rays pass close to a very long edge. There, rounding errors of the triangle test exceed those of
/// the box test. Without the slack in make_box_ray, boxes would cull half of these hits.
TEST(ClosestHit, HitsBesideLongEdgesAreNotCulledByBoxes) {
    test::RandomNumbers random(21);
    int hits = 0;
    for (int i = 0; i < 20000; ++i) {
        const float length = i % 2 == 0 ? 100 : 1e4f;
        const vec2 edge(random.random_number_between(-1, 1), random.random_number_between(-1, 1));
        Triangle t;
        t.a = vec3(edge, -length * random.random_number_between(0, 1));
        t.b = vec3(edge, length * random.random_number_between(0, 1));
        t.c = vec3(edge, 0) + 0.5f * (random.random_point_in_cube() + vec3(1));
        const vec3 origin = vec3(edge, 0) + vec3(random.random_number_between(0, 1),
                                                 -random.random_number_between(0, 1), 0);
        const vec3 target(edge.x - length * random.random_number_between(0, 1e-7f), edge.y,
                          random.random_number_between(1, 3));
        const Bvh bvh = build(std::span(&t, 1));
        const Ray<float> ray{origin, target - origin};
        const auto expected = brute_force_hit<float>(bvh, ray, test::kFloatInfinity);
        ASSERT_EQ(find_closest_hit<float>(bvh, ray, test::kFloatInfinity), expected) << i;
        hits += expected ? 1 : 0;
    }
    EXPECT_GT(hits, 200);
}

TEST(ClosestHit, FloatHitsAgreeWithDoubleHits) {
    const Bvh bvh = build(make_divided_octahedron(4));
    test::RandomNumbers random(10);
    for (int i = 0; i < 20000; ++i) {
        const vec3 origin = 0.5f * random.random_point_in_cube(),
                   direction = random.random_unit_direction();
        const auto single = find_closest_hit<float>(bvh, {origin, direction}, test::kFloatInfinity);
        const auto precise_hit = find_closest_hit<double>(bvh, {dvec3(origin), dvec3(direction)},
                                                          test::kFloatInfinity);
        ASSERT_TRUE(single && precise_hit);
        ASSERT_NEAR(single->t, precise_hit->t, 4e-6);
        const vec3& b = single->barycentric;
        const bool clear_of_edges = std::min({b.x, b.y, b.z}) > 1e-4f;
        ASSERT_TRUE(!clear_of_edges || single->triangle == precise_hit->triangle);
    }
}

/// Counts the rays that miss a closed mesh although they start inside. Each ray aims at a corner or
/// at a point of a random edge.
int count_rays_leaking_from_mesh(float scale, vec3 offset, int rays, unsigned seed) {
    const std::vector<Triangle> triangles = make_divided_octahedron(4, scale, offset);
    const Bvh bvh = build(triangles);
    test::RandomNumbers random(seed);
    int result = 0;
    for (int i = 0; i < rays; ++i) {
        const Triangle& t = triangles[random.random_integer_below(triangles.size())];
        const vec3 target = i % 4 == 0 ? t.a
                                       : t.a + random.random_number_between(0, 1) * (t.b - t.a);
        const vec3 origin = offset + 0.4f * scale * random.random_point_in_cube();
        if (!find_closest_hit<float>(bvh, {origin, target - origin}, test::kFloatInfinity))
            ++result;
    }
    return result;
}

TEST(ClosestHit, RaysFromInsideAClosedMeshAlwaysHit) {
    EXPECT_EQ(count_rays_leaking_from_mesh(1, vec3(0), 100000, 11), 0);
    EXPECT_EQ(count_rays_leaking_from_mesh(1e-4f, vec3(0), 20000, 12), 0);
    EXPECT_EQ(count_rays_leaking_from_mesh(1e4f, vec3(0), 20000, 13), 0);
    EXPECT_EQ(count_rays_leaking_from_mesh(100, vec3(148376, 1234, -223423), 20000, 14), 0);
}

TEST(ClosestHit, AxisAlignedRaysFromInsideAClosedMeshAlwaysHit) {
    const std::vector<Triangle> triangles = make_divided_octahedron(3);
    const Bvh bvh = build(triangles);
    for (const Triangle& t : triangles)
        for (int axis = 0; axis < 3; ++axis)
            for (float sign : {-1.0f, 1.0f}) {
                vec3 direction(-0.0f);
                direction[axis] = sign;
                vec3 origin = t.a;
                origin[axis] = 0;
                if (glm::length(origin) > 0.99f) continue;
                ASSERT_TRUE(
                    find_closest_hit<float>(bvh, {origin, direction}, test::kFloatInfinity));
            }
}

TEST(ClosestHit, InvalidRaysMissWithoutVisitingNodes) {
    const Bvh bvh = build(make_divided_octahedron(4));
    test::RandomNumbers random(15);
    for (float bad : {test::kFloatNan, test::kFloatInfinity, -test::kFloatInfinity})
        for (int k = 0; k < 7; ++k) {
            vec3 origin(0), direction = random.random_unit_direction();
            float t_max = test::kFloatInfinity;
            if (k < 3)
                origin[k] = bad;
            else if (k < 6)
                direction[k - 3] = bad;
            else
                t_max = bad;
            if (k == 6 && bad > 0) continue; // t_max = +infinity is valid
            TraversalCounters steps;
            EXPECT_FALSE(find_closest_hit<float>(bvh, {origin, direction}, t_max, 0, &steps));
            EXPECT_FALSE(has_any_hit<float>(bvh, {origin, direction}, t_max));
            EXPECT_FALSE(brute_force_hit<float>(bvh, {origin, direction}, t_max));
            EXPECT_EQ(steps.total(), 0u);
        }
    EXPECT_FALSE(find_closest_hit<float>(bvh, {vec3(0), vec3(0)}, test::kFloatInfinity))
        << "no direction";
    EXPECT_FALSE(find_closest_hit<float>(bvh, {vec3(0), vec3(1)}, -0.0f));
}

TEST(ClosestHit, ScalingByPowersOfTwoLeavesHitsUnchanged) {
    const std::vector<Triangle> triangles = make_random_triangles(500, 16);
    const Bvh one = build(triangles);
    for (int k : {-20, -7, 13, 20}) {
        const float s = std::ldexp(1.0f, k);
        std::vector<Triangle> scaled = triangles;
        for (Triangle& t : scaled) t.a *= s, t.b *= s, t.c *= s;
        const Bvh other = build(scaled);
        test::RandomNumbers random(17);
        for (int i = 0; i < 2000; ++i) {
            const vec3 origin = 2.0f * random.random_point_in_cube(),
                       direction = random.random_unit_direction();
            const auto a = find_closest_hit<float>(one, {origin, direction}, test::kFloatInfinity);
            const auto b = find_closest_hit<float>(other, {s * origin, direction},
                                                   test::kFloatInfinity);
            ASSERT_EQ(a.has_value(), b.has_value());
            if (!a) continue;
            ASSERT_EQ(a->triangle, b->triangle);
            ASSERT_EQ(a->t * s, b->t);
        }
    }
}

/// The coordinates of corners range from 1e-8 to 1e8, so that most triangles are slivers.
TEST(ClosestHit, SpawnedRaysMissTheTriangleTheyLeave) {
    test::RandomNumbers random(19);
    const auto wide = [&] {
        return random.random_number_between(-1, 1) < 0
                   ? -std::pow(10.0f, random.random_number_between(-8, 8))
                   : std::pow(10.0f, random.random_number_between(-8, 8));
    };
    for (int i = 0; i < 100; ++i) {
        Triangle t;
        for (vec3* corner : {&t.a, &t.b, &t.c})
            for (int k = 0; k < 3; ++k) (*corner)[k] = wide();
        const Bvh bvh = build(std::span(&t, 1));
        for (int k = 0; k < 100; ++k) {
            const float s = std::sqrt(random.random_number_between(0, 1)),
                        r = random.random_number_between(0, 1);
            vec3 error;
            const vec3 p = f32::triangle_hit_point(t.a, t.b, t.c, {1 - s, s * (1 - r), s * r},
                                                   error);
            const vec3 direction = random.random_unit_direction();
            const vec3 n = f32::facet_normal(t.a, t.b, t.c);
            const Ray<float> ray{f32::ray_spawn_origin(p, error, n, direction), direction, 1};
            ASSERT_FALSE(find_closest_hit<float>(bvh, ray, test::kFloatInfinity));
        }
    }
}

/// A ray spawned at a facet of a ball and directed inwards crosses the ball. The ray hits no facet
/// close to its origin.
TEST(ClosestHit, RaysSpawnedInsideABallCrossTheBall) {
    for (float scale : {1e-3f, 1.0f, 1e3f}) {
        const std::vector<Triangle> triangles = make_divided_octahedron(3, scale,
                                                                        vec3(2, 3, 5) * scale);
        const Bvh bvh = build(triangles);
        test::RandomNumbers random(20);
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            const auto& [a, b, c, object, flags] = triangles[i];
            vec3 error;
            const vec3 p = f32::triangle_hit_point(a, b, c, vec3(1.0f / 3), error);
            const vec3 inward = vec3(2, 3, 5) * scale - p;
            const vec3 direction = glm::normalize(inward +
                                                  0.5f * scale * random.random_unit_direction());
            const vec3 origin = f32::ray_spawn_origin(p, error, f32::facet_normal(a, b, c),
                                                      direction);
            const auto hit = find_closest_hit<float>(bvh, {origin, direction, 0},
                                                     test::kFloatInfinity);
            ASSERT_TRUE(hit);
            ASSERT_GT(hit->t, scale);
        }
    }
}

TEST(Refit, RefitWithoutMovementChangesNothing) {
    for (const Bounds<float>& core : {Bounds<float>{}, Bounds<float>{vec3(-.5f), vec3(.3f)}}) {
        std::vector<Triangle> triangles = make_random_triangles(500, 3);
        triangles[7].b.y = test::kFloatNan;
        const Bvh built = build(triangles, core);
        Bvh refitted = built;
        triangles[7] = triangles[8]; // triangle 7 was dropped at build, so refit ignores it
        refit(refitted, triangles, core);
        EXPECT_TRUE(have_equal_bytes(built.nodes, refitted.nodes));
        EXPECT_TRUE(have_equal_bytes(built.triangles, refitted.triangles));
    }
}

/// Hits in a tree after repeated refits equal the hits in a newly built tree bit for bit. This also
/// holds for coincident triangles.
TEST(Refit, HitsEqualThoseOfANewlyBuiltTree) {
    test::RandomNumbers random(21);
    std::vector<Triangle> triangles = make_divided_octahedron(3);
    const std::size_t room = triangles.size();
    for (const Triangle& t : make_random_triangles(400, 4)) triangles.push_back(t);
    for (std::size_t i = 0; i < 50; ++i)
        triangles.push_back(triangles[room + i]); // coincident copies
    Bvh refitted = build(triangles);
    std::size_t found = 0;
    for (int step = 0; step < 6; ++step) {
        const vec3 move = random.random_point_in_cube();
        for (std::size_t i = 0; i < room; ++i)
            for (vec3* corner : {&triangles[i].a, &triangles[i].b, &triangles[i].c})
                *corner += move;
        refit(refitted, triangles);
        const Bvh rebuilt = build(triangles);
        for (int k = 0; k < 3000; ++k) {
            const Triangle& aim = triangles[random.random_integer_below(triangles.size())];
            const vec3 origin = 2.0f * random.random_point_in_cube();
            const Ray<float> ray{origin, (k % 2 ? aim.a : (aim.a + aim.b) * 0.5f) - origin, 0};
            const auto hit = find_closest_hit<float>(refitted, ray, test::kFloatInfinity),
                       wanted = find_closest_hit<float>(rebuilt, ray, test::kFloatInfinity);
            ASSERT_EQ(hit.has_value(), wanted.has_value());
            if (!hit) continue;
            ++found;
            ASSERT_EQ(hit->t, wanted->t);
            ASSERT_EQ(hit->triangle, wanted->triangle);
            ASSERT_EQ(hit->barycentric, wanted->barycentric);
        }
    }
    EXPECT_GT(found, 15000u);
}

/// Returns the smallest range of stored triangle data that contains all differences between two
/// trees.
IndexRange find_changed_range(const Bvh& before, const Bvh& after) {
    IndexRange run;
    for (std::size_t i = 0; i < after.triangles.size(); i += 3)
        if (std::memcmp(&before.triangles[i], &after.triangles[i], 3 * sizeof(vec4)) != 0)
            run = {run.end == 0 ? i : run.first, i + 3};
    return run;
}

/// A refit of only the boxes around moved triangles gives the same bytes as a refit of all boxes.
/// Another core in between forces the refit of all boxes.
TEST(Refit, PartialRefitEqualsFullRefit) {
    for (const Bounds<float>& core : {Bounds<float>{}, Bounds<float>{vec3(-.5f), vec3(.3f)}}) {
        std::vector<Triangle> triangles = make_random_triangles(500, 6);
        for (std::size_t i = 0; i < triangles.size(); ++i)
            triangles[i].object = i >= 80 && i < 150 ? 1 : 0;
        Bvh few = build(triangles, core), all = few;
        const RefitRegion reach = find_refit_region(few, std::vector<char>{0, 1});
        EXPECT_LT(reach.boxes.size(), count_nodes(few)) << "half of them";
        test::RandomNumbers random(23);
        for (int step = 0; step < 5; ++step) {
            for (std::size_t i = 100; i < 140; ++i) triangles[i].b += random.random_point_in_cube();
            triangles[90].a =
                -triangles[90].a; // a zero that changes its sign counts as a move, too
            const auto run = refit(few, triangles, core, &reach);
            EXPECT_EQ(run, find_changed_range(all, few));
            std::vector<Triangle> elsewhere = triangles;
            for (Triangle& t : elsewhere) t.a += vec3(1), t.b += vec3(1), t.c += vec3(1);
            refit(all, elsewhere, {vec3(-9), vec3(9)});
            refit(all, triangles, core);
            ASSERT_TRUE(have_equal_bytes(few.nodes, all.nodes)) << step;
            ASSERT_TRUE(have_equal_bytes(few.triangles, all.triangles)) << step;
            for (const Bvh* tree : {&few, &all})
                EXPECT_NEAR(tree->cost, sah_cost(*tree), 1e-12 * sah_cost(*tree)) << step;
        }
    }
}

TEST(Refit, CostRisesIfNeighbouringTrianglesMoveApart) {
    std::vector<Triangle> triangles = make_random_triangles(500, 5);
    Bvh tree = build(triangles);
    const double before = sah_cost(tree);
    test::RandomNumbers random(22);
    for (Triangle& t : triangles) {
        const vec3 move = 2.0f * random.random_point_in_cube();
        t.a += move, t.b += move, t.c += move;
    }
    refit(tree, triangles);
    EXPECT_GT(sah_cost(tree), 2 * before);
    EXPECT_LT(sah_cost(build(triangles)), .5 * sah_cost(tree));
}

TEST(ClosestHit, RaysVisitFewNodes) {
    const Bvh bvh = build(make_divided_octahedron(5)); // the ball has 8192 triangles
    test::RandomNumbers random(18);
    std::size_t total = 0;
    for (int i = 0; i < 1000; ++i) {
        TraversalCounters steps;
        find_closest_hit<float>(
            bvh, {0.5f * random.random_point_in_cube(), random.random_unit_direction()},
            test::kFloatInfinity, 0, &steps);
        total += steps.total();
    }
    EXPECT_LT(total / 1000, 60u);
}

} // namespace
} // namespace catoptric::bvh
