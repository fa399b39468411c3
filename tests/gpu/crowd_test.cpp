// Many mirrors: balls are drawn without the triangles that face away, and look as they do with
// them.
#include "stress/texels.hpp"
#include "support/captures.hpp"

#include <gtest/gtest.h>

namespace {

using namespace catoptric;

constexpr double kShell = 1, kBall = .25, kAway = 3;

/// A ball in a shell around the origin, both balls, and eight balls outside; the last, with
/// `turned_out`, turned inside out by its transform.
scene::Scene crowd(bool turned_out) {
    scene::Scene scene{.name = "crowd"};
    const std::size_t mirror = test::add_material(scene, {.name = "mirror", .mirror = true});
    test::add_ball(scene, "inner", mirror, dvec3(0), kBall, 4);
    test::add_ball(scene, "shell", mirror, dvec3(0), kShell, 4);
    for (int corner = 0; corner < 8; ++corner)
        test::add_ball(scene, "ball", mirror,
                       kAway * dvec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1),
                       kBall, 4);
    if (turned_out) scene.objects.back().world_from_object[0] *= -1.;
    scene.cameras.push_back({.eye = {0, 0, 9}, .target = {0, 0, 0}});
    return scene;
}

/// How far mirror `from` (from 0) sees along a direction, or around it.
struct Seen {
    double nearest = 1e9, farthest = 0;
};
Seen seen(const test::Captured& captured, std::uint32_t from, const dvec3& along, double cosine) {
    Seen seen;
    stress::for_texels(
        captured.face, [&](const dvec3& direction, int face, std::uint32_t x, std::uint32_t y) {
            if (dot(glm::normalize(direction), along) < cosine) return;
            const double distance = captured.distance(from, face, x, y, Format::r32f) /
                                    captured.space.scale;
            seen.nearest = std::min(seen.nearest, distance);
            seen.farthest = std::max(seen.farthest, distance);
        });
    return seen;
}

TEST(Crowd, ShowsTheFrontsOfBallsAndShellsFromWithin) {
    for (const bool turned_out : {false, true}) {
        const test::Captured captured = test::capture(crowd(turned_out), 64, Format::r32f);
        const Seen within = seen(captured, 0, dvec3(1, 0, 0), -1);
        EXPECT_NEAR(within.nearest, kShell, .02);
        EXPECT_NEAR(within.farthest, kShell, .02) << "the shell is closed";
        // From the first ball outside: the shell's front.
        const dvec3 first = kAway * dvec3(-1), last = kAway * dvec3(1);
        EXPECT_NEAR(seen(captured, 2, glm::normalize(-first), .9995).nearest,
                    length(first) - kShell, .1);
        // From the seventh along an edge of the cube that they make: the last.
        const dvec3 seventh(-kAway, kAway, kAway);
        EXPECT_NEAR(seen(captured, 8, glm::normalize(last - seventh), .9995).nearest,
                    length(last - seventh) - kBall, .1)
            << (turned_out ? "turned inside out" : "as made");
    }
}

} // namespace
