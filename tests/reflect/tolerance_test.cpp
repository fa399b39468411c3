// Tests of the hits that searches report. A continuous surface must be a hit, and a surface behind
// the edge of a nearer one must not.
#include "measure/lookup.hpp"
#include "support/paths.hpp"
#include "support/searches.hpp"

#include <iostream>

namespace {

using namespace catoptric;

constexpr uvec2 kTolerancePictureSize{64, 64};
constexpr double kMirrorPlaneZ = 2, kOppositeWallZ = -4; // z of the mirror and of the wall opposite

/// Returns a box with a flat mirror and upright boards in front of the opposite wall. The boards
/// are nearer to the mirror by the share `nearer` of the distance. Their edges hide parts of the
/// wall from the mirror's centre, but not from all points of the mirror.
scene::Scene make_scene_of_boards_before_wall(double nearer) {
    scene::Scene scene{.name = "slats"};
    test::add_bright_box(scene, {-4, -4, kOppositeWallZ}, {4, 4, 4});
    test::add_quad(scene, "mirror", test::add_material(scene, {.name = "mirror", .mirror = true}),
                   {-2, -1.5, kMirrorPlaneZ}, {-2, 1.5, kMirrorPlaneZ}, {2, 1.5, kMirrorPlaneZ},
                   {2, -1.5, kMirrorPlaneZ});
    for (int i = -2; nearer > 0 && i <= 2; ++i)
        test::add_glowing_board(
            scene, {.25f, 0, 0},
            {1.3 * i, 0, kMirrorPlaneZ - (kMirrorPlaneZ - kOppositeWallZ) * (1 - nearer)},
            {.35, 0, 0}, {0, 3, 0});
    scene.cameras.push_back(
        {.eye = {.2, .3, -2}, .target = {0, 0, kMirrorPlaneZ}, .vertical_fov_degrees = 50});
    return scene;
}

/// Number of first-order pixels, of hits among them, and of hits that looked aside by more than the
/// allowed angle.
struct HitCounts {
    std::size_t pixels = 0, hits = 0, wrong = 0;
};

HitCounts count_hits_between_slats(double nearer, const std::string& technique, double degrees) {
    HitCounts found;
    for (const measure::LookupError& pixel : test::measure_lookup_directions(
             make_scene_of_boards_before_wall(nearer), technique, kTolerancePictureSize)) {
        ++found.pixels;
        if (pixel.state != 0) continue;
        ++found.hits;
        found.wrong += pixel.angle_degrees > degrees;
    }
    std::cout << "[ MEASURED ] boards " << nearer << " nearer, " << technique << ": of "
              << found.pixels << " pixels " << found.hits << " hits, " << found.wrong
              << " more than " << degrees << " degrees aside\n";
    return found;
}

const std::vector<std::string> kSearchTechniqueNames{"secant", "march", "pyramid", "layered",
                                                     "proxy"};

TEST(Tolerance, ContinuousSurfaceIsAHit) {
    for (const std::string& search : kSearchTechniqueNames)
        for (const std::string settings :
             {"face=64", "face=256", "face=64,distance=unorm8,range=10",
              "face=256,distance=unorm8,range=10"}) {
            const HitCounts found = count_hits_between_slats(0, search + ":shadow=none," + settings,
                                                             .5);
            EXPECT_GT(found.pixels, 2000u);
            EXPECT_GE(found.hits, found.pixels * 99 / 100) << search << settings;
            EXPECT_LE(found.wrong, found.pixels * 3 / 100) << search << settings;
        }
    // This board is so close to the wall that a search may report either of the two surfaces.
    for (const std::string& search : kSearchTechniqueNames) {
        const HitCounts found = count_hits_between_slats(.02, search + ":shadow=none,face=128", 1);
        EXPECT_GE(found.hits, found.pixels * 95 / 100) << search;
    }
}

/// Limits, in percent of the pixels, the hits that looked in a wrong direction.
TEST(Tolerance, SurfaceHiddenBehindAnEdgeIsNoHit) {
    const std::map<std::string, std::size_t> most{
        {"secant", 4}, {"march", 5}, {"pyramid", 2}, {"layered", 5}};
    for (const auto& [search, percent] : most) {
        const HitCounts found = count_hits_between_slats(.2, search + ":shadow=none,face=256", .5);
        EXPECT_LE(found.wrong, found.pixels * percent / 100) << search;
    }
}

// The box of `proxy` follows the walls. A board in front of a wall must not count as a hit on the
// box. The tolerance is a twentieth of the distance.
TEST(Tolerance, ProxyReportsNoHitForObjectsBeforeItsBox) {
    const HitCounts close = count_hits_between_slats(.03, "proxy:shadow=none,face=256", 1),
                    apart = count_hits_between_slats(.08, "proxy:shadow=none,face=256", 1);
    EXPECT_EQ(close.hits, close.pixels);
    EXPECT_LE(apart.hits, apart.pixels * 3 / 4);
}

} // namespace
