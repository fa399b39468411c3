// Tests how much each search improves the built-in scene, from all test cameras.
#include "support/worth.hpp"

namespace {

TEST(Worth, SearchesMeetTheirErrorBoundsFromEveryCamera) {
    for (const test::Look& look : test::looks()) {
        SCOPED_TRACE(look.camera.name);
        for (const auto& [search, worth] : test::kWorths) {
            SCOPED_TRACE(search);
            test::expect_worth(search, look);
        }
        test::expect_small_captures(look);
        test::expect_hybrid(look);
    }
}

} // namespace
