#include "core/mirror_id.hpp"
#include "measure/masks.hpp"

#include <gtest/gtest.h>

#include <array>

namespace catoptric::measure {
namespace {

constexpr std::uint32_t make_two_hit_word(std::uint32_t first, std::uint32_t second) {
    return first | second << 16;
}

// The first two hits of six pixels: a wall; mirror 1 that reflects a wall; mirror 2 that reflects
// mirror 1; a concave mirror 1 that reflects itself; a mirror with the largest possible number; a
// smooth dielectric and a rough one, which are no mirrors.
constexpr std::array<std::uint32_t, 7> kTwoHitsOfPixels = {
    make_two_hit_word(0, 0),    make_two_hit_word(1, 0),     make_two_hit_word(2, 1),
    make_two_hit_word(1, 1),    make_two_hit_word(65535, 0), make_two_hit_word(0, 32767),
    make_two_hit_word(0, 32766)};

TEST(Masks, MasksSelectPixelsByTheirFirstTwoHits) {
    EXPECT_EQ(mask_all(kTwoHitsOfPixels), (Mask{255, 255, 255, 255, 255, 255, 255}));
    EXPECT_EQ(mask_mirrors(kTwoHitsOfPixels), (Mask{0, 255, 255, 255, 255, 0, 0}));
    EXPECT_EQ(mask_first_order(kTwoHitsOfPixels), (Mask{0, 255, 0, 0, 255, 0, 0}));
    EXPECT_EQ(mask_mirror_in_mirror(kTwoHitsOfPixels), (Mask{0, 0, 255, 255, 0, 0, 0}));
    EXPECT_EQ(mask_one_mirror(kTwoHitsOfPixels, catoptric::MirrorId(1)),
              (Mask{0, 255, 0, 255, 0, 0, 0}));
    EXPECT_EQ(mask_one_mirror(kTwoHitsOfPixels, catoptric::MirrorId(65535)),
              (Mask{0, 0, 0, 0, 255, 0, 0}));
    EXPECT_EQ(mask_non_mirrors(kTwoHitsOfPixels), (Mask{255, 0, 0, 0, 0, 255, 255}));
    EXPECT_EQ(mask_dielectrics(kTwoHitsOfPixels), (Mask{0, 0, 0, 0, 0, 255, 0}));
    EXPECT_EQ(mask_rough(kTwoHitsOfPixels), (Mask{0, 0, 0, 0, 0, 0, 255}));
}

TEST(Masks, MasksPartitionThePicture) {
    EXPECT_EQ(count_pixels(mask_mirrors(kTwoHitsOfPixels)) +
                  count_pixels(mask_non_mirrors(kTwoHitsOfPixels)),
              kTwoHitsOfPixels.size());
    EXPECT_EQ(count_pixels(mask_first_order(kTwoHitsOfPixels)) +
                  count_pixels(mask_mirror_in_mirror(kTwoHitsOfPixels)),
              count_pixels(mask_mirrors(kTwoHitsOfPixels)));
    EXPECT_EQ(count_pixels(mask_one_mirror(kTwoHitsOfPixels, catoptric::MirrorId(1))) +
                  count_pixels(mask_one_mirror(kTwoHitsOfPixels, catoptric::MirrorId(2))) +
                  count_pixels(mask_one_mirror(kTwoHitsOfPixels, catoptric::MirrorId(65535))),
              count_pixels(mask_mirrors(kTwoHitsOfPixels)));
}

TEST(Masks, MaskOfAnAbsentMirrorIsAllZero) {
    EXPECT_EQ(mask_one_mirror(kTwoHitsOfPixels, catoptric::MirrorId(9)),
              Mask(kTwoHitsOfPixels.size(), 0));
    // Mirror numbers start at 1, so 0 is no mirror.
    EXPECT_EQ(mask_one_mirror(kTwoHitsOfPixels, catoptric::MirrorId(0)),
              Mask(kTwoHitsOfPixels.size(), 0));
    EXPECT_EQ(count_pixels(mask_one_mirror(kTwoHitsOfPixels, catoptric::MirrorId(9))), 0U);
}

} // namespace
} // namespace catoptric::measure
