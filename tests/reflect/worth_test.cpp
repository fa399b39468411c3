// What each search is worth: its error from three places beside that of parallax. One file, so that
// the searches share the pictures they are measured by.
#include "support/searches.hpp"

#include <algorithm>
#include <iterator>

namespace {

using namespace catoptric;

TEST(Secant, IsWorthItsSteps) {
    test::expect_worth(
        "secant",
        {.first_order = .53, .all = .38, .coarse = .45, .mirror_in_mirror = .24, .angle = .012});
}

TEST(Secant, NeedsSmallerCapturesThanParallax) {
    for (const test::Look& look : test::looks()) {
        SCOPED_TRACE(look.camera.name);
        const auto judged = test::judge(
            scene::cornell_mirrors(), look,
            {"parallax:face=512", "secant:face=256,continue=0", "secant:face=64,continue=0"});
        EXPECT_LE(judged[1].first_order, judged[0].first_order);
        EXPECT_LE(judged[2].lookup.mean_degrees, .025 * judged[0].lookup.mean_degrees);
    }
}

TEST(March, IsWorthItsSteps) {
    test::expect_worth(
        "march",
        {.first_order = .53, .all = .38, .coarse = .45, .mirror_in_mirror = .24, .angle = .012});
}

TEST(Pyramid, IsWorthItsCells) {
    test::expect_worth(
        "pyramid",
        {.first_order = .53, .all = .38, .coarse = .45, .mirror_in_mirror = .24, .angle = .012});
}

TEST(Layered, IsWorthItsSecondLayer) {
    test::expect_worth("layered", {.first_order = .53,
                                   .all = .38,
                                   .coarse = .45,
                                   .mirror_in_mirror = .24,
                                   .angle = .004,
                                   .wrong_object = .002});
}

/// Of the searches the dearer is the better one, from places that none was made for too, and none
/// draws lines where there are none.
TEST(Searches, KeepTheirOrderFromAnyPlace) {
    std::vector<test::Look> looks = test::looks();
    std::ranges::copy(test::unforeseen_looks(), std::back_inserter(looks));
    for (const test::Look& look : looks) {
        SCOPED_TRACE(look.camera.name);
        const auto seen = test::seen_in_mirrors(scene::cornell_mirrors(), look,
                                                {"secant", "march", "pyramid", "layered"});
        const measure::Difference &secant = seen[0], &march = seen[1], &pyramid = seen[2],
                                  &layered = seen[3];
        EXPECT_LE(march.flip, secant.flip);
        EXPECT_LE(layered.flip, 1.02 * pyramid.flip);
        EXPECT_LE(secant.off, 1.5 * pyramid.off);
        for (const measure::Difference* search : {&secant, &march})
            EXPECT_LE(search->longest_line, 1.1 * pyramid.longest_line);
        if (look.camera.name != looks.front().camera.name) continue;
        for (const measure::Difference& search : seen) EXPECT_LE(search.longest_line, 24);
    }
}

TEST(Hybrid, IsWorthWhatItTraces) {
    for (const test::Look& look : test::looks()) {
        SCOPED_TRACE(look.camera.name);
        const auto judged = test::judge(scene::cornell_mirrors(), look,
                                        {"parallax:face=512", "hybrid:face=512",
                                         "hybrid:face=512,continue=0", "hybrid:face=256"});
        const test::Judged &parallax = judged[0], &followed = judged[1], &alone = judged[2],
                           &coarse = judged[3];
        EXPECT_LE(followed.all, .38 * parallax.all);
        EXPECT_LE(coarse.all, .45 * parallax.all);
        EXPECT_LE(followed.mirror_in_mirror, .24 * alone.mirror_in_mirror);
        EXPECT_LE(followed.traced_fraction, .06);
    }
}

TEST(Hybrid, TracesLittleInAClosedRoom) {
    for (const test::Look& look : test::looks()) {
        SCOPED_TRACE(look.camera.name);
        const auto judged = test::judge(scene::cornell_mirrors_closed(), look,
                                        {"parallax:face=512", "hybrid:face=512"});
        EXPECT_LE(judged[1].all, .39 * judged[0].all);
        EXPECT_LE(judged[1].traced_fraction, .02);
    }
}

} // namespace
