// Tests how much each search reduces the error of `parallax`. All tests are in one file, so that
// they share their rendered pictures.
#include "scene/built_in.hpp"
#include "support/worth.hpp"

#include <algorithm>
#include <iterator>

namespace {

using namespace catoptric;

TEST(Worth, EachSearchMeetsItsErrorBounds) {
    for (const auto& [search, worth] : test::kSearchErrorLimits) {
        SCOPED_TRACE(search);
        test::expect_errors_within_limits(search, test::list_search_test_views().front());
    }
}

TEST(Worth, SecantNeedsSmallerCapturesThanParallax) {
    test::expect_small_captures(test::list_search_test_views().front());
}

TEST(Worth, HybridTracesFewPixelsForItsErrorBounds) {
    test::expect_hybrid_beats_parallax(test::list_search_test_views().front());
}

/// The more expensive of two searches must be the better one, also from cameras that were not used
/// in development. No search may draw long false lines.
TEST(Searches, OrderOfTheSearchesHoldsFromEveryCamera) {
    std::vector<test::SearchTestView> looks = test::list_search_test_views();
    std::ranges::copy(test::list_unseen_search_test_views(), std::back_inserter(looks));
    for (const test::SearchTestView& look : looks) {
        SCOPED_TRACE(look.camera.name);
        const auto seen = test::compare_mirror_pictures(scene::make_cornell(), look,
                                                        {"secant", "march", "pyramid", "layered"});
        const measure::Difference &secant = seen[0], &march = seen[1], &pyramid = seen[2],
                                  &layered = seen[3];
        EXPECT_LE(march.flip, secant.flip);
        EXPECT_LE(layered.flip, 1.02 * pyramid.flip);
        // Another rasteriser may cover other pixels at the outlines of mirrors.
        EXPECT_LE(secant.off, (test::computes_like_cpp() ? 1.5 : 2.5) * pyramid.off);
        for (const measure::Difference* search : {&secant, &march})
            EXPECT_LE(search->longest_line,
                      (test::computes_like_cpp() ? 1.1 : 1.3) * pyramid.longest_line);
        if (look.camera.name != looks.front().camera.name) continue;
        for (const measure::Difference& search : seen) EXPECT_LE(search.longest_line, 24);
    }
}

} // namespace
