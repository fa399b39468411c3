// Tests of the difference of two picture files, which are read in bands of rows.
#include "measure/file_difference.hpp"

#include "measure/difference_sum.hpp"
#include "measure/flip.hpp"
#include "measure/picture_file.hpp"
#include "support/folder.hpp"
#include "support/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

namespace catoptric::measure {
namespace {

class FileDifferenceTest : public test::InFolder {};

/// Draws a picture with flat areas, edges and noise from a seed.
Picture draw_random_test_picture(int width, int height, unsigned seed) {
    std::mt19937 random(seed);
    Picture picture(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float noise = static_cast<float>(random() % 256) / 255;
            const float area = static_cast<float>((x / 97 + y / 61) % 5) / 4;
            picture.at(x, y) = (x / 211) % 2 ? vec3(area, area, .5F) : vec3(noise, area, .25F);
        }
    return picture;
}

/// The pictures are several bands high, and their height is no multiple of a band's height.
TEST_F(FileDifferenceTest, FiguresFromBandsEqualThoseOfWholePictures) {
    const int width = 8192, height = 700;
    write_exr(draw_random_test_picture(width, height, 1), folder / "a.exr");
    write_exr(draw_random_test_picture(width, height, 2), folder / "b.exr");
    const Picture a = read_picture(folder / "a.exr"), b = read_picture(folder / "b.exr");
    const Difference whole = difference(a, b, {},
                                        flip(to_unrounded_display(a), to_unrounded_display(b)));
    const FileDifference found = compare_files(folder / "a.exr", folder / "b.exr", {}, 0);
    EXPECT_EQ(found.width, width);
    EXPECT_EQ(found.height, height);
    EXPECT_GT(whole.flip, .01);
    EXPECT_EQ(found.difference.flip, whole.flip);
    EXPECT_EQ(found.difference.rmse, whole.rmse);
    EXPECT_EQ(found.difference.mae, whole.mae);
    EXPECT_EQ(found.difference.p99, whole.p99);
    EXPECT_EQ(found.difference.max, whole.max);
    EXPECT_EQ(found.difference.max_x, whole.max_x);
    EXPECT_EQ(found.difference.max_y, whole.max_y);
    EXPECT_EQ(found.difference.longest_line, whole.longest_line);
    EXPECT_EQ(found.a_mean.all, mean_of(a, ValueRange::unclamped).all);
    EXPECT_EQ(found.b_clamped.all, mean_of(b, ValueRange::clamped).all);
}

TEST_F(FileDifferenceTest, PictureFilesOfDifferentSizesAreRefused) {
    write_png(Picture(3, 2), folder / "a.png");
    write_png(Picture(2, 3), folder / "b.png");
    EXPECT_THAT(
        test::catch_error_text(Failure::bad_data,
                               [&] { compare_files(folder / "a.png", folder / "b.png", {}, 0); }),
        testing::HasSubstr("b.png is 2x3: wanted two pictures of one size"));
}

} // namespace
} // namespace catoptric::measure
