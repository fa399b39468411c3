#include "measure/masks.hpp"

#include <gtest/gtest.h>

#include <array>

namespace catoptric::measure {
namespace {

constexpr std::uint32_t hit(std::uint32_t first, std::uint32_t second) {
    return first | second << 16;
}

// wall; mirror 1 that sees a wall; mirror 2 that sees mirror 1; mirror 1 that sees itself
// (concave); the largest number there is; a polished floor that reflects, but is no mirror.
constexpr std::array<std::uint32_t, 6> kHits = {hit(0, 0), hit(1, 0),     hit(2, 1),
                                                hit(1, 1), hit(65535, 0), hit(0, 7)};

TEST(Masks, ChooseByTheFirstTwoHits) {
    EXPECT_EQ(all_pixels(kHits), (Mask{255, 255, 255, 255, 255, 255}));
    EXPECT_EQ(mirrors(kHits), (Mask{0, 255, 255, 255, 255, 0}));
    EXPECT_EQ(first_order(kHits), (Mask{0, 255, 0, 0, 255, 0}));
    EXPECT_EQ(mirror_in_mirror(kHits), (Mask{0, 0, 255, 255, 0, 0}));
    EXPECT_EQ(of_mirror(kHits, catoptric::MirrorId(1)), (Mask{0, 255, 0, 255, 0, 0}));
    EXPECT_EQ(of_mirror(kHits, catoptric::MirrorId(65535)), (Mask{0, 0, 0, 0, 255, 0}));
    EXPECT_EQ(non_mirror(kHits), (Mask{255, 0, 0, 0, 0, 255}));
    EXPECT_EQ(dielectrics(kHits), (Mask{0, 0, 0, 0, 0, 255}));
}

TEST(Masks, PartitionThePicture) {
    EXPECT_EQ(pixel_count(mirrors(kHits)) + pixel_count(non_mirror(kHits)), kHits.size());
    EXPECT_EQ(pixel_count(first_order(kHits)) + pixel_count(mirror_in_mirror(kHits)),
              pixel_count(mirrors(kHits)));
    EXPECT_EQ(pixel_count(of_mirror(kHits, catoptric::MirrorId(1))) +
                  pixel_count(of_mirror(kHits, catoptric::MirrorId(2))) +
                  pixel_count(of_mirror(kHits, catoptric::MirrorId(65535))),
              pixel_count(mirrors(kHits)));
}

TEST(Masks, NothingChosenIsNotTheEmptyMask) {
    EXPECT_EQ(of_mirror(kHits, catoptric::MirrorId(9)), Mask(6, 0));
    EXPECT_EQ(of_mirror(kHits, catoptric::MirrorId(0)), Mask(6, 0)); // numbers count from 1
    EXPECT_EQ(pixel_count(of_mirror(kHits, catoptric::MirrorId(9))), 0U);
}

} // namespace
} // namespace catoptric::measure
