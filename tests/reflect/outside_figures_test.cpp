// Compares ray tracing of the built-in scene with figures from two independent renderers. The
// ambient light is 0, the picture has 512x512 pixels, and balls are meshes.
#include "support/outside_figures.hpp"

namespace {

using namespace catoptric;

using test::expect_share_of_pixels_within, test::trace_cornell_mirrors;

/// Returns the number of all rays: camera rays, reflected rays and shadow rays.
double count_all_rays(const session::TechniqueResult& part) {
    return static_cast<double>(part.rays->primary + part.rays->mirror + part.rays->shadow);
}

TEST(OutsideFigures, RayCountsAtEachDepthEqualTheFigures) {
    const session::TechniqueResult direct = trace_cornell_mirrors(0, 1);
    ASSERT_TRUE(direct.rays);
    EXPECT_EQ(direct.rays->primary, 512u * 512u);
    EXPECT_EQ(direct.rays->mirror, 0u);
    expect_share_of_pixels_within("rays at depth 0", count_all_rays(direct), 446960, .001);
    for (const auto& [depth, wanted] :
         {std::pair{1, 57915.0}, {2, 60968.0}, {3, 61291.0}, {4, 61329.0}, {8, 61338.0}}) {
        const session::TechniqueResult part = trace_cornell_mirrors(depth, 1);
        ASSERT_TRUE(part.rays);
        expect_share_of_pixels_within("rays beyond that at depth " + std::to_string(depth),
                                      count_all_rays(part) - count_all_rays(direct), wanted, .003);
    }
}

/// Tests the mean colour at depth 8 with 8 x 8 samples per pixel. tests/long checks each depth with
/// 20 x 20 samples, as many as the other renderers used.
TEST(OutsideFigures, MeanColourEqualsTheFigures) {
    const session::TechniqueResult deep = trace_cornell_mirrors(8, 64);
    expect_share_of_pixels_within("mean at depth 8",
                                  measure::mean_of(deep.hdr, measure::ValueRange::unclamped).all,
                                  .120650, .003);
    expect_share_of_pixels_within("clamped mean at depth 8",
                                  measure::mean_of(deep.hdr, measure::ValueRange::clamped).all,
                                  .049292, .001);
}

} // namespace
