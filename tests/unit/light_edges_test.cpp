// Tests of splitting an rmse into two parts: pixels at the outlines of lights, and all other
// pixels.
#include "measure/light_edges.hpp"

#include "measure/comparison.hpp"
#include "report_sample.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>
#include <random>

namespace {

using namespace catoptric::measure;
using catoptric::vec3;

constexpr int kLightEdgePictureWidth = 8, kHeight = 5;
const std::vector<float> kZeroFlipMap(kLightEdgePictureWidth* kHeight, 0.0F);

Picture make_noise_picture(std::uint32_t seed) {
    std::mt19937 random(seed);
    Picture picture(kLightEdgePictureWidth, kHeight);
    for (vec3& pixel : picture.pixels)
        for (int c = 0; c < 3; ++c) pixel[c] = static_cast<float>(random() % 1000) / 999;
    return picture;
}

/// The rmse of mirror pixels split by a mask of light outlines, and the difference over all mirror
/// pixels.
struct LightEdgeErrorSplit {
    LightEdgeErrors edges;
    Difference all;
};

LightEdgeErrorSplit split_error_at_mask(const Picture& a, const Picture& b, const Mask& mirrors,
                                        Mask there) {
    Mask elsewhere = mirrors;
    for (std::size_t i = 0; i < there.size(); ++i) {
        if (mirrors[i] == 0) there[i] = 0;
        if (there[i] != 0) elsewhere[i] = 0;
    }
    return {split_by_light_edges(difference(a, b, there, kZeroFlipMap),
                                 difference(a, b, elsewhere, kZeroFlipMap)),
            difference(a, b, mirrors, kZeroFlipMap)};
}

TEST(LightEdges, SquaredPartsAddUpToTheSquaredRmse) {
    std::mt19937 random(7);
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        Mask mirrors(kLightEdgePictureWidth * kHeight), there(mirrors.size());
        for (std::size_t i = 0; i < mirrors.size(); ++i) {
            mirrors[i] = random() % 3 > 0 ? 255 : 0;
            there[i] = random() % 4 == 0 ? 255 : 0;
        }
        Picture a = make_noise_picture(seed);
        a.pixels[seed].x =
            std::numeric_limits<float>::quiet_NaN(); // a NaN pixel counts in neither part
        const LightEdgeErrorSplit found = split_error_at_mask(a, make_noise_picture(seed + 100),
                                                              mirrors, there);
        const double whole = found.all.rmse * found.all.rmse;
        EXPECT_NEAR(found.edges.rmse * found.edges.rmse +
                        found.edges.rest_rmse * found.edges.rest_rmse,
                    whole, 1e-12 * whole);
        EXPECT_NEAR(found.edges.rmse * found.edges.rmse, found.edges.share * whole, 1e-12 * whole);
    }
}

/// Four pixels show mirrors. The pixel at a light outline is wrong by .3 in each channel, another
/// pixel by .1.
TEST(LightEdges, ErrorsAreAssignedToLightOutlinesOrToTheRest) {
    Picture a(kLightEdgePictureWidth, kHeight);
    const Picture black(kLightEdgePictureWidth, kHeight);
    Mask mirrors(kLightEdgePictureWidth * kHeight), there(mirrors.size());
    for (const std::size_t i : {3U, 10U, 11U, 30U}) mirrors[i] = 255;
    a.pixels[10] = vec3(.3F), a.pixels[30] = vec3(.1F);
    a.pixels[20] = vec3(1); // this pixel shows no mirror
    there[10] = there[20] = 255;
    const LightEdgeErrors found = split_error_at_mask(a, black, mirrors, there).edges;
    EXPECT_NEAR(found.rmse, .3 / 2, 1e-7);
    EXPECT_NEAR(found.rest_rmse, .1 / 2, 1e-7);
    EXPECT_NEAR(found.share, .9, 1e-6);
    EXPECT_EQ(found.pixels, .25);
}

TEST(LightEdges, FiguresAreZeroWithoutErrorAndNanWithoutPixels) {
    const Picture black(kLightEdgePictureWidth, kHeight);
    const Mask some(kLightEdgePictureWidth * kHeight, 255), none(some.size());
    EXPECT_EQ(split_error_at_mask(black, black, some, some).edges.share, 0);
    EXPECT_EQ(split_error_at_mask(black, black, some, some).edges.rest_rmse, 0);
    EXPECT_EQ(split_error_at_mask(black, black, some, none).edges.pixels, 0);
    const LightEdgeErrors nothing = split_error_at_mask(black, black, none, some).edges;
    for (const double figure : {nothing.rmse, nothing.rest_rmse, nothing.share, nothing.pixels})
        EXPECT_TRUE(std::isnan(figure));
}

/// Rows without captures have no figures for light outlines, so the report contains null.
TEST(LightEdges, UnmeasuredLightEdgesAreNullInTheReport) {
    using namespace catoptric::report;
    const auto rows = nlohmann::json::parse(to_json(sample::make_usual_comparison()))["rows"];
    EXPECT_TRUE(rows[0]["light_edges"].is_null());
}

} // namespace
