// Compares ray tracing of the built-in scene with figures from two independent renderers. The
// ambient light is 0, the picture has 512x512 pixels, and balls are meshes.
#include "support/outside_figures.hpp"

namespace {

using namespace catoptric;

using test::expect_share_of_pixels_within, test::trace_cornell_mirrors;

/// Takes minutes, because six depths are rendered with 400 samples each.
TEST(OutsideFigures, MeansAndErrorsOfEachDepthEqualTheFigures) {
    struct TracedRayFigures {
        int depth;
        double mean, clamped, rmse; ///< expected figures; 0: no figure is known
        double rmse_share;
    };
    const std::vector<TracedRayFigures> figures{{0, .108822, .044025, .1031, .05},
                                                {1, .119884, .048826, .0369, .05},
                                                {2, .120575, .049228, .0129, .05},
                                                {3, 0, 0, .0044, .05},
                                                {4, .120648, .049291, .0007, .30}};
    const session::TechniqueResult deep = trace_cornell_mirrors(8, 400);
    const measure::Mask mirrors = measure::mask_mirrors(trace_cornell_mirrors(0, 1).hits);
    const auto mean = [](const session::TechniqueResult& part, measure::ValueRange range) {
        return measure::mean_of(part.hdr, range).all;
    };
    expect_share_of_pixels_within("mean at depth 8", mean(deep, measure::ValueRange::unclamped),
                                  .120650, .003);
    expect_share_of_pixels_within("clamped mean at depth 8",
                                  mean(deep, measure::ValueRange::clamped), .049292, .003);
    for (const auto& [depth, wanted, clamped, rmse, rmse_share] : figures) {
        const session::TechniqueResult part = trace_cornell_mirrors(depth, 400);
        const std::string at = " at depth " + std::to_string(depth);
        if (wanted > 0)
            expect_share_of_pixels_within("mean" + at, mean(part, measure::ValueRange::unclamped),
                                          wanted, .003);
        if (clamped > 0)
            expect_share_of_pixels_within("clamped mean" + at,
                                          mean(part, measure::ValueRange::clamped), clamped, .003);
        expect_share_of_pixels_within("rmse against depth 8" + at,
                                      test::rmse_of_pictures(part.hdr, deep.hdr, mirrors), rmse,
                                      rmse_share);
    }
}

} // namespace
