// Tests of mirrors in mirrors, in surroundings of radiance 1. Each mirror reduces another colour
// channel. The colour of a pixel therefore tells which mirrors its ray met, how often, and whether
// the ray was ended early.
#include "support/paths.hpp"

#include <iostream>

namespace {

using namespace catoptric;

constexpr uvec2 kHopsPictureSize{64, 64};

session::TechniqueResult trace_to_depth(const scene::Scene& scene, int depth) {
    return test::render_technique(
        scene, "raytrace:shadow=none,sphere=exact,depth=" + std::to_string(depth),
        kHopsPictureSize);
}

measure::Picture render_with_search(const scene::Scene& scene, const std::string& search,
                                    const std::string& settings, int frames = 1) {
    return test::render_technique(scene, search + ":face=128,shadow=none," + settings,
                                  kHopsPictureSize, frames)
        .hdr;
}

/// Numbers of wrong pixels, by the number of mirrors that the traced ray met: any number, at least
/// two, or at least three. `black`: number of black pixels, whose rays were ended early.
struct WrongPixelsByMirrorCount {
    test::PixelComparison all, two, three, black;
};

WrongPixelsByMirrorCount count_wrong_pixels_by_mirrors(const std::string& what,
                                                       const measure::Picture& picture,
                                                       const session::TechniqueResult& truth) {
    const auto share_of_wrong_pixels_where = [&](const auto& holds) {
        return test::compare_pixels_of_mirrors(
            picture, truth, [&](std::uint32_t, const vec3& colour) {
                return holds(test::count_mirrors_met_by_ray(colour));
            });
    };
    const WrongPixelsByMirrorCount found{
        share_of_wrong_pixels_where([](int) { return true; }),
        share_of_wrong_pixels_where([](int met) { return met >= 2; }),
        share_of_wrong_pixels_where([](int met) { return met >= 3; }),
        share_of_wrong_pixels_where([](int met) { return met == 0; })};
    std::cout << "[ MEASURED ] " << what << ": " << found.all << ", two mirrors " << found.two
              << ", three " << found.three << ", black " << found.black << "\n";
    return found;
}

/// Returns the test scene `make_mirror_hall` with a ball, a block and a flat mirror, in which all
/// other surfaces emit radiance 1.
scene::Scene make_bright_mirror_hall() {
    scene::Scene hall = test::make_mirror_hall();
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

// Without history, captures show other mirrors black. A ray that meets more mirrors than it may be
// followed through is black. Ray tracing with the same depth gives the same result.
TEST(Hops, EachSphereOnTheWayReflectsItsOwnShare) {
    for (const int hops : {0, 1, 2}) {
        const session::TechniqueResult truth = trace_to_depth(test::make_three_ball_scene(),
                                                              hops + 1);
        for (const std::string search : {"secant", "march", "pyramid", "layered", "proxy"}) {
            SCOPED_TRACE(search + ", continue=" + std::to_string(hops));
            const std::string settings = "continue=" + std::to_string(hops);
            const WrongPixelsByMirrorCount found = count_wrong_pixels_by_mirrors(
                search + ", " + settings,
                render_with_search(test::make_three_ball_scene(), search, settings), truth);
            EXPECT_LE(found.all.share_of_off_mirror_pixels(), search == "proxy" ? .08 : .06);
            EXPECT_GT(found.black.pixels, 10u);
            EXPECT_LE(found.black.share_of_off_mirror_pixels(),
                      search == "secant" || search == "proxy" ? .33 : .16);
            if (hops < 1) continue;
            EXPECT_GT(found.two.pixels, 100u);
            EXPECT_LE(found.two.share_of_off_mirror_pixels(), .12);
            if (hops < 2) continue;
            EXPECT_GT(found.three.pixels, 20u);
            EXPECT_LE(found.three.share_of_off_mirror_pixels(), .25);
        }
    }
}

TEST(Hops, EachMirrorOfAnyShapeOnTheWayReflectsItsOwnShare) {
    for (const int hops : {1, 2}) {
        const session::TechniqueResult truth = trace_to_depth(make_bright_mirror_hall(), hops + 1);
        for (const std::string search : {"march", "pyramid", "layered"}) {
            SCOPED_TRACE(search + ", continue=" + std::to_string(hops));
            const std::string settings = "continue=" + std::to_string(hops);
            const WrongPixelsByMirrorCount found = count_wrong_pixels_by_mirrors(
                "hall, " + search + ", " + settings,
                render_with_search(make_bright_mirror_hall(), search, settings), truth);
            EXPECT_LE(found.all.share_of_off_mirror_pixels(), .06);
            EXPECT_GT(found.two.pixels, 100u);
            EXPECT_LE(found.two.share_of_off_mirror_pixels(), .15);
            EXPECT_LE(found.black.share_of_off_mirror_pixels(), .16);
        }
    }
}

/// Returns the number of pixels whose ray met at least two mirrors.
std::size_t count_pixels_of_two_mirrors(const measure::Picture& picture) {
    return static_cast<std::size_t>(std::ranges::count_if(picture.pixels, [](const vec3& colour) {
        return test::count_mirrors_met_by_ray(colour) >= 2;
    }));
}

// If rays are not followed, the captured colours of a mirror must include that mirror's
// reflectance. The captures show such colours in about as many pixels as ray tracing.
TEST(Hops, CapturedMirrorsHaveTheirOwnReflectance) {
    const session::TechniqueResult truth = trace_to_depth(test::make_three_ball_scene(), 8);
    const double wanted = static_cast<double>(count_pixels_of_two_mirrors(truth.hdr));
    ASSERT_GT(wanted, 100);
    for (const std::string technique : {"naive:bounces=4,face=128", "reuse:face=128",
                                        "parallax:face=128", "pyramid:continue=0,face=128"}) {
        const measure::Picture picture = test::render_technique(test::make_three_ball_scene(),
                                                                technique + ",shadow=none",
                                                                kHopsPictureSize, 6)
                                             .hdr;
        const test::PixelComparison once = test::compare_pixels_of_mirrors(
            picture, truth, [&](std::uint32_t, const vec3& colour) {
                return test::count_mirrors_met_by_ray(colour) == 1;
            });
        const auto two = count_pixels_of_two_mirrors(picture);
        std::cout << "[ MEASURED ] " << technique << ": " << once
                  << " where one mirror is met, two in " << two << " pixels for " << wanted << "\n";
        EXPECT_LE(once.share_of_off_mirror_pixels(), .12) << technique;
        EXPECT_GT(static_cast<double>(two), .6 * wanted) << technique;
        EXPECT_LT(static_cast<double>(two), 1.7 * wanted) << technique;
    }
}

} // namespace
