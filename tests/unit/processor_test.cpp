// What the machine's processors were doing.
#include "app/processor.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>
#include <vector>

namespace {

using namespace catoptric::app;

void work_for(double seconds) {
    std::atomic<int> sink{0};
    for (const double end = process_seconds() + seconds; process_seconds() < end;) ++sink;
}

TEST(Processor, TimeIsThatOfAllThreads) {
    const double before = process_seconds();
    std::jthread beside([] { work_for(.05); });
    beside.join();
    EXPECT_GE(process_seconds() - before, .05);
}

TEST(Processor, ThreadsTellHowLongTheyRanAndWaited) {
    const auto before = thread_times();
    ASSERT_TRUE(before) << "Linux tells";
    work_for(.05);
    const auto after = thread_times();
    ASSERT_TRUE(after);
    EXPECT_NEAR(time_between(*before, *after).ran, .05, .02);
    EXPECT_EQ(time_between(*after, *after).ran, 0);
}

/// More threads than processors: some are ready and wait.
TEST(Processor, WaitingIsSeen) {
    std::atomic<bool> stop{false};
    std::vector<std::jthread> crowd;
    for (unsigned i = 0; i < 3 * std::max(1U, std::thread::hardware_concurrency()); ++i)
        crowd.emplace_back([&] {
            while (!stop) {
            }
        });
    const auto before = thread_times();
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    const auto after = thread_times();
    stop = true;
    ASSERT_TRUE(before && after);
    const ThreadTime time = time_between(*before, *after);
    EXPECT_GT(time.waited, time.ran) << "two of three wait";
    EXPECT_TRUE(is_noisy(time));
}

TEST(Processor, ThreadsThatCameAndWent) {
    const ThreadTimes before{{1, {10, 1}}, {2, {20, 2}}}, after{{1, {11, 1.25}}, {3, {.5, .125}}};
    const ThreadTime time = time_between(before, after);
    EXPECT_EQ(time.ran, 1.5) << "2 has ended: nobody knows what it did; 3 is new";
    EXPECT_EQ(time.waited, .375);
}

TEST(Processor, NoisyIsMoreThanATwentiethOfTheTime) {
    EXPECT_FALSE(is_noisy({0, 0}));
    EXPECT_FALSE(is_noisy({.95, .05}));
    EXPECT_TRUE(is_noisy({.949, .051}));
}

TEST(Processor, WithoutASayOfWaitingTheLoadOfOthersJudges) {
    EXPECT_FALSE(is_noisy(.25, 0, 600));
    EXPECT_TRUE(is_noisy(.26, 0, 600));
    EXPECT_FALSE(is_noisy(2.25, 2 * 6000, 6000)) << "two processors of its own, for a long time";
    EXPECT_TRUE(is_noisy(2.3, 2 * 6000, 6000));
    // After ten seconds a load has seen 15 % of what this process does.
    EXPECT_FALSE(is_noisy(.54, 20, 10));
    EXPECT_TRUE(is_noisy(.57, 20, 10));
    EXPECT_FALSE(is_noisy(std::numeric_limits<double>::quiet_NaN(), 0, 600)) << "nobody tells";
}

} // namespace
