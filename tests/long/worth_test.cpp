// Tests how much each search improves the built-in scene, from all test cameras.
#include "support/worth.hpp"

namespace {

TEST(Worth, SearchesMeetTheirErrorBoundsFromEveryCamera) {
    for (const test::SearchTestView& look : test::list_search_test_views()) {
        SCOPED_TRACE(look.camera.name);
        for (const auto& [search, worth] : test::kSearchErrorLimits) {
            SCOPED_TRACE(search);
            test::expect_errors_within_limits(search, look);
        }
        test::expect_small_captures(look);
        test::expect_hybrid_beats_parallax(look);
    }
}

} // namespace
