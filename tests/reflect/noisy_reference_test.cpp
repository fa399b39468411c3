// Tests of comparisons with a noisy reference, whose rays have random directions in lobes. The
// tests check the noise of the reference and the error bars of the rows.
#include "compare.hpp"
#include "measure/halves.hpp"
#include "measure/metric.hpp"
#include "report/comparison.hpp"
#include "report/writer.hpp"
#include "scene/classify.hpp"
#include "study/choose.hpp"
#include "study/reference_cache.hpp"
#include "support/folder.hpp"
#include "support/refusal.hpp"
#include "support/rendering.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <iostream>

namespace {

using namespace catoptric;

/// Returns an environment of patches, whose edges make the noise of drawn rays large.
std::shared_ptr<scene::Environment> make_patched_environment() {
    auto map = std::make_shared<scene::Environment>();
    map->size = {32, 16};
    for (std::uint32_t row = 0; row < map->size.y; ++row)
        for (std::uint32_t column = 0; column < map->size.x; ++column)
            map->texels.push_back((row / 2 + column / 3) % 2 == 0 ? vec3(.7f, .5f, .6f)
                                                                  : vec3(.1f, .2f, .15f));
    return map;
}

/// Returns a scene of a metal floor of the given roughness, below an environment of patches. The
/// floor fills the picture.
scene::Scene make_metal_floor_below_patches(float roughness) {
    scene::Scene scene{.name = "patched floor"};
    scene.mirror_max_roughness = 1;
    const std::size_t metal = test::add_material(
        scene, {.name = "metal", .albedo = vec3(.9f), .metallic = 1, .roughness = roughness});
    test::add_quad(scene, "floor", metal, {-50, 0, 50}, {50, 0, 50}, {50, 0, -50}, {-50, 0, -50});
    scene.environment = make_patched_environment();
    scene.cameras.push_back(
        {.eye = {0, 3, 4}, .target = {0, 0, 0}, .up = {0, 1, 0}, .vertical_fov_degrees = 40});
    scene::find_mirrors(scene);
    return scene;
}

/// Traces pictures of one scene with different seeds.
class SeededTracer {
public:
    SeededTracer(const scene::Scene& scene, uvec2 size)
        : traced_session_(test::get_test_engine(), scene),
          spec_(test::make_test_request(scene, {}, size)) {}
    measure::Picture trace_picture(int rays, int seed) {
        spec_.techniques = {"raytrace:depth=2,rays=" + std::to_string(rays) +
                            ",seed=" + std::to_string(seed)};
        return traced_session_.frame(spec_).hdr();
    }

private:
    session::Session traced_session_;
    session::FrameSpec spec_;
};

TEST(NoisyReference, SeedsGiveIndependentPicturesOfTheSameMean) {
    SeededTracer tracer(make_metal_floor_below_patches(.4f), {32, 32});
    const measure::Picture one = tracer.trace_picture(4, 1), again = tracer.trace_picture(4, 1),
                           two = tracer.trace_picture(4, 2), none = tracer.trace_picture(4, 0);
    EXPECT_TRUE(test::have_equal_pixel_bytes(one, again));
    EXPECT_FALSE(test::have_equal_pixel_bytes(one, two));
    EXPECT_FALSE(test::have_equal_pixel_bytes(one, none));
    EXPECT_NEAR(measure::mean_of(one, measure::ValueRange::unclamped).all,
                measure::mean_of(two, measure::ValueRange::unclamped).all, .01);
}

TEST(NoisyReference, DifferenceOfTheHalvesFallsByTwoPerQuadrupling) {
    SeededTracer tracer(make_metal_floor_below_patches(.4f), {48, 48});
    measure::PictureMean a, b;
    std::vector<double> rmse, predicted;
    int seed = 0;
    for (int frames = 1; frames <= 16; ++frames) {
        a.add(tracer.trace_picture(64, ++seed));
        b.add(tracer.trace_picture(64, ++seed));
        if (frames != 1 && frames != 4 && frames != 16) continue;
        rmse.push_back(test::rmse_of_pictures(a.mean(), b.mean()));
        double sum = 0;
        for (std::size_t i = 0; i < a.mean().pixels.size(); ++i) {
            const vec3 both = a.variance().pixels[i] + b.variance().pixels[i];
            sum += double(both.x + both.y + both.z) / 3;
            if (frames == 1) break; // one frame has no variance yet
        }
        predicted.push_back(std::sqrt(sum / double(a.mean().pixels.size())));
    }
    std::cout << "[ MEASURED ] rmse between halves of 64, 256 and 1024 rays: " << rmse[0] << ", "
              << rmse[1] << ", " << rmse[2] << "; predicted by the variance: " << predicted[1]
              << ", " << predicted[2] << '\n';
    EXPECT_NEAR(rmse[0] / rmse[1], 2, .15);
    EXPECT_NEAR(rmse[1] / rmse[2], 2, .15);
    EXPECT_NEAR(predicted[2] / rmse[2], 1, .05);
}

/// The test takes the error against a picture with 16 times as many rays and other seeds as the
/// true error.
TEST(NoisyReference, IntervalHoldsTheTrueErrorInSeventeenOfTwentyDraws) {
    constexpr int kRaysPerPixel = 16;
    SeededTracer tracer(make_metal_floor_below_patches(.4f), {64, 64});
    const measure::Picture row = tracer.trace_picture(1, 1000);
    const auto estimate = [&](int rays, int seed) {
        return measure::estimate_noise_free(
            row,
            measure::make_halves(tracer.trace_picture(rays, seed),
                                 tracer.trace_picture(rays, seed + 1), 0),
            {}, std::vector<float>(row.pixels.size(), 0.f));
    };
    const double truth = estimate(16 * kRaysPerPixel, 2000).squared_error;
    int held = 0, held_by_deviation = 0;
    double width = 0, deviation = 0;
    for (int k = 0; k < 20; ++k) {
        const measure::NoiseFreeError found = estimate(kRaysPerPixel, 1 + 2 * k);
        held += found.ci95.low <= truth && truth <= found.ci95.high;
        width += (found.ci95.high - found.ci95.low) / 20;
        held_by_deviation += std::abs(found.squared_error - truth) <= 1.96 * found.deviation;
        deviation += found.deviation / 20;
    }
    std::cout << "[ MEASURED ] " << held << " of 20 intervals hold the squared error " << truth
              << ", mean width " << width << "; held by the deviation " << held_by_deviation
              << ", mean " << deviation << '\n';
    EXPECT_GE(held, 17);
    EXPECT_GE(held_by_deviation, 17);
    EXPECT_LT(width, truth) << "an interval that wide says nothing";
}

study::CompareRequest make_rough_floor_request(const std::vector<std::string>& rows,
                                               double seconds) {
    study::CompareRequest request;
    request.base = test::make_test_request(make_metal_floor_below_patches(.3f), rows, {64, 64});
    request.reference_seconds = seconds;
    return request;
}

/// If the reference used the seed of a row, its first half would equal the row's picture, and the
/// row's error would be 0.
TEST(NoisyReference, SharesNoSeedWithARow) {
    study::CompareRequest request = make_rough_floor_request(
        {"raytrace:depth=2,rays=4,seed=1", "raytrace:depth=2,rays=4,seed=2"}, 0);
    request.reference = "raytrace:depth=2,rays=4";
    const report::Comparison found = study::compare(test::get_test_engine(), request);
    ASSERT_TRUE(found.noise);
    EXPECT_EQ(found.noise->frames, 1);
    for (const report::Row& row : found.rows) {
        // Computes the noise of a picture with 4 rays per pixel. A half of the reference with one
        // frame has the same noise.
        const double noise = found.noise->halves_rmse / std::sqrt(2.);
        EXPECT_NEAR(row.error.rmse, noise, .25 * noise) << row.label;
    }
}

TEST(NoisyReference, GrowsUntilItIsAFifthOfTheLeastErrorOrTimeIsOver) {
    study::CompareRequest request = make_rough_floor_request({"reuse:face=16"}, 60);
    request.reference = "raytrace:depth=2,rays=1";
    std::vector<std::string> told;
    request.watcher.on_row = [&](const std::string& label, std::size_t index, std::size_t count) {
        EXPECT_LE(index, count);
        told.push_back(label);
    };
    const report::Comparison found = study::compare(test::get_test_engine(), request);
    ASSERT_TRUE(found.noise);
    ASSERT_FALSE(found.stopped);
    EXPECT_GT(found.noise->frames, 1);
    EXPECT_LT(found.noise->seconds, 60);
    EXPECT_TRUE(found.noise->is_target_reached());
    EXPECT_DOUBLE_EQ(found.noise->wanted_floor, .2 * found.rows[0].error.flip);
    EXPECT_EQ(found.rows[0].error.flip_floor, found.noise->flip_floor);
    EXPECT_NEAR(found.noise->predicted_rmse / found.noise->halves_rmse, 1, .2);
    EXPECT_THAT(told, testing::Contains(testing::HasSubstr("frames a half")));
    EXPECT_GT(measure::study_metric(found.rows[0], measure::kNoiseMetricName).index(), 0u);

    request.reference_seconds = 0;
    const report::Comparison brief = study::compare(test::get_test_engine(), request);
    EXPECT_EQ(brief.noise->frames, 1);
    EXPECT_FALSE(brief.noise->is_target_reached());
    EXPECT_GT(brief.noise->flip_floor, found.noise->flip_floor);
}

TEST(NoisyReference, IsTheDefaultForRoughMirrorsOnly) {
    study::CompareRequest request = make_rough_floor_request({"reuse:face=16"}, 0);
    request.base.size = {32, 32};
    const report::Comparison rough = study::compare(test::get_test_engine(), request);
    EXPECT_EQ(rough.reference_label, study::kRoughReference);
    EXPECT_TRUE(rough.noise);
    request.reference = "raytrace:depth=16";
    EXPECT_FALSE(study::compare(test::get_test_engine(), request).noise);
    request.base.scene = make_metal_floor_below_patches(.04f);
    request.reference = "";
    const report::Comparison sharp = study::compare(test::get_test_engine(), request);
    EXPECT_EQ(sharp.reference_label, study::kReference);
    // A scene of perfect mirrors has no noise, even if the reference has the knob `rays`.
    request.reference = "raytrace:depth=16,rays=2";
    const report::Comparison drawn = study::compare(test::get_test_engine(), request);
    for (const report::Comparison* without : {&sharp, &drawn}) {
        EXPECT_FALSE(without->noise);
        EXPECT_THAT(report::to_json(*without), testing::Not(testing::HasSubstr("noise")));
        EXPECT_EQ(without->rows[0].error.rmse, sharp.rows[0].error.rmse);
        EXPECT_EQ(without->rows[0].error.flip, sharp.rows[0].error.flip);
    }
}

using NoisyReferenceInFolder = test::InFolder;

TEST_F(NoisyReferenceInFolder, FileContinuesTheHalves) {
    study::CompareRequest request = make_rough_floor_request({"reuse:face=16"}, 0);
    request.base.size = {32, 32};
    request.reference = "raytrace:depth=2,rays=2";
    request.reference_file = (folder / "halves.exr").string();
    const report::Comparison first = study::compare(test::get_test_engine(), request),
                             again = study::compare(test::get_test_engine(), request);
    EXPECT_EQ(again.noise->frames, 1);
    EXPECT_EQ(again.rows[0].error.rmse, first.rows[0].error.rmse);
    request.reference_seconds = .2; // enough for at least one more frame of each half
    const report::Comparison longer = study::compare(test::get_test_engine(), request);
    EXPECT_GT(longer.noise->frames, 1);
    EXPECT_LT(longer.noise->halves_rmse, first.noise->halves_rmse);
    request.base.size = {16, 32};
    EXPECT_THAT(test::catch_error_text(Failure::bad_data,
                                       [&] { study::compare(test::get_test_engine(), request); }),
                testing::HasSubstr("the size 16x32"));
    request.base.size = {32, 32};
    request.base.techniques = {"raytrace:depth=2,rays=2,seed=1"};
    EXPECT_THAT(test::catch_error_text(Failure::usage,
                                       [&] { study::compare(test::get_test_engine(), request); }),
                testing::HasSubstr("the seed 1"));
    request.reference = "raytrace:depth=2";
    EXPECT_THAT(test::catch_error_text(Failure::usage,
                                       [&] { study::compare(test::get_test_engine(), request); }),
                testing::HasSubstr("wanted a reference with noise"));
}

TEST(NoisyReference, ViewsAreJudgedByHalvesAsWell) {
    study::CompareRequest request = make_rough_floor_request({"reuse:face=16"}, 0);
    request.base.size = {32, 32};
    request.reference = "raytrace:depth=2,rays=2";
    request.studies = {{"views", 6}};
    const report::Comparison found = study::compare(test::get_test_engine(), request);
    ASSERT_EQ(found.rows[0].views.size(), 6u);
    for (const measure::Errors& view : found.rows[0].views) EXPECT_GT(view.error.flip_floor, 0);
}

study::ChooseRequest make_rough_choose_request(double seconds) {
    study::ChooseRequest request;
    request.base = test::make_test_request(make_metal_floor_below_patches(.3f), {}, {24, 24});
    request.base.frames = 6, request.base.warmup = 1;
    request.reference = "raytrace:depth=2,rays=1";
    request.reference_seconds = seconds;
    request.share = .5, request.confidence = .9; // 6 views prove it
    request.max_error = .5;
    return request;
}

/// `choose` adds frames to the reference of each view, until the noise floor is a fifth of the
/// limit. Otherwise the certificate says that the floor was not reached, and the noise counts as
/// error.
TEST(NoisyReference, ProofReducesTheNoiseOfEachViewToAFifthOfTheLimit) {
    for (const study::ErrorQuantity quantity :
         {study::ErrorQuantity::flip, study::ErrorQuantity::rmse}) {
        study::ChooseRequest request = make_rough_choose_request(600);
        request.quantity = quantity;
        const study::PlanProof quiet = study::prove_plan(test::get_test_engine(), request,
                                                         "reuse:face=16");
        ASSERT_TRUE(quiet.noise);
        EXPECT_DOUBLE_EQ(quiet.noise->wanted_floor.value_or(0), .1);
        EXPECT_LE(quiet.noise->largest_floor, .1);
        EXPECT_GT(quiet.noise->median_floor, 0);
        EXPECT_EQ(quiet.noise->views_above, 0u);
        EXPECT_EQ(quiet.plan.errors.size(), 6u);
        request.max_error = .01;
        request.reference_seconds = 0;
        const study::PlanProof noisy = study::prove_plan(test::get_test_engine(), request,
                                                         "reuse:face=16");
        ASSERT_TRUE(noisy.noise);
        EXPECT_EQ(noisy.noise->views_above, 6u);
        EXPECT_GT(noisy.noise->median_floor, quiet.noise->median_floor);
        EXPECT_GT(noisy.plan.largest_error, quiet.plan.largest_error);
        EXPECT_FALSE(noisy.keeps_error);
    }
}

} // namespace
