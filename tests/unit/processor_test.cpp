// Tests of session/processor.hpp: processor time, waiting for processors, and noise.
#include "session/processor.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>
#include <vector>

#include <pthread.h>
#include <sched.h>
#include <unistd.h>

namespace {

using namespace catoptric::session;

void burn_processor_time(double seconds) {
    std::atomic<int> sink{0};
    for (const double end = read_process_seconds() + seconds; read_process_seconds() < end;) ++sink;
}

TEST(Processor, ProcessSecondsCountAllThreads) {
    const double before = read_process_seconds();
    std::jthread beside([] { burn_processor_time(.05); });
    beside.join();
    EXPECT_GE(read_process_seconds() - before, .05);
}

TEST(Processor, ProcessorUseReportsHowLongThreadsRan) {
    const auto before = read_processor_times();
    ASSERT_TRUE(before) << "Linux tells";
    burn_processor_time(.05);
    const auto after = read_processor_times();
    ASSERT_TRUE(after);
    EXPECT_NEAR(waiting_times(*before, *after).ran, .05, .02);
    EXPECT_EQ(waiting_times(*after, *after).ran, 0);
    EXPECT_GE(after->busy, before->busy);
}

/// Runs three busy threads per processor, so that on average two of three wait. The measured
/// waiting time must then exceed the running time.
TEST(Processor, OverloadedProcessorsShowAsWaiting) {
    std::atomic<bool> stop{false};
    std::vector<std::jthread> crowd;
    for (unsigned i = 0; i < 3 * std::max(1U, std::thread::hardware_concurrency()); ++i)
        crowd.emplace_back([&] {
            while (!stop) {
            }
        });
    const auto before = read_processor_times();
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    const auto after = read_processor_times();
    stop = true;
    ASSERT_TRUE(before && after);
    const WaitingTimes waiting = waiting_times(*before, *after);
    EXPECT_GT(waiting.waited, waiting.ran);
}

TEST(Processor, WaitingCountsNewThreadsButNotEndedOnes) {
    const ProcessorTimes before{{{1, {10, 1}}, {2, {20, 2}}}, 100},
        after{{{1, {11, 1.25}}, {3, {.5, .125}}}, 104};
    WaitingTimes waiting = waiting_times(before, after);
    EXPECT_EQ(waiting.ran, 1.5) << "2 has ended: nobody knows what it did; 3 is new";
    EXPECT_EQ(waiting.waited, .375);
    EXPECT_EQ(waiting.others, 2.5);
    waiting += waiting;
    EXPECT_EQ(waiting.ran, 3);
    EXPECT_EQ(waiting.waited, .75);
    EXPECT_EQ(waiting.others, 5);
}

TEST(Processor, WaitingForOwnThreadsIsNoNoise) {
    EXPECT_EQ(waiting_share({0, 0, 0}), 0);
    EXPECT_EQ(waiting_share({6, 2, 0}), 0) << "nobody else was there";
    EXPECT_EQ(waiting_share({6, 2, -.01}), 0) << "the system counts in hundredths";
    EXPECT_EQ(waiting_share({6, 2, 2}), .25 * .25) << "in a quarter of the time others had them";
    EXPECT_EQ(waiting_share({6, 2, std::nan("")}), .25) << "nobody tells, so all of it counts";
    EXPECT_EQ(waiting_share({0, 2, 1}), 1);
}

TEST(Processor, NoisyMeansWaitingForMoreThanFivePercent) {
    EXPECT_FALSE(is_timing_noisy(.05));
    EXPECT_TRUE(is_timing_noisy(.0501));
    EXPECT_FALSE(is_timing_noisy(std::nan("")));
}

TEST(Processor, LoadOfOtherProcessesDecidesIfWaitingIsUnknown) {
    EXPECT_FALSE(is_timing_noisy(.25, 0, 600));
    EXPECT_TRUE(is_timing_noisy(.26, 0, 600));
    EXPECT_FALSE(is_timing_noisy(2.25, 2 * 6000, 6000))
        << "two processors of its own, for a long time";
    EXPECT_TRUE(is_timing_noisy(2.3, 2 * 6000, 6000));
    // The load is a mean over about a minute, so after ten seconds it contains only 15 % of this
    // process's time.
    EXPECT_FALSE(is_timing_noisy(.54, 20, 10));
    EXPECT_TRUE(is_timing_noisy(.57, 20, 10));
    EXPECT_FALSE(is_timing_noisy(std::numeric_limits<double>::quiet_NaN(), 0, 600))
        << "nobody tells";
}

/// Returns the number of processors on which a thread of this process may run.
int count_processors_of_thread(int thread) {
    cpu_set_t allowed;
    CPU_ZERO(&allowed);
    EXPECT_EQ(::sched_getaffinity(thread, sizeof allowed, &allowed), 0);
    return CPU_COUNT(&allowed);
}

/// PinnedThreads finds a driver's drawing threads by their names. Threads with such names must be
/// bound to one processor each while the object exists, and to none afterwards.
TEST(Processor, HeldThreadsBindsDrawingThreadsToOneProcessorEach) {
    const int all = count_processors_of_thread(0);
    if (all < 2) GTEST_SKIP() << "one processor: nothing to be held from";
    std::atomic<int> numbers[2] = {0, 0};
    std::atomic<bool> stop{false};
    std::vector<std::jthread> threads;
    for (int i = 0; i < 2; ++i)
        threads.emplace_back([&, i] {
            ::pthread_setname_np(::pthread_self(), ("llvmpipe-" + std::to_string(i)).c_str());
            numbers[i] = ::gettid();
            while (!stop) std::this_thread::yield();
        });
    while (numbers[0] == 0 || numbers[1] == 0) std::this_thread::yield();
    {
        const PinnedThreads held;
        EXPECT_EQ(held.count(), 2u);
        cpu_set_t first, second, both;
        ::sched_getaffinity(numbers[0], sizeof first, &first);
        ::sched_getaffinity(numbers[1], sizeof second, &second);
        CPU_AND(&both, &first, &second);
        EXPECT_EQ(CPU_COUNT(&first), 1);
        EXPECT_EQ(CPU_COUNT(&second), 1);
        EXPECT_EQ(CPU_COUNT(&both), 0) << "not the same one";
        EXPECT_EQ(count_processors_of_thread(0), all) << "others go where they like";
    }
    for (const auto& thread : numbers) EXPECT_EQ(count_processors_of_thread(thread), all);
    stop = true;
}

} // namespace
