// Tests of longest_line, which measures the longest line of wrong pixels, with masks drawn by hand.
#include "measure/lines.hpp"

#include "measure/picture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

namespace catoptric::measure {
namespace {

using Drawing = std::vector<std::string>;

/// Builds a mask from rows of text in which '#' marks a wrong pixel.
Mask mask_of(const Drawing& rows) {
    Mask mask;
    for (const std::string& row : rows)
        for (const char c : row) mask.push_back(c == '#' ? 255 : 0);
    return mask;
}

int line_in(const Drawing& rows) {
    return longest_line_length(mask_of(rows), static_cast<int>(rows.front().size()));
}

TEST(LongestLine, LineLengthIsTheLongestSideOfItsBounds) {
    EXPECT_EQ(line_in({"......", "......"}), 0);
    EXPECT_EQ(line_in({"......", "..#..."}), 1);
    EXPECT_EQ(line_in({"######"}), 6);
    EXPECT_EQ(line_in({"#", "#", "#"}), 3);
    EXPECT_EQ(line_in({"#....", ".#...", "..#..", "...#.", "....#"}), 5);
    EXPECT_EQ(line_in({"####", "#...", "#...", "#...", "#..."}), 5) << "round a corner";
    EXPECT_EQ(longest_line_length({}, 0), 0);
}

TEST(LongestLine, LineBridgesGapsOfAtMostTwoPixels) {
    EXPECT_EQ(line_in({"#..#..#"}), 7);
    EXPECT_EQ(line_in({"#...#...#"}), 1);
    EXPECT_EQ(line_in({"#......", ".......", ".......", "...#..."}), 4)
        << "dilated, their corners touch";
    EXPECT_EQ(line_in({"#......", ".......", ".......", "....#.."}), 1);
    EXPECT_EQ(line_in({".......#", "#......."}), 1)
        << "the end of a row does not touch the next one's start";
}

TEST(LongestLine, PatchesOfFourByFourPixelsAreNoLines) {
    EXPECT_EQ(line_in({"####", "####", "####", "####"}), 0);
    EXPECT_EQ(line_in({"########", "########", "########"}), 8) << "three rows are a line";
    EXPECT_EQ(line_in({"####.", "####.", ".####", ".####"}), 5) << "four rows without a square";
    EXPECT_EQ(line_in({"####........", "####........", "####........", "#########...",
                       "............", "............", "............", "..........##"}),
              2)
        << "a line that leaves a patch belongs to it; another does not";
}

TEST(LongestLine, LongestLineAgreesWithABruteForceSearch) {
    constexpr int kWidth = 23, kHeight = 17;
    std::mt19937 random(1);
    int longest = 0;
    for (int run = 0; run < 60; ++run) {
        std::bernoulli_distribution off(.01 + .006 * run);
        Mask mask(kWidth * kHeight);
        for (std::uint8_t& pixel : mask) pixel = off(random);
        // The expected length comes from sets of pixels. Each wrong pixel starts as its own set,
        // and touching sets are joined until no two sets touch.
        std::vector<int> set(mask.size(), -1);
        for (int i = 0; i < kWidth * kHeight; ++i)
            if (mask[i] != 0) set[i] = i;
        for (bool changed = true; changed;) {
            changed = false;
            for (int i = 0; i < kWidth * kHeight; ++i)
                for (int j = 0; j < kWidth * kHeight; ++j)
                    if (set[i] >= 0 && set[j] > set[i] && std::abs(i % kWidth - j % kWidth) <= 3 &&
                        std::abs(i / kWidth - j / kWidth) <= 3)
                        set[j] = set[i], changed = true;
        }
        int wanted = 0;
        for (int name = 0; name < kWidth * kHeight; ++name) {
            int low_x = kWidth, high_x = -1, low_y = kHeight, high_y = -1;
            bool patch = false;
            for (int i = 0; i < kWidth * kHeight; ++i) {
                if (set[i] != name) continue;
                const int x = i % kWidth, y = i / kWidth;
                low_x = std::min(low_x, x), high_x = std::max(high_x, x);
                low_y = std::min(low_y, y), high_y = std::max(high_y, y);
                bool square = x + 4 <= kWidth && y + 4 <= kHeight;
                for (int k = 0; square && k < 16; ++k)
                    square = mask[i + k / 4 * kWidth + k % 4] != 0;
                patch = patch || square;
            }
            if (!patch) wanted = std::max(wanted, std::max(high_x - low_x, high_y - low_y) + 1);
        }
        EXPECT_EQ(longest_line_length(mask, kWidth), wanted) << "run " << run;
        longest = std::max(longest, wanted);
    }
    EXPECT_EQ(longest, kWidth);
}

/// Builds a grey picture of 10 x 3 pixels with `colour` at the given pixels of the middle row.
Picture marked(const vec3& colour, const std::vector<int>& places) {
    Picture picture(10, 3);
    std::ranges::fill(picture.pixels, vec3(.5F));
    for (const int x : places) picture.at(x, 1) = colour;
    return picture;
}

Difference apart(const Picture& a, const Picture& b, const Mask& mask = {}) {
    return difference(a, b, mask, std::vector<float>(a.pixels.size()));
}

TEST(Off, PixelIsOffIfAChannelDiffersByMoreThanTwoHundredths) {
    const Picture grey = marked(vec3(.5F), {});
    const Difference more = apart(grey, marked({.5F, .5F, .5203F}, {2, 5}));
    EXPECT_DOUBLE_EQ(more.off, 2. / 30);
    EXPECT_EQ(more.longest_line, 4);
    const Difference less = apart(grey, marked({.5197F, .4803F, .5197F}, {2, 5}));
    EXPECT_EQ(less.off, 0);
    EXPECT_EQ(less.longest_line, 0);
    const Difference above = apart(marked(vec3(7), {2}), marked(vec3(1), {2}));
    EXPECT_EQ(above.off, 0) << "both clamped";
}

TEST(Off, OffShareAndLongestLineCountOnlyPixelsOfTheMask) {
    const Picture grey = marked(vec3(.5F), {}), wrong = marked(vec3(1), {0, 1, 2, 3, 8});
    Mask mask(30);
    mask[12] = mask[13] = mask[14] = mask[18] = 255;
    const Difference masked = apart(grey, wrong, mask);
    EXPECT_DOUBLE_EQ(masked.off, .75);
    EXPECT_EQ(masked.longest_line, 2);
    EXPECT_EQ(apart(grey, wrong).longest_line, 4);
}

} // namespace
} // namespace catoptric::measure
