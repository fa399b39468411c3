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
Mask make_mask_of_drawing(const Drawing& rows) {
    Mask mask;
    for (const std::string& row : rows)
        for (const char c : row) mask.push_back(c == '#' ? 255 : 0);
    return mask;
}

int longest_line_in_drawing(const Drawing& rows) {
    return longest_line_length(make_mask_of_drawing(rows), static_cast<int>(rows.front().size()));
}

TEST(LongestLine, LineLengthIsTheLongestSideOfItsBounds) {
    EXPECT_EQ(longest_line_in_drawing({"......", "......"}), 0);
    EXPECT_EQ(longest_line_in_drawing({"......", "..#..."}), 1);
    EXPECT_EQ(longest_line_in_drawing({"######"}), 6);
    EXPECT_EQ(longest_line_in_drawing({"#", "#", "#"}), 3);
    EXPECT_EQ(longest_line_in_drawing({"#....", ".#...", "..#..", "...#.", "....#"}), 5);
    EXPECT_EQ(longest_line_in_drawing({"####", "#...", "#...", "#...", "#..."}), 5)
        << "round a corner";
    EXPECT_EQ(longest_line_length({}, 0), 0);
}

TEST(LongestLine, LineBridgesGapsOfAtMostTwoPixels) {
    EXPECT_EQ(longest_line_in_drawing({"#..#..#"}), 7);
    EXPECT_EQ(longest_line_in_drawing({"#...#...#"}), 1);
    EXPECT_EQ(longest_line_in_drawing({"#......", ".......", ".......", "...#..."}), 4)
        << "dilated, their corners touch";
    EXPECT_EQ(longest_line_in_drawing({"#......", ".......", ".......", "....#.."}), 1);
    EXPECT_EQ(longest_line_in_drawing({".......#", "#......."}), 1)
        << "the end of a row does not touch the next one's start";
}

TEST(LongestLine, PatchesOfFourByFourPixelsAreNoLines) {
    EXPECT_EQ(longest_line_in_drawing({"####", "####", "####", "####"}), 0);
    EXPECT_EQ(longest_line_in_drawing({"########", "########", "########"}), 8)
        << "three rows are a line";
    EXPECT_EQ(longest_line_in_drawing({"####.", "####.", ".####", ".####"}), 5)
        << "four rows without a square";
    EXPECT_EQ(
        longest_line_in_drawing({"####........", "####........", "####........", "#########...",
                                 "............", "............", "............", "..........##"}),
        2)
        << "a line that leaves a patch belongs to it; another does not";
}

TEST(LongestLine, LongestLineAgreesWithABruteForceSearch) {
    constexpr int kLinePictureWidth = 23, kHeight = 17;
    std::mt19937 random(1);
    int longest = 0;
    for (int run = 0; run < 60; ++run) {
        std::bernoulli_distribution off(.01 + .006 * run);
        Mask mask(kLinePictureWidth * kHeight);
        for (std::uint8_t& pixel : mask) pixel = off(random);
        // The expected length comes from sets of pixels. Each wrong pixel starts as its own set,
        // and touching sets are joined until no two sets touch.
        std::vector<int> set(mask.size(), -1);
        for (int i = 0; i < kLinePictureWidth * kHeight; ++i)
            if (mask[i] != 0) set[i] = i;
        for (bool changed = true; changed;) {
            changed = false;
            for (int i = 0; i < kLinePictureWidth * kHeight; ++i)
                for (int j = 0; j < kLinePictureWidth * kHeight; ++j)
                    if (set[i] >= 0 && set[j] > set[i] &&
                        std::abs(i % kLinePictureWidth - j % kLinePictureWidth) <= 3 &&
                        std::abs(i / kLinePictureWidth - j / kLinePictureWidth) <= 3)
                        set[j] = set[i], changed = true;
        }
        int wanted = 0;
        for (int name = 0; name < kLinePictureWidth * kHeight; ++name) {
            int low_x = kLinePictureWidth, high_x = -1, low_y = kHeight, high_y = -1;
            bool patch = false;
            for (int i = 0; i < kLinePictureWidth * kHeight; ++i) {
                if (set[i] != name) continue;
                const int x = i % kLinePictureWidth, y = i / kLinePictureWidth;
                low_x = std::min(low_x, x), high_x = std::max(high_x, x);
                low_y = std::min(low_y, y), high_y = std::max(high_y, y);
                bool square = x + 4 <= kLinePictureWidth && y + 4 <= kHeight;
                for (int k = 0; square && k < 16; ++k)
                    square = mask[i + k / 4 * kLinePictureWidth + k % 4] != 0;
                patch = patch || square;
            }
            if (!patch) wanted = std::max(wanted, std::max(high_x - low_x, high_y - low_y) + 1);
        }
        EXPECT_EQ(longest_line_length(mask, kLinePictureWidth), wanted) << "run " << run;
        longest = std::max(longest, wanted);
    }
    EXPECT_EQ(longest, kLinePictureWidth);
}

/// Builds a grey picture of 10 x 3 pixels with `colour` at the given pixels of the middle row.
Picture make_picture_with_marked_pixels(const vec3& colour, const std::vector<int>& places) {
    Picture picture(10, 3);
    std::ranges::fill(picture.pixels, vec3(.5F));
    for (const int x : places) picture.at(x, 1) = colour;
    return picture;
}

Difference difference_of_pictures(const Picture& a, const Picture& b, const Mask& mask = {}) {
    return difference(a, b, mask, std::vector<float>(a.pixels.size()));
}

TEST(Off, PixelIsOffIfAChannelDiffersByMoreThanTwoHundredths) {
    const Picture grey = make_picture_with_marked_pixels(vec3(.5F), {});
    const Difference more = difference_of_pictures(
        grey, make_picture_with_marked_pixels({.5F, .5F, .5203F}, {2, 5}));
    EXPECT_DOUBLE_EQ(more.off, 2. / 30);
    EXPECT_EQ(more.longest_line, 4);
    const Difference less = difference_of_pictures(
        grey, make_picture_with_marked_pixels({.5197F, .4803F, .5197F}, {2, 5}));
    EXPECT_EQ(less.off, 0);
    EXPECT_EQ(less.longest_line, 0);
    const Difference above = difference_of_pictures(make_picture_with_marked_pixels(vec3(7), {2}),
                                                    make_picture_with_marked_pixels(vec3(1), {2}));
    EXPECT_EQ(above.off, 0) << "both clamped";
}

TEST(Off, OffShareAndLongestLineCountOnlyPixelsOfTheMask) {
    const Picture grey = make_picture_with_marked_pixels(vec3(.5F), {}),
                  wrong = make_picture_with_marked_pixels(vec3(1), {0, 1, 2, 3, 8});
    Mask mask(30);
    mask[12] = mask[13] = mask[14] = mask[18] = 255;
    const Difference masked = difference_of_pictures(grey, wrong, mask);
    EXPECT_DOUBLE_EQ(masked.off, .75);
    EXPECT_EQ(masked.longest_line, 2);
    EXPECT_EQ(difference_of_pictures(grey, wrong).longest_line, 4);
}

} // namespace
} // namespace catoptric::measure
