#include "core/mirror_id.hpp"
#include "measure/masks.hpp"

#include <gtest/gtest.h>

#include <array>

namespace catoptric::measure {
namespace {

constexpr std::uint32_t masks_hit(std::uint32_t first, std::uint32_t second) {
    return first | second << 16;
}

// The first two hits of six pixels: a wall; mirror 1 that reflects a wall; mirror 2 that reflects
// mirror 1; a concave mirror 1 that reflects itself; a mirror with the largest possible number; a
// smooth dielectric, which is no mirror.
constexpr std::array<std::uint32_t, 6> kMasksHits = {masks_hit(0, 0),     masks_hit(1, 0),
                                                     masks_hit(2, 1),     masks_hit(1, 1),
                                                     masks_hit(65535, 0), masks_hit(0, 7)};

TEST(Masks, MasksSelectPixelsByTheirFirstTwoHits) {
    EXPECT_EQ(all_pixels(kMasksHits), (Mask{255, 255, 255, 255, 255, 255}));
    EXPECT_EQ(mirrors(kMasksHits), (Mask{0, 255, 255, 255, 255, 0}));
    EXPECT_EQ(first_order(kMasksHits), (Mask{0, 255, 0, 0, 255, 0}));
    EXPECT_EQ(mirror_in_mirror(kMasksHits), (Mask{0, 0, 255, 255, 0, 0}));
    EXPECT_EQ(of_mirror(kMasksHits, catoptric::MirrorId(1)), (Mask{0, 255, 0, 255, 0, 0}));
    EXPECT_EQ(of_mirror(kMasksHits, catoptric::MirrorId(65535)), (Mask{0, 0, 0, 0, 255, 0}));
    EXPECT_EQ(non_mirror(kMasksHits), (Mask{255, 0, 0, 0, 0, 255}));
    EXPECT_EQ(dielectrics(kMasksHits), (Mask{0, 0, 0, 0, 0, 255}));
}

TEST(Masks, MasksPartitionThePicture) {
    EXPECT_EQ(pixel_count(mirrors(kMasksHits)) + pixel_count(non_mirror(kMasksHits)),
              kMasksHits.size());
    EXPECT_EQ(pixel_count(first_order(kMasksHits)) + pixel_count(mirror_in_mirror(kMasksHits)),
              pixel_count(mirrors(kMasksHits)));
    EXPECT_EQ(pixel_count(of_mirror(kMasksHits, catoptric::MirrorId(1))) +
                  pixel_count(of_mirror(kMasksHits, catoptric::MirrorId(2))) +
                  pixel_count(of_mirror(kMasksHits, catoptric::MirrorId(65535))),
              pixel_count(mirrors(kMasksHits)));
}

TEST(Masks, MaskOfAnAbsentMirrorIsAllZero) {
    EXPECT_EQ(of_mirror(kMasksHits, catoptric::MirrorId(9)), Mask(6, 0));
    // Mirror numbers start at 1, so 0 is no mirror.
    EXPECT_EQ(of_mirror(kMasksHits, catoptric::MirrorId(0)), Mask(6, 0));
    EXPECT_EQ(pixel_count(of_mirror(kMasksHits, catoptric::MirrorId(9))), 0U);
}

} // namespace
} // namespace catoptric::measure
