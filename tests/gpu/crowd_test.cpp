// Tests of captures with many mirror balls. Triangles of a ball that face away from the capture's
// centre are culled, and the captures must look the same as with these triangles.
#include "stress/texels.hpp"
#include "support/captures.hpp"

#include <gtest/gtest.h>

namespace {

using namespace catoptric;

constexpr double kShellRadius = 1, kCrowdBallRadius = .25, kBallDistanceFromShell = 3;

/// Returns a scene with a mirror ball at the origin, a larger mirror ball (the shell) around it,
/// and eight mirror balls outside. With `turned_out`, a transform turns the last ball inside out.
scene::Scene make_crowd_of_balls(bool turned_out) {
    scene::Scene scene{.name = "crowd"};
    const std::size_t mirror = test::add_material(scene, {.name = "mirror", .mirror = true});
    test::add_ball(scene, "inner", mirror, dvec3(0), kCrowdBallRadius, 4);
    test::add_ball(scene, "shell", mirror, dvec3(0), kShellRadius, 4);
    for (int corner = 0; corner < 8; ++corner)
        test::add_ball(scene, "ball", mirror,
                       kBallDistanceFromShell *
                           dvec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1),
                       kCrowdBallRadius, 4);
    if (turned_out) scene.objects.back().world_from_object[0] *= -1.;
    scene.cameras.push_back({.eye = {0, 0, 9}, .target = {0, 0, 0}});
    return scene;
}

/// Nearest and farthest captured distance, in world units.
struct CapturedDistanceRange {
    double nearest = 1e9, farthest = 0;
};
/// Returns the range of the distances in the capture of mirror `from` (numbered from 0). Reads the
/// directions whose cosine with `along` is at least `cosine`. A cosine of -1 selects all
/// directions.
CapturedDistanceRange find_captured_distance_range(const test::CapturedCubes& captured,
                                                   std::uint32_t from, const dvec3& along,
                                                   double cosine) {
    CapturedDistanceRange seen;
    stress::for_each_texel(
        captured.face, [&](const dvec3& direction, int face, std::uint32_t x, std::uint32_t y) {
            if (dot(glm::normalize(direction), along) < cosine) return;
            const double distance = captured.distance(from, face, x, y, TexelFormat::r32f) /
                                    captured.space.scale;
            seen.nearest = std::min(seen.nearest, distance);
            seen.farthest = std::max(seen.farthest, distance);
        });
    return seen;
}

TEST(Crowd, CapturesShowBallsFromOutsideAndTheShellFromInside) {
    for (const bool turned_out : {false, true}) {
        const test::CapturedCubes captured = test::capture_mirrors(make_crowd_of_balls(turned_out),
                                                                   64, TexelFormat::r32f);
        const CapturedDistanceRange within = find_captured_distance_range(captured, 0,
                                                                          dvec3(1, 0, 0), -1);
        EXPECT_NEAR(within.nearest, kShellRadius, .02);
        EXPECT_NEAR(within.farthest, kShellRadius, .02) << "the shell is closed";
        // The capture of the first outer ball shows the front of the shell.
        const dvec3 first = kBallDistanceFromShell * dvec3(-1),
                    last = kBallDistanceFromShell * dvec3(1);
        EXPECT_NEAR(
            find_captured_distance_range(captured, 2, glm::normalize(-first), .9995).nearest,
            length(first) - kShellRadius, .1);
        // The capture of the seventh outer ball, looking along an edge of the cube of outer balls,
        // shows the eighth ball.
        const dvec3 seventh(-kBallDistanceFromShell, kBallDistanceFromShell,
                            kBallDistanceFromShell);
        EXPECT_NEAR(find_captured_distance_range(captured, 8, glm::normalize(last - seventh), .9995)
                        .nearest,
                    length(last - seventh) - kCrowdBallRadius, .1)
            << (turned_out ? "turned inside out" : "as made");
    }
}

} // namespace
