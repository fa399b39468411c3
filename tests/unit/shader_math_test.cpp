#include "core/shader_math.hpp"
#include "support/numbers.hpp"
#include "support/special_values.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace catoptric {
namespace {

::testing::AssertionResult are_vectors_near(const vec3& a, const vec3& b, float tolerance) {
    if (glm::length(a - b) <= tolerance) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure()
           << a.x << ' ' << a.y << ' ' << a.z << " is not " << b.x << ' ' << b.y << ' ' << b.z;
}

struct TriangleTestHit {
    bool hit;
    float t;
    vec3 weights;
};

TriangleTestHit intersect_test_triangle(vec3 a, vec3 b, vec3 c, vec3 origin, vec3 direction) {
    TriangleTestHit result{};
    result.hit = f32::intersect_triangle_watertight(a, b, c, origin, f32::make_ray_shear(direction),
                                                    result.t, result.weights);
    return result;
}

// ---- Light

TEST(Light, LightTermMatchesAHandComputedPoint) {
    // The light is at height 2 and faces down. The direction to the point is at 45 degrees: the
    // squared distance is 8 and both cosines are sqrt(1/2).
    vec3 direction;
    float distance, factor;
    ASSERT_TRUE(f32::compute_point_light_factor(vec3(0), vec3(0, 1, 0), vec3(2, 2, 0),
                                                vec3(0, -1, 0), direction, distance, factor));
    EXPECT_FLOAT_EQ(distance, std::sqrt(8.0f));
    EXPECT_FLOAT_EQ(factor, 1.0f / 16);
    EXPECT_TRUE(are_vectors_near(direction, vec3(std::sqrt(0.5f), std::sqrt(0.5f), 0), 1e-7f));
    // Radiance: emission + albedo / pi * intensity / 16 + albedo * ambient.
    const vec3 direct = vec3(32) * factor;
    const vec3 radiance = f32::lambertian_radiance(vec3(1, 0, 0), vec3(0.5f, 0.25f, 0), direct,
                                                   0.05f);
    EXPECT_FLOAT_EQ(radiance.x, 1 + 1 / f32::kPi + 0.025f);
    EXPECT_FLOAT_EQ(radiance.y, 0.5f / f32::kPi + 0.0125f);
    EXPECT_EQ(radiance.z, 0);
}

TEST(Light, LightWithoutNormalHasNoCosineAtTheLight) {
    vec3 direction;
    float distance, factor;
    ASSERT_TRUE(f32::compute_point_light_factor(vec3(0), vec3(0, 1, 0), vec3(2, 2, 0), vec3(0),
                                                direction, distance, factor));
    EXPECT_FLOAT_EQ(factor, std::sqrt(0.5f) / 8);
}

TEST(Light, LightNeedsNoShadowRayIfACosineIsNotPositive) {
    vec3 direction;
    float distance, factor;
    const auto lit = [&](vec3 normal, vec3 light, vec3 light_normal) {
        const bool result = f32::compute_point_light_factor(vec3(0), normal, light, light_normal,
                                                            direction, distance, factor);
        EXPECT_EQ(result, factor > 0);
        return result;
    };
    EXPECT_FALSE(lit(vec3(0, -1, 0), vec3(0, 2, 0), vec3(0, -1, 0))) << "surface faces away";
    EXPECT_FALSE(lit(vec3(0, 1, 0), vec3(0, 2, 0), vec3(0, 1, 0))) << "light faces away";
    EXPECT_FALSE(lit(vec3(0, 1, 0), vec3(2, 0, 0), vec3(-1, 0, 0))) << "grazing, cosine 0";
    EXPECT_FALSE(lit(vec3(0, 1, 0), vec3(0), vec3(0))) << "light at the point";
    EXPECT_FALSE(lit(vec3(test::kFloatNan), vec3(0, 2, 0), vec3(0)));
    EXPECT_FALSE(lit(vec3(0, 1, 0), vec3(test::kFloatNan), vec3(0)));
    EXPECT_FALSE(lit(vec3(0, 1, 0), vec3(test::kFloatInfinity), vec3(0)));
}

TEST(Light, MeanCosineIsTheSameForOppositeDirections) {
    const vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    const vec3 direction = glm::normalize(vec3(.3f, -.5f, .2f));
    EXPECT_FLOAT_EQ(f32::mean_lamp_facet_cosine(direction, x, y, z, vec3(0, 0, 1)), direction.z);
    EXPECT_FLOAT_EQ(f32::mean_lamp_facet_cosine(-direction, x, y, z, vec3(0, 0, 1)), direction.z);
    EXPECT_FLOAT_EQ(f32::mean_lamp_facet_cosine(direction, x, y, z, vec3(.5f)), .5f);
}

TEST(Light, FacetReceivesNoLightFromBelowItsPlane) {
    const vec3 normal = glm::normalize(vec3(1, 1, 0));
    for (const float size : {1.0f, -1.0f, 1e-6f, 1e6f}) {
        const auto share = [&](double degrees) {
            const double angle = glm::radians(degrees);
            return f32::facet_light_share(vec3(std::cos(angle), std::sin(angle), 0), normal,
                                          vec3(0, size, 0));
        };
        EXPECT_EQ(share(-40), 0);
        EXPECT_EQ(share(-.001), 0);
        EXPECT_NEAR(share(3), .5, .01);
        EXPECT_EQ(share(6.001), 1);
        EXPECT_EQ(share(90), 1);
        // If the shading normal equals the facet's normal, the share is 1 even at grazing angles.
        const vec3 up(0, 1, 0), grazing = glm::normalize(vec3(1, .01f, 0));
        EXPECT_NEAR(f32::facet_light_share(grazing, up, size * up), 1, 1e-5);
    }
}

TEST(Light, MeanFacetShareIsThatOfAnIntegral) {
    constexpr int kSteps = 400;
    for (const double degrees : {1.0, 4.0, 7.0, 15.0, 30.0, 60.0, 80.0}) {
        const double angle = glm::radians(degrees);
        const dvec3 facet(std::sin(angle), 0, std::cos(angle));
        double sum = 0;
        for (int i = 0; i < kSteps; ++i)
            for (int j = 0; j < kSteps; ++j) { // density cosine / pi around the z axis
                const double radius = std::sqrt((i + .5) / kSteps),
                             turn = 2 * std::numbers::pi * (j + .5) / kSteps;
                sum += f64::facet_light_share({radius * std::cos(turn), radius * std::sin(turn),
                                               std::sqrt(1 - radius * radius)},
                                              {0, 0, 1}, facet);
            }
        EXPECT_NEAR(f64::mean_facet_light_share(std::cos(angle)), sum / (kSteps * kSteps), .0005)
            << degrees;
    }
    EXPECT_EQ(f64::mean_facet_light_share(1.0), 1);
}

TEST(Mirror, MirrorDirectionIgnoresTheSignOfTheNormal) {
    const vec3 d = glm::normalize(vec3(1, -1, 0));
    const vec3 expected = glm::normalize(vec3(1, 1, 0));
    EXPECT_TRUE(are_vectors_near(f32::reflect_above_facet(d, vec3(0, 1, 0), vec3(0, 1, 0)),
                                 expected, 1e-6f));
    EXPECT_TRUE(are_vectors_near(f32::reflect_above_facet(d, vec3(0, -1, 0), vec3(0, -1, 0)),
                                 expected, 1e-6f));
}

TEST(Mirror, MirrorDirectionNeverPointsBelowTheFacet) {
    test::RandomNumbers random(1);
    for (int i = 0; i < 10000; ++i) {
        const vec3 d = random.random_unit_direction(), n_geometric = random.random_unit_direction();
        const vec3 n_shading = glm::normalize(n_geometric + 0.9f * random.random_unit_direction());
        const vec3 r = f32::reflect_above_facet(d, n_shading, n_geometric);
        ASSERT_GE(glm::dot(r, n_geometric) * -glm::dot(d, n_geometric), -1e-6f);
        ASSERT_NEAR(glm::length(r), 1, 1e-6f);
    }
}

// ---- Triangles

TEST(TriangleTest, TriangleTestMatchesAKnownHit) {
    const auto [hit, t, weights] = intersect_test_triangle({0, 0, 2}, {4, 0, 2}, {0, 4, 2},
                                                           {1, 2, 0}, {0, 0, 0.5f});
    ASSERT_TRUE(hit);
    EXPECT_EQ(t, 4);
    EXPECT_TRUE(
        are_vectors_near(f32::normalise_barycentric(weights), vec3(0.25f, 0.25f, 0.5f), 1e-7f));
}

TEST(TriangleTest, TriangleTestMissesTrianglesBehindBesideOrWithoutArea) {
    const vec3 a(0, 0, 2), b(4, 0, 2), c(0, 4, 2);
    EXPECT_FALSE(intersect_test_triangle(a, b, c, {1, 1, 0}, {0, 0, -1}).hit) << "behind";
    EXPECT_FALSE(intersect_test_triangle(a, b, c, {1, 1, 2}, {0, 0, 1}).hit) << "starts on it";
    EXPECT_FALSE(intersect_test_triangle(a, b, c, {3, 3, 0}, {0, 0, 1}).hit) << "beside";
    EXPECT_FALSE(intersect_test_triangle(a, b, c, {1, 1, 2}, {1, 0, 0}).hit) << "in its plane";
    EXPECT_FALSE(intersect_test_triangle(a, b, b, {1, 0, 0}, {0, 0, 1}).hit) << "no area";
    EXPECT_FALSE(intersect_test_triangle(a, a, a, {0, 0, 0}, {0, 0, 1}).hit) << "a point";
}

TEST(TriangleTest, TriangleTestMissesIfACoordinateIsNan) {
    const vec3 a(0, 0, 2), b(4, 0, 2), c(0, 4, 2);
    for (int i = 0; i < 3; ++i) {
        vec3 bad(0.5f);
        bad[i] = test::kFloatNan;
        EXPECT_FALSE(intersect_test_triangle(bad, b, c, {1, 1, 0}, {0, 0, 1}).hit);
        EXPECT_FALSE(intersect_test_triangle(a, b, bad, {1, 1, 0}, {0, 0, 1}).hit);
        EXPECT_FALSE(intersect_test_triangle(a, b, c, bad, {0, 0, 1}).hit);
        EXPECT_FALSE(intersect_test_triangle(a, b, c, {1, 1, 0}, bad).hit);
    }
    EXPECT_FALSE(intersect_test_triangle(a, b, c, {1, 1, 0}, vec3(0)).hit);
}

TEST(TriangleTest, FloatTriangleTestAgreesWithDouble) {
    test::RandomNumbers random(2);
    int hits = 0, disagreements = 0;
    for (int i = 0; i < 100000; ++i) {
        const vec3 a = random.random_point_in_cube(), b = random.random_point_in_cube(),
                   c = random.random_point_in_cube();
        const vec3 origin = 3.0f * random.random_unit_direction();
        const vec3 direction = glm::normalize(0.5f * random.random_point_in_cube() - origin);
        const TriangleTestHit single = intersect_test_triangle(a, b, c, origin, direction);
        double t;
        dvec3 weights;
        const bool hit = f64::intersect_triangle_watertight(
            dvec3(a), dvec3(b), dvec3(c), dvec3(origin), f64::make_ray_shear(dvec3(direction)), t,
            weights);
        if (hit != single.hit) {
            // Float and double may disagree only where the ray passes within rounding errors of an
            // edge.
            const dvec3 size = glm::abs(f64::normalise_barycentric(weights));
            EXPECT_LT(std::min({size.x, size.y, size.z}), 1e-3);
            ++disagreements;
        } else if (hit) {
            ++hits;
            // Rounding the sheared corners moves the hit by about 8 u * 4 across the ray, where u =
            // 6e-8 is the unit roundoff. Along the ray, this error is divided by the cosine.
            const vec3 n = f32::facet_normal(a, b, c);
            const double slack = 32 * 6e-8 / std::abs(double{glm::dot(n, direction)});
            ASSERT_NEAR(single.t, t, slack);
        }
    }
    EXPECT_GT(hits, 2000);
    EXPECT_LT(disagreements, 5);
}

TEST(TriangleTest, EdgeFunctionHasTheExactSign) {
    // A long double has 64 mantissa bits, so the product of two 24-bit floats is exact.
    test::RandomNumbers random(3);
    int fallbacks = 0;
    for (int i = 0; i < 200000; ++i) {
        const float a = random.random_number_between(0.5f, 1),
                    b = random.random_number_between(0.5f, 1);
        const float c = std::nextafter(a, random.random_number_between(0, 2));
        const float d = static_cast<float>(static_cast<long double>(a) * b / c);
        const long double exact = static_cast<long double>(a) * b - static_cast<long double>(c) * d;
        const float found = f32::exact_product_difference(a, b, c, d);
        ASSERT_EQ(found > 0, exact > 0);
        ASSERT_EQ(found < 0, exact < 0);
        ASSERT_EQ(f32::exact_product_difference(c, d, a, b), -found)
            << "the neighbour sees the opposite";
        const volatile float ab = a * b, cd = c * d;
        if (ab == cd && exact != 0) ++fallbacks;
    }
    EXPECT_GT(fallbacks, 10000) << "the seed must reach the case that is tested";
}

TEST(TriangleTest, TriangleTestIsUnchangedByScalingWithPowersOfTwo) {
    test::RandomNumbers random(4);
    for (int i = 0; i < 2000; ++i) {
        const vec3 a = random.random_point_in_cube(), b = random.random_point_in_cube(),
                   c = random.random_point_in_cube();
        const vec3 origin = 3.0f * random.random_unit_direction(),
                   direction = 0.5f * random.random_point_in_cube() - origin;
        const TriangleTestHit one = intersect_test_triangle(a, b, c, origin, direction);
        for (int k = -20; k <= 20; k += 5) {
            const float s = std::ldexp(1.0f, k);
            const TriangleTestHit scaled = intersect_test_triangle(s * a, s * b, s * c, s * origin,
                                                                   direction);
            ASSERT_EQ(one.hit, scaled.hit);
            ASSERT_TRUE(!one.hit || one.t * s == scaled.t);
        }
    }
}

// ---- Boxes and spheres

bool does_ray_hit_box(vec3 lo, vec3 hi, vec3 origin, vec3 direction,
                      float t_max = test::kFloatInfinity) {
    float t;
    const f32::BoxTestRay ray = f32::make_box_ray({origin, direction}, vec3(-1), vec3(1), 1);
    return f32::intersect_box_slabs(lo, hi, ray, t_max, t);
}

TEST(SlabTest, SlabTestHitsAndMissesKnownBoxes) {
    const vec3 lo(-1), hi(1);
    EXPECT_TRUE(does_ray_hit_box(lo, hi, {-5, 0, 0}, {1, 0, 0}));
    EXPECT_TRUE(does_ray_hit_box(lo, hi, {0, 0, 0}, {0, -1, 0})) << "from inside";
    EXPECT_FALSE(does_ray_hit_box(lo, hi, {-5, 0, 0}, {-1, 0, 0})) << "behind";
    EXPECT_FALSE(does_ray_hit_box(lo, hi, {-5, 2, 0}, {1, 0, 0}))
        << "beside, parallel to two slabs";
    EXPECT_FALSE(does_ray_hit_box(lo, hi, {-5, 2, 0}, {1, -0.0f, -0.0f}));
    EXPECT_FALSE(does_ray_hit_box(lo, hi, {-5, 0, 0}, {1, 0, 0}, 3.9f)) << "beyond t_max";
    EXPECT_TRUE(does_ray_hit_box(lo, hi, {-5, 1, -1}, {1, 0, -0.0f})) << "along an edge: 0 * inf";
    EXPECT_TRUE(does_ray_hit_box({-1, 0, -1}, {1, 0, 1}, {0, 5, 0}, {0, -1, 0})) << "flat box";
    EXPECT_FALSE(does_ray_hit_box(vec3(test::kFloatInfinity), vec3(-test::kFloatInfinity), vec3(0),
                                  {1, 0, 0}))
        << "empty box";
}

TEST(SlabTest, SlabTestHitsASmallBoxFarAway) {
    for (float distance : {10.0f, 100.0f, 1000.0f})
        EXPECT_TRUE(does_ray_hit_box(vec3(-5e-4f), vec3(5e-4f), {-distance, 0, 0}, {1, 0, 0}));
}

TEST(SphereTest, SphereTestWorksFromOutsideInsideAndBehind) {
    float t;
    EXPECT_TRUE(f32::intersect_sphere_robustly(vec3(0), 1, {{-3, 0, 0}, {1, 0, 0}}, 10, t));
    EXPECT_FLOAT_EQ(t, 2);
    EXPECT_TRUE(f32::intersect_sphere_robustly(vec3(0), 1, {{-3, 0, 0}, {2, 0, 0}}, 10, t));
    EXPECT_FLOAT_EQ(t, 1);
    EXPECT_TRUE(f32::intersect_sphere_robustly(vec3(0), 1, {{0.5f, 0, 0}, {1, 0, 0}}, 10, t));
    EXPECT_FLOAT_EQ(t, 0.5f);
    EXPECT_TRUE(f32::intersect_sphere_robustly(vec3(0), 1, {{0, 0, 0}, {0, 1, 0}}, 10, t));
    EXPECT_FLOAT_EQ(t, 1);
    EXPECT_FALSE(f32::intersect_sphere_robustly(vec3(0), 1, {{3, 0, 0}, {1, 0, 0}}, 10, t));
    EXPECT_FALSE(f32::intersect_sphere_robustly(vec3(0), 1, {{-3, 0, 0}, {1, 0, 0}}, 2, t))
        << "t_max excluded";
    EXPECT_FALSE(f32::intersect_sphere_robustly(vec3(0), 1, {{-3, 1.001f, 0}, {1, 0, 0}}, 10, t));
    EXPECT_FALSE(
        f32::intersect_sphere_robustly(vec3(0), 1, {vec3(test::kFloatNan), {1, 0, 0}}, 10, t));
    EXPECT_FALSE(
        f32::intersect_sphere_robustly(vec3(0), 1, {vec3(0), vec3(test::kFloatNan)}, 10, t));
}

TEST(SphereTest, SphereTestStaysPreciseFarAway) {
    test::RandomNumbers random(5);
    for (int i = 0; i < 10000; ++i) {
        const vec3 origin = 1e4f * random.random_unit_direction();
        const vec3 direction = glm::normalize(0.5f * random.random_unit_direction() - origin);
        float t;
        double exact;
        ASSERT_TRUE(f32::intersect_sphere_robustly(vec3(0), 1, {origin, direction},
                                                   test::kFloatInfinity, t));
        ASSERT_TRUE(f64::intersect_sphere_robustly(dvec3(0), 1, {dvec3(origin), dvec3(direction)},
                                                   1e30, exact));
        // The textbook formula for spheres is off by about 1 here. The ray's origin is known only
        // to u * 1e4 = 6e-4, where u is the unit roundoff.
        ASSERT_NEAR(t, exact, 4e-3);
    }
}

// ---- Spawned rays

// Tests triangles of any shape whose coordinates have sizes of .1 to 10. Rays from thinner
// triangles rely on Ray::leaves, the number of the triangle that a ray must not hit.
TEST(Spawn, SpawnedRayNeverMeetsItsOwnTriangle) {
    test::RandomNumbers random(6);
    for (int i = 0; i < 1000; ++i) {
        const auto corner = [&] {
            return vec3(random.random_log_uniform_number(-1, 1),
                        random.random_log_uniform_number(-1, 1),
                        random.random_log_uniform_number(-1, 1));
        };
        const vec3 a = corner(), b = corner(), c = corner();
        for (int k = 0; k < 100; ++k) {
            const float s = std::sqrt(random.random_number_between(0, 1)),
                        r = random.random_number_between(0, 1);
            vec3 error;
            const vec3 p = f32::triangle_hit_point(a, b, c, {1 - s, s * (1 - r), s * r}, error);
            const vec3 direction = random.random_unit_direction();
            const vec3 origin = f32::ray_spawn_origin(p, error, f32::facet_normal(a, b, c),
                                                      direction);
            ASSERT_FALSE(intersect_test_triangle(a, b, c, origin, direction).hit) << i << ' ' << k;
        }
    }
}

TEST(Spawn, SpawnOffsetStaysWithinRoundingErrors) {
    const vec3 a(10, 10, 10), b(11, 10, 10), c(10, 11, 10);
    vec3 error;
    const vec3 p = f32::triangle_hit_point(a, b, c, vec3(1.0f / 3), error);
    const vec3 origin = f32::ray_spawn_origin(p, error, vec3(0, 0, 1), vec3(0, 0, 1));
    EXPECT_GT(origin.z, 10);
    EXPECT_LT(origin.z, 10 + 16 * 9.6e-7f) << "16 floats at 10";
}

TEST(Spawn, SpawnedRayNeverMeetsItsOwnSphereFromOutside) {
    test::RandomNumbers random(7);
    for (int i = 0; i < 50000; ++i) {
        const vec3 centre = 10.0f * random.random_point_in_cube();
        const float radius = std::abs(random.random_log_uniform_number(-2, 1));
        const f32::Ray ray{centre + 3 * radius * random.random_unit_direction(),
                           random.random_unit_direction()};
        const f32::Ray aimed{ray.origin,
                             centre + 0.99f * radius * random.random_point_in_cube() * 0.57f -
                                 ray.origin};
        float t;
        ASSERT_TRUE(f32::intersect_sphere_robustly(centre, radius, aimed, test::kFloatInfinity, t));
        vec3 error;
        const vec3 p = f32::sphere_hit_point(centre, radius, aimed, t, error);
        const vec3 n = glm::normalize(p - centre);
        vec3 out = ray.direction;
        if (glm::dot(out, n) < 0) out = -out;
        const vec3 origin = f32::ray_spawn_origin(p, error, n, out);
        ASSERT_FALSE(
            f32::intersect_sphere_robustly(centre, radius, {origin, out}, test::kFloatInfinity, t))
            << i;
    }
}

TEST(Spawn, ShadowRaysEndShortOfTheLight) { EXPECT_EQ(f32::kShadowRayEnd, 1 - 0x1p-13f); }

// ---- Captures and picture

TEST(Parallax, ParallaxFindsThePointAtTheCapturedDistance) {
    test::RandomNumbers random(8);
    for (int i = 0; i < 10000; ++i) {
        // Parallax correction is exact if the captured distance is `way + dot(offset, dir)`, where
        // `way` is the distance along the ray. This holds for a plane perpendicular to the ray.
        const vec3 offset = 0.3f * random.random_point_in_cube(),
                   dir = random.random_unit_direction();
        const float way = random.random_number_between(0.5f, 5);
        const vec3 expected = glm::normalize(offset + way * dir);
        const vec3 found = f32::parallax_direction(offset, dir, way + glm::dot(offset, dir));
        ASSERT_TRUE(are_vectors_near(found, expected, 1e-6f));
        const vec3 far = f32::parallax_direction(offset, dir, 1e30f);
        ASSERT_TRUE(are_vectors_near(far, dir, 1e-6f));
    }
}

TEST(Parallax, ParallaxKeepsTheDirectionWithoutAUsableDistance) {
    const vec3 dir(0, 0, 1);
    EXPECT_EQ(f32::parallax_direction(vec3(1), dir, test::kFloatInfinity), dir);
    EXPECT_EQ(f32::parallax_direction(vec3(1), dir, test::kFloatNan), dir);
    EXPECT_EQ(f32::parallax_direction(vec3(0), dir, 0), dir) << "|p| = 0";
    EXPECT_EQ(f32::parallax_direction(vec3(0, 0, 2), dir, 0), dir) << "|p| = 0";
    EXPECT_EQ(f32::parallax_direction(vec3(test::kFloatNan), dir, 1), dir);
    EXPECT_EQ(f32::parallax_direction(vec3(0, 0, 3e38f), -dir, 3e38f), -dir) << "overflow";
}

TEST(CubeFace, CubeFaceCentresAreInVulkansOrder) {
    const vec3 axes[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (int face = 0; face < 6; ++face) {
        EXPECT_EQ(f32::cube_face(axes[face]), face);
        EXPECT_EQ(f32::cube_direction(face, vec3(0, 0, 1)), axes[face]);
    }
    // Face +Z has +X on its right and -Y below.
    EXPECT_EQ(f32::cube_coordinates(4, vec3(0.5f, -0.25f, 1)), vec3(0.5f, 0.25f, 1));
    EXPECT_EQ(f32::cube_face(vec3(1)), 4);
    EXPECT_EQ(f32::cube_face(vec3(1, 1, 0)), 2);
}

TEST(CubeFace, CubeCoordinatesConvertBackToTheSameDirection) {
    test::RandomNumbers random(9);
    for (int i = 0; i < 10000; ++i) {
        const vec3 dir = random.random_unit_direction();
        const int face = f32::cube_face(dir);
        const vec3 coordinates = f32::cube_coordinates(face, dir);
        ASSERT_GT(coordinates.z, 0);
        ASSERT_LE(std::abs(coordinates.x), coordinates.z);
        ASSERT_LE(std::abs(coordinates.y), coordinates.z);
        ASSERT_EQ(f32::cube_direction(face, coordinates), dir);
    }
}

TEST(Srgb, SrgbEncodingMatchesKnownValues) {
    EXPECT_EQ(f32::srgb_from_linear_channel(0), 0);
    EXPECT_EQ(f32::srgb_from_linear_channel(1), 1);
    EXPECT_EQ(f32::srgb_from_linear_channel(7), 1);
    EXPECT_EQ(f32::srgb_from_linear_channel(-1), 0);
    EXPECT_EQ(f32::srgb_from_linear_channel(test::kFloatNan), 0);
    EXPECT_NEAR(f32::srgb_from_linear_channel(0.214041f), 0.5f, 1e-5f);
    EXPECT_FLOAT_EQ(f32::srgb_from_linear_channel(0.002f), 0.02584f);
}

TEST(NextFloat, NextFloatStepsOverZero) {
    EXPECT_GT(f32::next_up(0), 0);
    EXPECT_LT(f32::next_down(0), 0);
    EXPECT_EQ(f32::next_up(1), 1 + 0x1p-23f);
    EXPECT_EQ(f32::next_down(-1), -1 - 0x1p-23f);
}

} // namespace
} // namespace catoptric
