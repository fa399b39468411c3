// What searches call a hit: a surface that goes on is met, what the edge of a nearer one hides is
// not.
#include "support/paths.hpp"
#include "support/searches.hpp"

#include <iostream>

namespace {

using namespace catoptric;

constexpr uvec2 kSize{64, 64};
constexpr double kMirror = 2, kWall = -4; // z

/// A box with a flat mirror and upright boards, `nearer` (a share of the way) before the wall
/// opposite. What their edges hide from the mirror's centre other points of it see.
scene::Scene slats(double nearer) {
    scene::Scene scene{.name = "slats"};
    test::add_bright_box(scene, {-4, -4, kWall}, {4, 4, 4});
    test::add_quad(scene, "mirror", test::add_material(scene, {.name = "mirror", .mirror = true}),
                   {-2, -1.5, kMirror}, {-2, 1.5, kMirror}, {2, 1.5, kMirror}, {2, -1.5, kMirror});
    for (int i = -2; nearer > 0 && i <= 2; ++i)
        test::add_glowing_board(scene, {.25f, 0, 0},
                                {1.3 * i, 0, kMirror - (kMirror - kWall) * (1 - nearer)},
                                {.35, 0, 0}, {0, 3, 0});
    scene.cameras.push_back(
        {.eye = {.2, .3, -2}, .target = {0, 0, kMirror}, .vertical_fov_degrees = 50});
    return scene;
}

/// First-order pixels, how many are hits, and how many of these looked more than this many degrees
/// aside.
struct Hits {
    std::size_t pixels = 0, hits = 0, wrong = 0;
};

Hits hits(double nearer, const std::string& technique, double degrees) {
    Hits found;
    for (const measure::LookedUp& pixel : test::looked_up(slats(nearer), technique, kSize)) {
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

const std::vector<std::string> kSearches{"secant", "march", "pyramid", "layered", "proxy"};

TEST(Tolerance, ASurfaceThatGoesOnIsMet) {
    for (const std::string& search : kSearches)
        for (const std::string settings :
             {"face=64", "face=256", "face=64,distance=unorm8,range=10",
              "face=256,distance=unorm8,range=10"}) {
            const Hits found = hits(0, search + ":shadow=none," + settings, .5);
            EXPECT_GT(found.pixels, 2000u);
            EXPECT_GE(found.hits, found.pixels * 99 / 100) << search << settings;
            EXPECT_LE(found.wrong, found.pixels * 3 / 100) << search << settings;
        }
    // A board so close to the wall that one may be taken for the other.
    for (const std::string& search : kSearches) {
        const Hits found = hits(.02, search + ":shadow=none,face=128", 1);
        EXPECT_GE(found.hits, found.pixels * 95 / 100) << search;
    }
}

/// At most so many of a hundred pixels look aside and call it a hit.
TEST(Tolerance, WhatAnEdgeHidesIsNotMet) {
    const std::map<std::string, std::size_t> most{
        {"secant", 4}, {"march", 5}, {"pyramid", 2}, {"layered", 5}};
    for (const auto& [search, percent] : most) {
        const Hits found = hits(.2, search + ":shadow=none,face=256", .5);
        EXPECT_LE(found.wrong, found.pixels * percent / 100) << search;
    }
}

// Its box is that of the walls: what stands a twentieth of the way before them is something else.
TEST(Tolerance, AProxyKnowsWhatIsNotOnIt) {
    const Hits close = hits(.03, "proxy:shadow=none,face=256", 1),
               apart = hits(.08, "proxy:shadow=none,face=256", 1);
    EXPECT_EQ(close.hits, close.pixels);
    EXPECT_LE(apart.hits, apart.pixels * 3 / 4);
}

} // namespace
