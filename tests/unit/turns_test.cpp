// Tests of the capture budget: which captures a frame draws if it may not draw all, and how long
// the others wait.
#include "render/postponed_redraws.hpp"
#include "scene/motion.hpp"
#include "session/capture_budget.hpp"
#include "session/capture_cost.hpp"
#include "support/numbers.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using namespace catoptric;
using Mirrors = std::vector<std::uint32_t>;

TEST(Turns, CapturesThatWaitedLongestAreDrawnFirst) {
    EXPECT_EQ(render::choose_postponed({{4, 0}, {2, 1}, {7, 3}, {1, 0}}, 2), (Mirrors{1, 4}));
    EXPECT_EQ(render::choose_postponed({{4, 2}, {2, 2}, {3, 2}}, 1), (Mirrors{3, 4}))
        << "of mirrors that waited equally long, the lower number is drawn first";
    EXPECT_EQ(render::choose_postponed({{4, 2}, {2, 2}}, 2), Mirrors());
    EXPECT_EQ(render::choose_postponed({}, 1), Mirrors());
}

// Mirrors request a new capture at random and keep requesting until it is drawn. No mirror may wait
// longer than one round of all mirrors.
TEST(Turns, EachCaptureIsDrawnWithinOneRound) {
    for (const std::uint32_t most : {1u, 2u, 3u, 5u}) {
        constexpr std::uint32_t kMirrorCount = 13;
        test::RandomNumbers numbers(most);
        std::vector<std::uint32_t> waited(kMirrorCount, 0);
        std::uint32_t longest = 0;
        for (int frame = 0; frame < 2000; ++frame) {
            std::vector<render::RedrawRequest> asking;
            for (std::uint32_t i = 0; i < kMirrorCount; ++i) {
                // The share of mirrors that request a new capture changes from none to all, so that
                // all shares are tested.
                const bool asks = waited[i] > 0 ||
                                  numbers.random_number_between(0, 1) < (frame % 200) / 150.;
                if (asks) asking.push_back({i, waited[i]});
            }
            const Mirrors later = render::choose_postponed(asking, most);
            EXPECT_EQ(later.size(), asking.size() - std::min<std::size_t>(asking.size(), most));
            for (std::uint32_t i = 0; i < kMirrorCount; ++i)
                waited[i] = std::ranges::find(later, i) != later.end() ? waited[i] + 1 : 0;
            longest = std::max(longest, std::ranges::max(waited));
        }
        EXPECT_EQ(longest + 1, (kMirrorCount + most - 1) / most) << most;
    }
}

TEST(CaptureCost, CaptureCostTellsHowManyMirrorsFitABudget) {
    session::CaptureCost pace;
    EXPECT_EQ(pace.count_affordable(1, 16), 16u) << "nothing was measured";
    pace.add(100, 0);
    EXPECT_EQ(pace.count_affordable(1, 16), 16u) << "no mirror was drawn";
    pace.add(16, 8); // 16 ms for 8 mirrors, which is 2 ms for each
    EXPECT_EQ(pace.count_affordable(7.9, 16), 3u);
    EXPECT_EQ(pace.count_affordable(.1, 16), 1u) << "one at least";
    EXPECT_EQ(pace.count_affordable(1000, 16), 16u);
    for (int k = 0; k < 4; ++k) pace.add(900, 1);
    for (int k = 0; k < 5; ++k) pace.add(4, 1);
    EXPECT_EQ(pace.count_affordable(8, 16), 2u) << "the median of the last nine";
    session::CaptureCost at_once;
    at_once.add(0, 1);
    EXPECT_EQ(at_once.count_affordable(1, 16), 16u);
}

TEST(CaptureBudget, BudgetTextSaysHowOldCapturesCanBe) {
    EXPECT_EQ(session::describe_budget({.mirrors = 16, .most = 3}),
              "captures: at most 3 of 16 mirrors a frame; a reflection is at most 5 frames old, "
              "and 6 more for each further mirror on the light's path");
    EXPECT_EQ(session::describe_budget({.mirrors = 4, .most = 2}),
              "captures: at most 2 of 4 mirrors a frame; a reflection is at most 1 frame old, "
              "and 2 more for each further mirror on the light's path");
    EXPECT_EQ((session::CaptureBudget{.mirrors = 0, .most = 0}).frames_per_cycle(), 1u);
}

} // namespace
