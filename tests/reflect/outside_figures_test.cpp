// Ray tracing of the built-in scene against figures of two independent renderers: ambient 0,
// 512x512, balls as meshes.
#include "support/outside_figures.hpp"

namespace {

using namespace catoptric;

using test::expect_share, test::trace;

/// All rays: from the camera, reflected, and to the light.
double rays(const app::Part& part) {
    return static_cast<double>(part.rays->primary + part.rays->mirror + part.rays->shadow);
}

TEST(OutsideFigures, RaysAtAndBeyondDepthZero) {
    const app::Part direct = trace(0, 1);
    ASSERT_TRUE(direct.rays);
    EXPECT_EQ(direct.rays->primary, 512u * 512u);
    EXPECT_EQ(direct.rays->mirror, 0u);
    expect_share("rays at depth 0", rays(direct), 446960, .001);
    for (const auto& [depth, wanted] :
         {std::pair{1, 57915.0}, {2, 60968.0}, {3, 61291.0}, {4, 61329.0}, {8, 61338.0}}) {
        const app::Part part = trace(depth, 1);
        ASSERT_TRUE(part.rays);
        expect_share("rays beyond that at depth " + std::to_string(depth),
                     rays(part) - rays(direct), wanted, .003);
    }
}

/// Rays through 8 x 8 places of each pixel; errors of each depth with 20 x 20, as they were made
/// outside: tests/long.
TEST(OutsideFigures, MeanOfAllDepths) {
    const app::Part deep = trace(8, 64);
    expect_share("mean at depth 8", measure::mean_of(deep.hdr, measure::Range::unclamped).all,
                 .120650, .003);
    expect_share("clamped mean at depth 8", measure::mean_of(deep.hdr, measure::Range::clamped).all,
                 .049292, .001);
}

} // namespace
