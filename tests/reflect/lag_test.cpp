// Tests of lag: the error of pictures whose captures show the previous frame of a moving scene.
#include "measure/flip.hpp"
#include "measure/lag.hpp"
#include "report/comparison.hpp"
#include "scene/built_in.hpp"
#include "study/lag.hpp"
#include "support/rendering.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <iostream>

namespace {

using namespace catoptric;
using testing::ElementsAre;

using measure::Difference;

constexpr uvec2 kLagPictureSize{64, 64};
constexpr auto kFlipMetric = &Difference::flip, kRmseMember = &Difference::rmse;

study::LagRequest make_lag_request(const scene::Scene& scene,
                                   const std::vector<std::string>& techniques,
                                   const std::vector<double>& speeds, int most_instants = 30) {
    return {.base = test::make_test_request(scene, techniques, kLagPictureSize),
            .speeds = speeds,
            .most_instants = most_instants};
}

void measure_lag_of_request(const study::LagRequest& request, report::LagResults& lag) {
    session::Session session(test::get_test_engine(), request.base.scene);
    study::measure_lag(session, request, lag);
}

report::LagResults measure_lag_results(const study::LagRequest& request) {
    report::LagResults lag;
    measure_lag_of_request(request, lag);
    return lag;
}

void expect_no_lag(const report::LagResults& lag, std::size_t rows, std::size_t speeds) {
    ASSERT_EQ(lag.rows.size(), rows);
    for (const report::LagRow& row : lag.rows) {
        EXPECT_FALSE(row.worst) << row.label;
        EXPECT_EQ(row.restless_stills, 0) << row.label;
        ASSERT_EQ(row.speeds.size(), speeds) << row.label;
        for (const report::LagAtSpeed& at : row.speeds) {
            for (const auto figure :
                 {kFlipMetric, &Difference::off, &Difference::mae, kRmseMember}) {
                const std::vector<double> errors = measure::values_at_instants(at.errors, figure);
                EXPECT_THAT(errors, testing::Each(0.0)) << row.label << " at " << at.speed;
                EXPECT_EQ(errors.size(), lag.seconds.size());
                EXPECT_EQ(measure::values_at_instants(at.reference_errors, figure),
                          measure::values_at_instants(row.still_reference_errors, figure))
                    << row.label << " at " << at.speed;
            }
            EXPECT_EQ(measure::percentile_over_instants(at.errors, kFlipMetric, 1), 0);
        }
    }
}

TEST(Lag, StillSceneHasNoLagAtAnySpeed) {
    const report::LagResults lag = measure_lag_results(make_lag_request(
        test::make_lit_room(3, 1), {"reuse:face=32", "secant:face=32"}, {0.25, 1, 8}));
    EXPECT_THAT(lag.seconds, ElementsAre(0.0))
        << "where nothing moves, one instant is all there is";
    expect_no_lag(lag, 2, 3);
    for (const report::LagRow& row : lag.rows) {
        EXPECT_EQ(row.after_jump.max_settled, 1) << "a jump of nothing";
        EXPECT_GT(row.still_reference_errors[0].flip, 0)
            << "its error against the reference is another matter";
    }
    EXPECT_GT(lag.rows[0].after_black.max_settled, 1) << "three mirrors see each other";
}

/// The lag is the difference of pictures with the same random rays, so it is exactly 0 in a still
/// scene, also with a noisy reference. The noise halves if the number of rays is multiplied by
/// four.
TEST(Lag, NoisyReferenceStatesItsFloorAndAddsNoLag) {
    const auto measure_floor = [](const std::string& reference) {
        scene::Scene room = test::make_lit_room(2, 1);
        test::make_mirrors_rough(room, .3F);
        study::LagRequest request = make_lag_request(room, {"secant:face=32,rough=rays,rays=2"},
                                                     {1, 8});
        request.reference = reference;
        const report::LagResults lag = measure_lag_results(request);
        expect_no_lag(lag, 1, 2);
        return lag.reference_flip_floor;
    };
    const double few = measure_floor("raytrace:depth=4,rays=4"),
                 many = measure_floor("raytrace:depth=4,rays=64");
    EXPECT_GT(few, 0);
    EXPECT_LT(many, few / 2) << "16 times the rays have a quarter of the noise";
    EXPECT_TRUE(std::isnan(measure_floor("raytrace:depth=4")));
    study::LagRequest sharp = make_lag_request(test::make_lit_room(2, 1), {"reuse:face=32"}, {1});
    sharp.reference = "raytrace:depth=4,rays=4";
    EXPECT_TRUE(std::isnan(measure_lag_results(sharp).reference_flip_floor)) << "no rough surface";
}

TEST(Lag, ReferenceHasAsManyRaysAsFitIntoItsSeconds) {
    const auto measure_rays = [](double seconds) {
        scene::Scene room = test::make_lit_room(2, 1);
        test::make_mirrors_rough(room, .3F);
        study::LagRequest request = make_lag_request(room, {"reuse:face=16"}, {8}, 1);
        request.reference = "raytrace:depth=2,rays=256";
        request.reference_seconds = seconds;
        const report::LagResults lag = measure_lag_results(request);
        EXPECT_EQ(lag.wanted_reference_rays, 256);
        return std::pair(lag.reference_rays, lag.reference_flip_floor);
    };
    const auto [few, noise_of_few] = measure_rays(1e-6);
    const auto [many, noise_of_many] = measure_rays(1e6);
    EXPECT_EQ(few, 1);
    EXPECT_EQ(many, 256);
    EXPECT_GT(noise_of_few, 4 * noise_of_many);
}

/// A capture shows the surroundings of the present frame. Only other mirrors in the capture come
/// from the frame before, and this scene has no other mirror.
TEST(Lag, SingleMovingMirrorHasNoLag) {
    scene::Scene scene = test::make_lit_room(1, 1);
    scene.objects.back().motion = scene::HarmonicMotion{.amplitude = {.2, .4, 0}, .period = 1.6};
    const report::LagResults lag = measure_lag_results(
        make_lag_request(scene, {"reuse:face=32", "parallax:face=32"}, {1, 4}, 6));
    ASSERT_EQ(lag.seconds.size(), 6u);
    expect_no_lag(lag, 2, 2);
    for (const report::LagRow& row : lag.rows) {
        EXPECT_EQ(row.still_frames, 1);
        for (const report::SettlingAfterCut& cut : {row.after_black, row.after_jump}) {
            EXPECT_EQ(cut.rmse_settled, 1);
            EXPECT_EQ(cut.max_settled, 1);
        }
        EXPECT_NE(row.still_reference_errors[0].rmse, row.still_reference_errors[3].rmse)
            << "the picture does change";
    }
}

/// The scene has a large moving mirror that is seen in another mirror. Its lamps are no brighter
/// than white, because the image of a brighter lamp in one pixel would dominate the error.
TEST(Lag, LagGrowsWithSpeed) {
    scene::Scene scene = test::make_lit_room(2, 1);
    scene.objects.back().motion = scene::HarmonicMotion{.amplitude = {0, .3, 0}, .period = 4};
    for (scene::Material& material : scene.materials) material.emission /= 9.0f;
    study::LagRequest request = make_lag_request(scene, {"reuse:face=64"}, {2, 4, 8}, 10);
    request.base.ambient = .5;
    const report::LagResults lag = measure_lag_results(request);
    ASSERT_EQ(lag.seconds.size(), 10u);
    EXPECT_DOUBLE_EQ(lag.path, 4);
    EXPECT_DOUBLE_EQ(lag.jump_from, 2);
    ASSERT_EQ(lag.rows.size(), 1u);
    const std::vector<report::LagAtSpeed>& speeds = lag.rows[0].speeds;
    ASSERT_EQ(speeds.size(), 3u);
    for (const auto figure : {kRmseMember, kFlipMetric}) {
        const auto mean = [&](std::size_t i) {
            return measure::mean_over_instants(speeds[i].errors, figure);
        };
        std::cout << "[ MEASURED ] lag of reuse, " << (figure == kFlipMetric ? "FLIP" : "rmse")
                  << " at 2x " << mean(0) << ", 4x " << mean(1) << ", 8x " << mean(2) << "\n";
        EXPECT_GT(mean(0), 0);
        EXPECT_GT(mean(1), 1.4 * mean(0));
        EXPECT_GT(mean(2), 1.4 * mean(1));
    }
    // The kept pictures are those of the largest FLIP of all speeds and instants.
    ASSERT_TRUE(lag.rows[0].worst);
    const measure::WorstLag& worst = *lag.rows[0].worst;
    double largest = 0, speed = 0, instant = 0;
    for (const report::LagAtSpeed& at : speeds)
        for (std::size_t i = 0; i < at.errors.size(); ++i)
            if (at.errors[i].flip > largest)
                largest = at.errors[i].flip, speed = at.speed, instant = lag.seconds[i];
    EXPECT_EQ(worst.flip, largest);
    EXPECT_EQ(worst.speed, speed);
    EXPECT_EQ(worst.seconds, instant);
    const measure::Mask mirrors = measure::mask_mirrors(worst.mirror_hits);
    const auto flip_from = [&](const measure::Picture& other) {
        return measure::difference(worst.moving, other, mirrors,
                                   measure::flip(measure::to_unrounded_display(worst.moving),
                                                 measure::to_unrounded_display(other)))
            .flip;
    };
    EXPECT_NEAR(flip_from(worst.still), largest, 1e-6);
    session::Request traced = request.base;
    traced.techniques = {request.reference}, traced.time = instant;
    EXPECT_TRUE(test::have_equal_pixel_bytes(
        worst.reference, session::run(test::get_test_engine(), traced).parts.front().hdr));
}

/// Checks the lag by another computation: the last frame of an animation against a still picture
/// with the same number of bounces.
TEST(Lag, LagEqualsTheErrorOfAnAnimation) {
    scene::Scene scene = scene::make_cornell();
    scene.objects.back().motion = scene::HarmonicMotion{.amplitude = {0, 50, 0}, .period = .5};
    study::LagRequest request = make_lag_request(scene, {"reuse:face=32"}, {1}, 4);
    request.base.time = .25;
    const report::LagResults lag = measure_lag_results(request);
    ASSERT_EQ(lag.seconds.size(), 4u);
    const double instant = .25 + 8 / 60.0; // 30 frames give four instants, 8 frames apart
    ASSERT_DOUBLE_EQ(lag.seconds[1], instant);

    session::Request moving = test::make_test_request(scene, {"reuse:face=32"}, kLagPictureSize);
    moving.animate = true, moving.warmup = 20, moving.time = instant - 20 / 60.0;
    session::Request still = test::make_test_request(scene, {"naive:face=32,bounces=8"},
                                                     kLagPictureSize),
                     traced = test::make_test_request(scene, {"raytrace"}, kLagPictureSize);
    still.time = traced.time = instant;
    const measure::Mask mirrors = measure::mask_mirrors(
        session::run(test::get_test_engine(), traced).parts.front().hits);
    const session::TechniqueResult
        at_speed = session::run(test::get_test_engine(), moving).parts.front(),
        at_rest = session::run(test::get_test_engine(), still).parts.front();
    const Difference wanted = measure::difference(
        at_speed.hdr, at_rest.hdr, mirrors,
        measure::flip(measure::to_unrounded_display(at_speed.hdr),
                      measure::to_unrounded_display(at_rest.hdr)));
    const Difference& found = lag.rows[0].speeds[0].errors[1];
    EXPECT_GT(wanted.flip, 0);
    EXPECT_NEAR(found.flip, wanted.flip, 1e-6);
    EXPECT_NEAR(found.rmse, wanted.rmse, 1e-6);
    EXPECT_EQ(found.off, wanted.off);
    EXPECT_EQ(found.longest_line, wanted.longest_line);
}

/// Frame k of `reuse` equals `naive` with k bounces byte for byte, as reuse_test.cpp proves. After
/// a black start the picture therefore settles after as many frames as bounces are needed.
TEST(Lag, FramesAfterABlackStartEqualTheBouncesOfNaive) {
    const scene::Scene scene = scene::make_cornell();
    study::LagRequest request = make_lag_request(scene, {"reuse:face=64"}, {8}, 1);
    request.base.size = {128, 128};
    const report::LagResults lag = measure_lag_results(request);
    ASSERT_EQ(lag.rows.size(), 1u);
    const report::SettlingAfterCut& cut = lag.rows[0].after_black;

    const auto naive = [&](int bounces) {
        return test::render_technique(scene, "naive:face=64,bounces=" + std::to_string(bounces),
                                      request.base.size)
            .hdr;
    };
    const measure::Mask mirrors = measure::mask_mirrors(
        test::render_technique(scene, "raytrace", request.base.size).hits);
    const measure::Picture converged = naive(8);
    int rmse_settled = 0,
        max_settled = 0; // first number of bounces from which the error stays within 1/255
    for (int k = 1; k <= 8; ++k) {
        const measure::Difference error = measure::difference(
            k < 8 ? naive(k) : converged, converged, mirrors, std::vector<float>(mirrors.size()));
        EXPECT_EQ(cut.rmse[static_cast<std::size_t>(k) - 1], error.rmse) << k;
        EXPECT_EQ(cut.max[static_cast<std::size_t>(k) - 1], error.max) << k;
        if (!(error.rmse <= 1 / 255.0)) rmse_settled = k + 1;
        if (!(error.max <= 1 / 255.0)) max_settled = k + 1;
    }
    std::cout << "[ MEASURED ] frames after black until within 1/255: " << rmse_settled
              << " by rmse, " << max_settled << " in every pixel\n";
    EXPECT_EQ(cut.rmse_settled, rmse_settled);
    EXPECT_EQ(cut.max_settled, max_settled);
    EXPECT_GT(max_settled, rmse_settled);
}

TEST(Lag, RowsWithoutHistoryAreNotMeasured) {
    const report::LagResults lag = measure_lag_results(make_lag_request(
        test::make_lit_room(2, 1), {"naive:face=32", "raytrace", "reuse:face=32"}, {1}));
    EXPECT_THAT(lag.without_history, ElementsAre("naive:face=32", "raytrace"));
    ASSERT_EQ(lag.rows.size(), 1u);
    EXPECT_EQ(lag.rows[0].label, "reuse:face=32");
    EXPECT_TRUE(lag.complete);
}

TEST(Lag, InvalidRequestsAreRefused) {
    const auto refused = [](const study::LagRequest& request,
                            const std::vector<std::string>& words) {
        test::expect_error([&] { measure_lag_results(request); }, Failure::usage, words);
    };
    const scene::Scene scene = test::make_lit_room(1, 1);
    refused(make_lag_request(scene, {"reuse"}, {3, 8}),
            {"whole number of times into the fastest, 8", "found 3"});
    refused(make_lag_request(scene, {"reuse"}, {0, 1}), {"positive speeds", "found 0"});
    refused(make_lag_request(scene, {"reuse"}, {-1, 1}), {"positive speeds", "found -1"});
    refused(make_lag_request(scene, {"reuse"}, {}), {"at least one speed"});
    refused(make_lag_request(scene, {"reuse"}, {1}, 0), {"at least one instant, found 0"});
    refused(make_lag_request(scene, {}, {1}), {"no technique"});
    refused(make_lag_request(scene, {"reuse", "parallx"}, {1}),
            {"'parallx'", "did you mean 'parallax'"});
}

TEST(Lag, FinishedRowsAreKeptWhenStopped) {
    study::LagRequest request = make_lag_request(test::make_lit_room(2, 1),
                                                 {"reuse:face=32", "parallax:face=32"}, {1, 2});
    std::atomic<int> signal{0};
    request.watcher.stop = &signal;
    request.watcher.on_row = [&](const std::string& label, std::size_t, std::size_t count) {
        EXPECT_EQ(count, 3u) << "the reference and two rows";
        if (label == "lag of parallax:face=32") signal = 2;
    };
    int finished = 0;
    request.on_finished_row = [&] { ++finished; };
    report::LagResults lag;
    test::expect_error([&] { measure_lag_of_request(request, lag); }, Failure::interrupted,
                       {"signal 2"});
    EXPECT_EQ(finished, 1);
    EXPECT_FALSE(lag.complete);
    ASSERT_EQ(lag.rows.size(), 1u);
    EXPECT_EQ(lag.rows[0].speeds.size(), 2u);
}

} // namespace
