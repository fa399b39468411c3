// Tests of the footprint, which is the angle that one pixel covers after a reflection, and of the
// capture face edges that follow from footprints.
#include "render/footprint.hpp"
#include "render/views.hpp"
#include "scene/build.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace {

using namespace catoptric;
using namespace catoptric::render;

const double kPixelAngleRadians = 2 * std::tan(glm::radians(37.5) / 2) /
                                  512; ///< radians of a pixel at the picture's centre

/// Returns the pixels of a square picture from `eye` towards `target`, with the field of view of
/// the built-in scene's camera.
PixelGrid make_pixel_grid(const dvec3& eye, const dvec3& target, std::uint32_t height = 512) {
    const scene::Camera camera{.eye = eye, .target = target, .vertical_fov_degrees = 37.5};
    return {make_camera_view(camera, SceneUnits{}, uvec2(height), 1), height};
}

/// Returns the direction of a ray, as an angle, after reflection at a circle of radius |r| around
/// (centre, 0). The ray starts at the origin with `angle` to +x. If r < 0, the circle's
/// far side reflects, as a hollow mirror.
double reflected_angle_at_circle(double centre, double r, double angle) {
    const dvec3 d(std::cos(angle), std::sin(angle), 0), c(centre, 0, 0);
    const double along = dot(c, d), half = std::sqrt(r * r - dot(c, c) + along * along);
    const dvec3 n = glm::normalize(d * (r > 0 ? along - half : along + half) - c);
    const dvec3 out = glm::reflect(d, n);
    return std::atan2(out.y, out.x);
}

TEST(Footprint, FootprintEqualsTheAngleBetweenTwoTracedRays) {
    constexpr double kMirrorCentreDistance = 10, kTiny = 1e-7;
    for (const double r : {.5, 3.0, -.5, -3.0})
        for (const double share : {.0, .4, .8}) { // share of the way to the rim of the circle
            const double angle = std::asin(share * std::abs(r) / kMirrorCentreDistance);
            const double cosine = std::sqrt(1 - share * share);
            const double distance = kMirrorCentreDistance * std::cos(angle) - r * cosine;
            double spread = std::abs(
                reflected_angle_at_circle(kMirrorCentreDistance, r, angle + kTiny) -
                reflected_angle_at_circle(kMirrorCentreDistance, r, angle));
            spread = std::min(spread, 2 * std::numbers::pi - spread);
            EXPECT_NEAR(pixel_footprint(kTiny, distance, 1 / r, cosine) / spread, 1, 1e-5)
                << "r " << r << ", share " << share;
        }
}

TEST(Footprint, FootprintOfAFlatOrFocusingMirrorIsThePixelAngle) {
    EXPECT_EQ(pixel_footprint(kPixelAngleRadians, 1e9, 0, 1e-9), kPixelAngleRadians);
    EXPECT_EQ(pixel_footprint(kPixelAngleRadians, 1, -.5, 1),
              kPixelAngleRadians); // the eye is in the focus of a hollow mirror
    EXPECT_EQ(pixel_footprint(kPixelAngleRadians, 0, 5, 1),
              kPixelAngleRadians); // the eye is on the mirror
}

TEST(Footprint, FaceEdgesEqualHandComputedValues) {
    const PixelGrid pixels = make_pixel_grid(dvec3(0), {0, 0, 1});
    EXPECT_NEAR(pixels.pixel_angle(1), kPixelAngleRadians, 1e-7 * kPixelAngleRadians);
    EXPECT_NEAR(edge_for_footprint(kPixelAngleRadians), 1184.62,
                .01); // the face edge that a flat mirror needs
    // At the nearest point of a ball straight ahead, a reflected pixel covers 1 + 2 distance /
    // radius times its angle.
    EXPECT_NEAR(edge_for_sphere(pixels, {0, 0, 12}, 2),
                edge_for_footprint(kPixelAngleRadians * (1 + 2 * 10 / 2.)), .01);
    EXPECT_EQ(edge_for_sphere(pixels, {0, 0, 1}, 2),
              edge_for_footprint(pixels.pixel_angle(0))); // the eye is inside the ball
}

TEST(Footprint, PixelsOffTheAxisCoverSmallerAngles) {
    const PixelGrid pixels = make_pixel_grid(dvec3(0), {0, 0, 1});
    // The expected angle lies between the two borders of a pixel in the middle row, at distance
    // `place` from the axis.
    for (const double place : {.0, .1, .3}) {
        const double between = std::atan(place + kPixelAngleRadians / 2) -
                               std::atan(place - kPixelAngleRadians / 2);
        EXPECT_NEAR(pixels.pixel_angle(std::cos(std::atan(place))) / between, 1, 1e-6);
    }
    const double corner = std::sqrt(2.) * std::tan(glm::radians(37.5) / 2);
    EXPECT_NEAR(pixels.corner_cosine(), std::cos(std::atan(corner)), 1e-7);
    EXPECT_EQ(pixels.pixel_angle(0), pixels.pixel_angle(pixels.corner_cosine()));
    const double ahead = edge_for_sphere(pixels, {0, 0, 12}, .1);
    const double aside = edge_for_sphere(pixels, vec3(12.0 * glm::normalize(dvec3(.3, 0, 1))), .1);
    EXPECT_NEAR(aside / ahead, 1 + .3 * .3, .01);
}

TEST(Footprint, MirrorsOutsideThePictureNeedNoTexels) {
    const PixelGrid pixels = make_pixel_grid(dvec3(0), {0, 0, 1});
    EXPECT_EQ(edge_for_sphere(pixels, {0, 0, -12}, 2), 0);
    EXPECT_EQ(edge_for_sphere(pixels, {12, 0, 12}, 2), 0);
    EXPECT_GT(edge_for_sphere(pixels, {5, 0, 12}, 2), 0) << "its rim is";
    // The triangle lies wholly behind the eye, but is so wide that its bounds reach around the
    // sides of the picture.
    const std::vector<shared::Vertex> corners{
        {{-50, -50, -9}, {0, 0, 1}}, {{50, -50, -.5f}, {0, 0, 1}}, {{0, 50, -.5f}, {0, 0, 1}}};
    const std::vector<std::uint32_t> triangle{0, 1, 2};
    EXPECT_EQ(edge_for_mesh(pixels, corners, triangle), 0);
    EXPECT_GT(edge_for_mesh(make_pixel_grid(dvec3(0), {0, 0, -1}), corners, triangle), 0);
}

struct FootprintMirror {
    std::vector<shared::Vertex> vertices;
    std::vector<std::uint32_t> indices;
    double needed_face_edge_of_mirror(const dvec3& eye, const dvec3& target) const {
        return edge_for_mesh(make_pixel_grid(eye, target), vertices, indices);
    }
};

/// Builds a mirror from the triangles of a mesh. `moulded` maps each corner to a vertex with
/// position and normal.
FootprintMirror make_mirror_of_mesh(const scene::Mesh& mesh,
                                    const std::function<shared::Vertex(const dvec3&)>& moulded) {
    FootprintMirror mirror;
    for (const dvec3& position : mesh.positions) mirror.vertices.push_back(moulded(position));
    for (const uvec3& triangle : mesh.triangles)
        for (int j = 0; j < 3; ++j) mirror.indices.push_back(triangle[j]);
    return mirror;
}

TEST(Footprint, BallMeshNeedsTheSameEdgeAsItsSphere) {
    constexpr double kMirrorBallRadius = .2;
    const dvec3 centre(.1, -.2, .3), eye(-1, .4, -.7);
    const FootprintMirror ball = make_mirror_of_mesh(scene::ball("ball", 5), [&](const dvec3& p) {
        return shared::Vertex{vec3(centre + kMirrorBallRadius * p), vec3(p)};
    });
    // The tolerance allows for the width of a facet, about a twentieth of the radius. The point
    // nearest to the eye is up to half a facet away from a vertex.
    for (const dvec3& target : {centre, centre + dvec3(.3, .1, 0)}) {
        const double wanted = edge_for_sphere(make_pixel_grid(eye, target), vec3(centre),
                                              kMirrorBallRadius);
        EXPECT_NEAR(ball.needed_face_edge_of_mirror(eye, target), wanted, .01 * wanted);
    }
}

TEST(Footprint, HollowMirrorNeedsALargerEdgeThanABulgingMirror) {
    constexpr double kMirrorBallRadius = 2, kDistance = 5;
    // The mirror is a cap of a ball around its corner (0, 0, -1), seen along its axis from outside
    // and from inside.
    scene::Mesh cap = scene::ball("cap", 5);
    std::erase_if(cap.triangles, [&](const uvec3& t) {
        return !(cap.positions[t.x].z < -.99 && cap.positions[t.y].z < -.99 &&
                 cap.positions[t.z].z < -.99);
    });
    ASSERT_FALSE(cap.triangles.empty());
    for (const double side : {1., -1.}) { // the mirror's normals point out or in
        const FootprintMirror mirror = make_mirror_of_mesh(cap, [&](const dvec3& p) {
            return shared::Vertex{vec3(kMirrorBallRadius * p), vec3(side * p)};
        });
        const dvec3 top(0, 0, -kMirrorBallRadius), away(0, 0, -kDistance);
        const double bulge = edge_for_footprint(kPixelAngleRadians *
                                                (1 + 2 * kDistance / kMirrorBallRadius)),
                     hollow = edge_for_footprint(kPixelAngleRadians *
                                                 (2 * kDistance / kMirrorBallRadius - 1));
        EXPECT_NEAR(mirror.needed_face_edge_of_mirror(top + away, top), bulge, .01 * bulge);
        EXPECT_NEAR(mirror.needed_face_edge_of_mirror(top - away, top), hollow, .01 * hollow);
    }
}

TEST(Footprint, CylinderNeedsTheSameEdgeAsAFlatMirror) {
    // The cylinder is a bent plane of 8 x 8 cells. Its triangles have edges along, across and
    // diagonal to the axis.
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
    const dvec3 eye(0, 0, 5), middle(0);
    // Squared tangent of the angle between the camera's axis and a corner of the plane.
    const double corner = 2 * .4 * .4 / (5 * 5);
    const double wanted = edge_for_footprint(kPixelAngleRadians) * (1 + corner);
    EXPECT_NEAR(make_mirror_of_mesh(plane, bent).needed_face_edge_of_mirror(eye, middle), wanted,
                .01 * wanted);
    const auto flat = [](const dvec3& p) { return shared::Vertex{vec3(p), vec3(0, 0, 1)}; };
    EXPECT_NEAR(make_mirror_of_mesh(plane, flat).needed_face_edge_of_mirror(eye, middle), wanted,
                1e-6 * wanted);
    EXPECT_NEAR(make_mirror_of_mesh(plane, flat).needed_face_edge_of_mirror(-eye, middle), wanted,
                1e-6 * wanted);
    const auto nothing = [](const dvec3&) { return shared::Vertex{vec3(1), vec3(0, 0, 1)}; };
    EXPECT_EQ(make_mirror_of_mesh(plane, nothing).needed_face_edge_of_mirror(eye, middle), 0);
}

TEST(Footprint, CommonEdgeCoversTheLargestNeed) {
    const auto edge = [](const std::vector<double>& needs) {
        return choose_common_edge(needs, 16384);
    };
    EXPECT_EQ(edge({}), 16u);
    EXPECT_EQ(edge({0}), 16u);
    EXPECT_EQ(edge({16}), 16u);
    EXPECT_EQ(edge({16.01, 3}), 32u);
    EXPECT_EQ(edge({39.7, 48.6, 57.8, 21.4}), 64u);
    EXPECT_EQ(edge({16370}), 16384u);
    EXPECT_EQ(edge({1e30}), 16384u);
    EXPECT_EQ(edge({std::numeric_limits<double>::infinity()}), 16384u);
    EXPECT_EQ(choose_common_edge(std::vector<double>{90}, 100), 96u);
    EXPECT_EQ(choose_common_edge(std::vector<double>{97}, 100), 100u);
}

} // namespace
