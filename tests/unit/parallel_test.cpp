#include "core/parallel.hpp"

#include "core/error.hpp"

#include <gtest/gtest.h>

#include <set>
#include <stdexcept>
#include <string>

namespace catoptric {
namespace {

TEST(Parallel, InParallelCallsEachNumberOnceOnAnyNumberOfThreads) {
    for (const unsigned threads : {1U, 2U, 3U, 8U})
        for (const std::size_t count : {0U, 1U, 2U, 1000U}) {
            std::vector<std::atomic<int>> calls(count);
            parallel_for(count, threads, [&](std::size_t i) { ++calls[i]; });
            for (const std::atomic<int>& call : calls) EXPECT_EQ(call, 1);
        }
}

TEST(Parallel, SingleCallOrThreadRunsOnTheCallingThread) {
    const std::thread::id here = std::this_thread::get_id();
    parallel_for(1, 8, [&](std::size_t) { EXPECT_EQ(std::this_thread::get_id(), here); });
    parallel_for(100, 1, [&](std::size_t) { EXPECT_EQ(std::this_thread::get_id(), here); });
}

TEST(Parallel, CallerReceivesTheExceptionOfAnotherThread) {
    const std::thread::id here = std::this_thread::get_id();
    std::atomic<bool> thrown = false;
    const auto work = [&](std::size_t) {
        while (std::this_thread::get_id() == here && !thrown) std::this_thread::yield();
        if (std::this_thread::get_id() == here) return;
        thrown = true;
        throw std::runtime_error("there");
    };
    EXPECT_THROW(parallel_for(1000, 2, work), std::runtime_error);
}

/// Call 0 waits until another call has thrown. The caller must still receive the exception of call
/// 0, because 0 is the lowest number.
TEST(Parallel, CallerReceivesTheExceptionOfTheLowestNumber) {
    for (int round = 0; round < 20; ++round) {
        std::atomic<int> thrown{0}, begun{0};
        try {
            parallel_for(10000, 3, [&](std::size_t i) {
                ++begun;
                while (i == 0 && thrown == 0) std::this_thread::yield();
                if (i > 2) return;
                ++thrown;
                throw std::runtime_error("number " + std::to_string(i));
            });
            ADD_FAILURE() << "nothing was thrown";
        } catch (const std::runtime_error& error) {
            EXPECT_STREQ(error.what(), "number 0");
        }
        EXPECT_GE(thrown, 2);
        EXPECT_LT(begun, 10000) << "the rest is left out";
    }
}

TEST(Parallel, AllThreadsLookAtTheSignalOfTheCaller) {
    std::atomic<int> stop = 0, calls = 0;
    const WorkWatch watch{.stop = &stop};
    const WatchScope scope(&watch);
    parallel_for(10, 3, [&](std::size_t) { ++calls; });
    EXPECT_EQ(calls, 10);
    const auto count_until_stop = [&](std::size_t i) {
        ++calls;
        if (i == 0) stop = 15;
    };
    calls = 0;
    try {
        parallel_for(1'000'000, 3, count_until_stop);
        ADD_FAILURE() << "nothing was thrown";
    } catch (const Error& error) {
        EXPECT_EQ(error.failure, Failure::terminated);
    }
    EXPECT_LT(calls, 1'000'000);
    EXPECT_TRUE(has_seen_signal());
    const WatchScope nobody(nullptr);
    EXPECT_NO_THROW(look_at_stop());
}

} // namespace
} // namespace catoptric
