// What rows are worth beside each other.
#include "measure/judge.hpp"
#include "unit/report_sample.hpp"

#include <gtest/gtest.h>

namespace {

using namespace catoptric;
using report::sample::row;
using report::sample::times;

TEST(Judge, RowsOfAMovingSceneAreRankedByTheirWholeFrame) {
    measure::Row a = row("a", 1, .1, .1), b = row("b", 2, .1, .2);
    a.frame_ms = times(9), b.frame_ms = times(3);
    EXPECT_TRUE(measure::is_faster(a, b));
    EXPECT_TRUE(measure::beats(a, b));
    a.moves = b.moves = true;
    EXPECT_TRUE(measure::is_faster(b, a)) << "the host's work counts";
    EXPECT_FALSE(measure::beats(a, b)) << "it is closer, and slower";
    EXPECT_EQ(measure::candidate_of(a).cost, 9);
    EXPECT_EQ(measure::front_of({a, b}), (std::vector<std::size_t>{1, 0}));
}

} // namespace
