// What one pixel covers after reflection, against two rays that are followed, and the edges it asks
// for.
#include "render/footprint.hpp"
#include "scene/shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace {

using namespace catoptric;
using namespace catoptric::render;

const double kPixel = pixel_angle(37.5, 512); ///< of the contract's camera

/// Where a ray from the origin with this angle to +x goes on after a circle of radius |r| about
/// (centre, 0), as an angle; r < 0: the circle's far side, a hollow mirror.
double onward(double centre, double r, double angle) {
    const dvec3 d(std::cos(angle), std::sin(angle), 0), c(centre, 0, 0);
    const double along = dot(c, d), half = std::sqrt(r * r - dot(c, c) + along * along);
    const dvec3 n = glm::normalize(d * (r > 0 ? along - half : along + half) - c);
    const dvec3 out = glm::reflect(d, n);
    return std::atan2(out.y, out.x);
}

TEST(Footprint, IsTheAngleBetweenTwoRaysThatWereFollowed) {
    constexpr double kCentre = 10, kTiny = 1e-7;
    for (const double r : {.5, 3.0, -.5, -3.0})
        for (const double share : {.0, .4, .8}) { // of the way to the rim
            const double angle = std::asin(share * std::abs(r) / kCentre);
            const double cosine = std::sqrt(1 - share * share);
            const double distance = kCentre * std::cos(angle) - r * cosine;
            double spread = std::abs(onward(kCentre, r, angle + kTiny) - onward(kCentre, r, angle));
            spread = std::min(spread, 2 * std::numbers::pi - spread);
            EXPECT_NEAR(reflected_footprint(kTiny, distance, 1 / r, cosine) / spread, 1, 1e-5)
                << "r " << r << ", share " << share;
        }
}

TEST(Footprint, OfAFlatOrFocusingMirrorIsThePixel) {
    EXPECT_EQ(reflected_footprint(kPixel, 1e9, 0, 1e-9), kPixel);
    EXPECT_EQ(reflected_footprint(kPixel, 1, -.5, 1),
              kPixel); // the eye in the focus of a hollow mirror
    EXPECT_EQ(reflected_footprint(kPixel, 0, 5, 1), kPixel); // the eye on the mirror
}

TEST(Footprint, KnownEdges) {
    const double at_600 = pixel_angle(37.5, 600);
    EXPECT_NEAR(at_600, 1.0908e-3, 1e-7);
    EXPECT_NEAR(face_need(at_600), 1440, 1e-9); // a flat mirror
    const double distance = glm::distance(dvec3(278, 273, -800), dvec3(190, 113, 410));
    EXPECT_NEAR(sphere_need(at_600, distance, 110), 67.8, .05); // ball 3 of the built-in scene
    EXPECT_NEAR(sphere_need(kPixel, distance, 110), 57.8, .05);
    EXPECT_EQ(sphere_need(kPixel, 50, 110), face_need(kPixel)); // from inside
}

struct Mirror {
    std::vector<shared::Vertex> vertices;
    std::vector<std::uint32_t> indices;
    double need(const vec3& eye) const { return mesh_need(kPixel, eye, vertices, indices); }
};

/// The triangles of a mesh, each corner moulded to a place and a normal.
Mirror mirror_of(const scene::Mesh& mesh,
                 const std::function<shared::Vertex(const dvec3&)>& moulded) {
    Mirror mirror;
    for (const dvec3& position : mesh.positions) mirror.vertices.push_back(moulded(position));
    for (const uvec3& triangle : mesh.triangles)
        for (int j = 0; j < 3; ++j) mirror.indices.push_back(triangle[j]);
    return mirror;
}

TEST(Footprint, AMeshNeedsWhatItsSphereNeeds) {
    constexpr double kRadius = .2;
    const dvec3 centre(.1, -.2, .3), eye(-1, .4, -.7);
    const Mirror ball = mirror_of(scene::ball("ball", 5), [&](const dvec3& p) {
        return shared::Vertex{vec3(centre + kRadius * p), vec3(p)};
    });
    // The facet next to the eye is met at up to half its width, of about a twentieth of the radius.
    const double wanted = sphere_need(kPixel, glm::distance(centre, eye), kRadius);
    EXPECT_NEAR(ball.need(vec3(eye)), wanted, .01 * wanted);
}

TEST(Footprint, ACylinderNeedsWhatItsStraightLinesNeed) {
    // Facets of a plane, bent: corners along and across its axis, and diagonals.
    scene::Mesh plane{.name = "plane"};
    for (int i = 0; i <= 8; ++i)
        for (int j = 0; j <= 8; ++j) plane.positions.emplace_back(.1 * i - .4, .1 * j - .4, 0);
    for (std::uint32_t i = 0; i < 8; ++i)
        for (std::uint32_t j = 0; j < 8; ++j) {
            const std::uint32_t k = 9 * i + j;
            plane.triangles.insert(plane.triangles.end(), {{k, k + 9, k + 10}, {k, k + 10, k + 1}});
        }
    const auto bent = [](const dvec3& p) {
        const vec3 n(static_cast<float>(std::sin(p.x)), 0, static_cast<float>(std::cos(p.x)));
        return shared::Vertex{n + vec3(0, static_cast<float>(p.y), 0), n};
    };
    const vec3 eye(0, 0, 5);
    EXPECT_NEAR(mirror_of(plane, bent).need(eye), face_need(kPixel), .001 * face_need(kPixel));
    const auto flat = [](const dvec3& p) { return shared::Vertex{vec3(p), vec3(0, 0, 1)}; };
    EXPECT_EQ(mirror_of(plane, flat).need(eye), face_need(kPixel));
    EXPECT_EQ(mirror_of(plane, flat).need(-eye), face_need(kPixel));
    const auto nothing = [](const dvec3&) { return shared::Vertex{vec3(1), vec3(0, 0, 1)}; };
    EXPECT_EQ(mirror_of(plane, nothing).need(eye), 0);
}

TEST(Footprint, OneEdgeHoldsEveryNeed) {
    const auto edge = [](const std::vector<double>& needs) { return common_edge(needs, 16384); };
    EXPECT_EQ(edge({}), 16u);
    EXPECT_EQ(edge({0}), 16u);
    EXPECT_EQ(edge({16}), 16u);
    EXPECT_EQ(edge({16.01, 3}), 32u);
    EXPECT_EQ(edge({39.7, 48.6, 57.8, 21.4}), 64u);
    EXPECT_EQ(edge({16370}), 16384u);
    EXPECT_EQ(edge({1e30}), 16384u);
    EXPECT_EQ(edge({std::numeric_limits<double>::infinity()}), 16384u);
    EXPECT_EQ(common_edge(std::vector<double>{90}, 100), 96u);
    EXPECT_EQ(common_edge(std::vector<double>{97}, 100), 100u);
}

} // namespace
