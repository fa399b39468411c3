// Mirrors in mirrors, told by what each takes away: in surroundings of radiance 1 a pixel's colour
// says which mirrors its ray has met, how often each, and where the ray was given up.
#include "support/paths.hpp"

#include <iostream>

namespace {

using namespace catoptric;

constexpr uvec2 kSize{64, 64};

app::Part traced(const scene::Scene& scene, int depth) {
    return test::render(scene, "raytrace:shadow=none,sphere=exact,depth=" + std::to_string(depth),
                        kSize);
}

measure::Picture searched(const scene::Scene& scene, const std::string& search,
                          const std::string& settings, int frames = 1) {
    return test::render(scene, search + ":face=128,shadow=none," + settings, kSize, frames).hdr;
}

/// Off by how many mirrors the traced ray has met: all pixels; two mirrors or more; three or more;
/// so many that it was given up, which is black.
struct ByMirrors {
    test::Compared all, two, three, black;
};

ByMirrors by_mirrors(const std::string& what, const measure::Picture& picture,
                     const app::Part& truth) {
    const auto where = [&](const auto& holds) {
        return test::compared(picture, truth, [&](std::uint32_t, const vec3& colour) {
            return holds(test::mirrors_met(colour));
        });
    };
    const ByMirrors found{where([](int) { return true; }), where([](int met) { return met >= 2; }),
                          where([](int met) { return met >= 3; }),
                          where([](int met) { return met == 0; })};
    std::cout << "[ MEASURED ] " << what << ": " << found.all << ", two mirrors " << found.two
              << ", three " << found.three << ", black " << found.black << "\n";
    return found;
}

/// The hall (support/scenes.hpp) in light from everywhere: a ball, a block and a flat mirror.
scene::Scene bright_hall() {
    scene::Scene hall = test::hall();
    hall.name = "bright hall";
    for (scene::Material& material : hall.materials) {
        if (material.mirror) continue;
        material.albedo = vec3(0);
        material.emission = vec3(1);
    }
    int mirror = 0;
    for (scene::Object& object : hall.objects)
        if (hall.materials[object.material].mirror)
            object.material = test::add_halving_mirror(hall, mirror++);
    return hall;
}

// Without history other mirrors are black in captures: a ray that meets one mirror more than it may
// be followed through is black, as where ray tracing ends at that depth.
TEST(Hops, EachSphereOnTheWayTakesItsOwnShare) {
    for (const int hops : {0, 1, 2}) {
        const app::Part truth = traced(test::three_balls(), hops + 1);
        for (const std::string search : {"secant", "march", "pyramid", "layered", "proxy"}) {
            SCOPED_TRACE(search + ", continue=" + std::to_string(hops));
            const std::string settings = "continue=" + std::to_string(hops);
            const ByMirrors found = by_mirrors(
                search + ", " + settings, searched(test::three_balls(), search, settings), truth);
            EXPECT_LE(found.all.share(), search == "proxy" ? .08 : .06);
            EXPECT_GT(found.black.pixels, 10u);
            EXPECT_LE(found.black.share(), search == "secant" || search == "proxy" ? .33 : .16);
            if (hops < 1) continue;
            EXPECT_GT(found.two.pixels, 100u);
            EXPECT_LE(found.two.share(), .12);
            if (hops < 2) continue;
            EXPECT_GT(found.three.pixels, 20u);
            EXPECT_LE(found.three.share(), .25);
        }
    }
}

TEST(Hops, EachMirrorOfAnyShapeOnTheWayTakesItsOwnShare) {
    for (const int hops : {1, 2}) {
        const app::Part truth = traced(bright_hall(), hops + 1);
        for (const std::string search : {"march", "pyramid", "layered"}) {
            SCOPED_TRACE(search + ", continue=" + std::to_string(hops));
            const std::string settings = "continue=" + std::to_string(hops);
            const ByMirrors found = by_mirrors("hall, " + search + ", " + settings,
                                               searched(bright_hall(), search, settings), truth);
            EXPECT_LE(found.all.share(), .06);
            EXPECT_GT(found.two.pixels, 100u);
            EXPECT_LE(found.two.share(), .15);
            EXPECT_LE(found.black.share(), .16);
        }
    }
}

/// Pixels that show two mirrors at least.
std::size_t shows_two(const measure::Picture& picture) {
    return static_cast<std::size_t>(std::ranges::count_if(
        picture.pixels, [](const vec3& colour) { return test::mirrors_met(colour) >= 2; }));
}

// Where rays are not followed the capture has what the other mirror takes away, in about as many
// pixels.
TEST(Hops, CapturesShowMirrorsWithTheirOwnShare) {
    const app::Part truth = traced(test::three_balls(), 8);
    const double wanted = static_cast<double>(shows_two(truth.hdr));
    ASSERT_GT(wanted, 100);
    for (const std::string technique : {"naive:bounces=4,face=128", "reuse:face=128",
                                        "parallax:face=128", "pyramid:continue=0,face=128"}) {
        const measure::Picture picture =
            test::render(test::three_balls(), technique + ",shadow=none", kSize, 6).hdr;
        const test::Compared once = test::compared(
            picture, truth,
            [&](std::uint32_t, const vec3& colour) { return test::mirrors_met(colour) == 1; });
        const auto two = shows_two(picture);
        std::cout << "[ MEASURED ] " << technique << ": " << once
                  << " where one mirror is met, two in " << two << " pixels for " << wanted << "\n";
        EXPECT_LE(once.share(), .12) << technique;
        EXPECT_GT(static_cast<double>(two), .6 * wanted) << technique;
        EXPECT_LT(static_cast<double>(two), 1.7 * wanted) << technique;
    }
}

} // namespace
