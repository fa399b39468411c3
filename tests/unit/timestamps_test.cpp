// Tests of GPU timestamps, 64-bit words of which a device may fill only the low bits.
#include "graph/timestamps.hpp"

#include <gtest/gtest.h>

namespace {

using catoptric::graph::to_milliseconds;

TEST(Timestamps, CountFromTheFirst) {
    const std::uint64_t stamps[] = {1'000'000, 1'000'000, 3'500'000};
    EXPECT_EQ(to_milliseconds(stamps, 64, 1), (std::vector<double>{0, 0, 2.5}));
    EXPECT_EQ(to_milliseconds(stamps, 64, 10), (std::vector<double>{0, 0, 25}));
    EXPECT_TRUE(to_milliseconds({}, 64, 1).empty());
}

// A frame on a slow device can take longer than 2^32 ns = 4.3 s.
TEST(Timestamps, AreNotCutToThirtyTwoBits) {
    const std::uint64_t stamps[] = {5, 5 + (std::uint64_t{10} << 32)};
    EXPECT_EQ(to_milliseconds(stamps, 64, 1)[1], 10 * 4294.967296);
    EXPECT_EQ(to_milliseconds(stamps, 48, 1)[1], 10 * 4294.967296);
}

TEST(Timestamps, SurviveAWrapOfTheirValidBits) {
    const std::uint64_t stamps[] = {(std::uint64_t{1} << 36) - 1'000'000, 2'000'000};
    EXPECT_EQ(to_milliseconds(stamps, 36, 1), (std::vector<double>{0, 3}));
    // Bits above the valid ones are not part of the time.
    const std::uint64_t noisy[] = {std::uint64_t{7} << 40, (std::uint64_t{3} << 40) + 1'000'000};
    EXPECT_EQ(to_milliseconds(noisy, 36, 1)[1], 1);
    const std::uint64_t full[] = {~std::uint64_t{0} - 999'999, 0};
    EXPECT_EQ(to_milliseconds(full, 64, 1)[1], 1);
}

TEST(Timestamps, LeaveOutTheGapsBetweenPieces) {
    using catoptric::graph::remove_gaps;
    // The frame begins at 0. Its first pass ends at 5, after a gap of 2 from 2 to 4. The second
    // pass ends at 20, after gaps from 8 to 9 and from 11 to 16.
    const double times[] = {0, 2, 4, 5, 8, 9, 11, 16, 20};
    const std::size_t begins[] = {2, 5, 7};
    EXPECT_EQ(remove_gaps(times, begins), (std::vector<double>{0, 3, 12}));
    EXPECT_EQ(remove_gaps(times, {}), (std::vector<double>(std::begin(times), std::end(times))));
}

} // namespace
