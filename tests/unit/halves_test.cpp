// Tests of errors against a reference with noise, on pictures whose true error is known.
#include "measure/halves.hpp"
#include "measure/judge.hpp"
#include "measure/picture_mean.hpp"
#include "measure/views.hpp"
#include "report/text.hpp"
#include "support/numbers.hpp"
#include "support/refusal.hpp"
#include "unit/report_sample.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <iostream>
#include <vector>

namespace {

using namespace catoptric;
using measure::Picture;
using testing::HasSubstr;
using testing::Not;

constexpr int kTestPictureEdge = 128;

/// Returns a pixel of the picture without noise: brightness changes linearly from .3 to .7.
vec3 noise_free_pixel(int x, int y) {
    return vec3(.3f) + vec3(.2f, .1f, .2f) * (float(x + y) / kTestPictureEdge);
}

Picture make_noise_free_picture() {
    Picture picture(kTestPictureEdge, kTestPictureEdge);
    for (int y = 0; y < kTestPictureEdge; ++y)
        for (int x = 0; x < kTestPictureEdge; ++x) picture.at(x, y) = noise_free_pixel(x, y);
    return picture;
}

/// Returns the picture plus noise of this standard deviation: the mean of four uniform draws, whose
/// distribution is nearly normal.
Picture add_noise(Picture picture, double deviation, test::RandomNumbers& numbers) {
    const auto range = static_cast<float>(deviation * std::sqrt(3.));
    for (vec3& pixel : picture.pixels)
        for (int k = 0; k < 4; ++k) pixel += range / 2 * numbers.random_point_in_cube();
    return picture;
}

/// Returns the true picture with an error of +-.05, in alternating columns. Its squared error is
/// .0025.
Picture make_picture_with_known_error() {
    Picture picture = make_noise_free_picture();
    for (int y = 0; y < kTestPictureEdge; ++y)
        for (int x = 0; x < kTestPictureEdge; ++x)
            picture.at(x, y) += vec3(x % 2 == 0 ? .05f : -.05f);
    return picture;
}
constexpr double kTrueMeanSquaredError = .0025, kNoiseDeviation = .08;

measure::NoiseFreeError estimate_error_of_all_pixels(const Picture& picture, const Picture& a,
                                                     const Picture& b,
                                                     const measure::Mask& mask = {}) {
    measure::NoisyHalves halves{a, b, a, std::vector<float>(a.pixels.size(), .01f)};
    return measure::estimate_noise_free(picture, halves, mask,
                                        std::vector<float>(a.pixels.size(), .02f));
}

double mean_square_difference(const Picture& a, const Picture& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const dvec3 difference = dvec3(a.pixels[i]) - dvec3(b.pixels[i]);
        sum += glm::dot(difference, difference) / 3;
    }
    return sum / double(a.pixels.size());
}

TEST(Halves, HalvesOfAnotherSizeAreRefused) {
    const Picture small(2, 3), wide(4, 3);
    const measure::NoisyHalves halves = measure::make_halves(wide, wide, 0);
    EXPECT_EQ(test::catch_error_text(Failure::bad_data,
                                     [&] {
                                         measure::difference_from_halves(small, halves, {},
                                                                         std::vector<float>(6));
                                     }),
              "halves of a reference: wanted the size of the picture, 2x3, found 4x3");
}

TEST(Halves, MeanAndVarianceAreThoseOfTheSamples) {
    measure::PictureMean mean;
    const float values[] = {1, 4, 2, 5};
    for (const float value : values) {
        Picture picture(2, 1);
        picture.pixels = {vec3(value, 2 * value, 0), vec3(7)};
        mean.add(picture);
    }
    EXPECT_EQ(mean.count(), 4);
    EXPECT_EQ(mean.mean().pixels[0], vec3(3, 6, 0));
    // For the variance: the squared deviations 4 + 1 + 1 + 4 = 10 are divided by 3 and by 4.
    EXPECT_FLOAT_EQ(mean.variance().pixels[0].x, 10.f / 12);
    EXPECT_FLOAT_EQ(mean.variance().pixels[0].y, 40.f / 12);
    EXPECT_EQ(mean.variance().pixels[1], vec3(0));
    measure::PictureMean one;
    one.add(Picture(1, 1));
    EXPECT_TRUE(std::isnan(one.variance().pixels[0].x));
    EXPECT_THROW(one.add(Picture(2, 1)), Error);
}

/// The interval must contain the true error, which is known here. An estimate from one half alone
/// is biased and must lie outside the interval.
TEST(Halves, IntervalHoldsTheTrueErrorInSeventeenOfTwentyDraws) {
    const Picture truth = make_noise_free_picture(), wrong = make_picture_with_known_error();
    int held = 0, biased_held = 0, held_by_deviation = 0;
    double mean = 0, width = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        test::RandomNumbers numbers(seed);
        const Picture a = add_noise(truth, kNoiseDeviation, numbers),
                      b = add_noise(truth, kNoiseDeviation, numbers);
        const measure::NoiseFreeError found = estimate_error_of_all_pixels(wrong, a, b);
        ASSERT_TRUE(found.ci95.is_known());
        const auto holds = [&](double square) {
            return found.ci95.low <= square && square <= found.ci95.high;
        };
        held += holds(kTrueMeanSquaredError);
        biased_held += holds(mean_square_difference(wrong, a));
        held_by_deviation += std::abs(found.squared_error - kTrueMeanSquaredError) <=
                             1.96 * found.deviation;
        mean += found.squared_error / 20;
        width += (found.ci95.high - found.ci95.low) / 20;
        EXPECT_NEAR(found.unclamped, found.squared_error, 1e-4);
        EXPECT_NEAR(found.halves_rmse, std::sqrt(2.) * kNoiseDeviation, .002);
    }
    std::cout << "[ MEASURED ] " << held << " of 20 intervals hold the true error, " << biased_held
              << " that of one half; mean estimate " << mean << " of " << kTrueMeanSquaredError
              << ", mean width " << width << ", held by the deviation " << held_by_deviation
              << '\n';
    EXPECT_GE(held, 17);
    EXPECT_GE(held_by_deviation, 17);
    EXPECT_EQ(biased_held, 0);
    EXPECT_NEAR(mean, kTrueMeanSquaredError, 5e-5);
    // Computes 4 standard errors of the mean of 49152 products. The variance of the product (e -
    // n)(e - m) = e^2 - e(n + m) + nm is 2 e^2 s^2 + s^4.
    const double e = kTrueMeanSquaredError, s = kNoiseDeviation * kNoiseDeviation;
    const double wanted = 4 * std::sqrt((2 * e * s + s * s) /
                                        (3. * kTestPictureEdge * kTestPictureEdge));
    EXPECT_NEAR(width, wanted, .25 * wanted);
}

/// Pictures whose errors differ in kind. `truth` is the picture without noise.
std::vector<std::pair<const char*, Picture>>
make_pictures_with_errors(const Picture& truth, test::RandomNumbers& numbers) {
    Picture shifted = truth, lines = make_picture_with_known_error(), clipped = truth;
    for (vec3& pixel : shifted.pixels) pixel += vec3(.1f, .05f, -.05f);
    for (vec3& pixel : clipped.pixels) pixel = glm::min(pixel, vec3(.45f));
    return {{"perfect", truth},
            {"shifted", shifted},
            {"lines", lines},
            {"clipped", clipped},
            {"noise of few rays", add_noise(truth, .1, numbers)}};
}

/// The bounds decide whether a view keeps the limit of a certificate. Noise must never make a view
/// pass that fails without noise. FLIP against one half may be too small, for example if the
/// picture itself has noise, so the bound adds the noise floor.
TEST(Halves, BoundsAreNeverBelowTheTrueError) {
    const Picture truth = make_noise_free_picture();
    int flip_of_halves_too_small = 0, unbiased_too_small = 0;
    double widest = 0;
    for (const double deviation : {.005, .02, .08})
        for (std::uint64_t seed = 1; seed <= 4; ++seed) {
            test::RandomNumbers numbers(seed);
            for (const auto& [kind, picture] : make_pictures_with_errors(truth, numbers)) {
                SCOPED_TRACE(testing::Message() << kind << " " << deviation << " " << seed);
                const std::vector<float> map = measure::flip(measure::to_unrounded_display(picture),
                                                             measure::to_unrounded_display(truth));
                const measure::Difference wanted = measure::difference(picture, truth, {}, map);
                const measure::NoisyHalves halves = measure::make_halves(
                    add_noise(truth, deviation, numbers), add_noise(truth, deviation, numbers), 0);
                const measure::Difference found = measure::difference_from_halves(
                    picture, halves, {}, measure::flip_against_halves(picture, halves, 0));
                EXPECT_GE(measure::rmse_bound(found), wanted.rmse);
                EXPECT_GE(measure::flip_bound(found), wanted.flip);
                flip_of_halves_too_small += found.flip < wanted.flip;
                unbiased_too_small += found.rmse < wanted.rmse;
                if (deviation < .01)
                    widest = std::max(widest, measure::rmse_bound(found) - wanted.rmse);
            }
        }
    std::cout << "[ MEASURED ] of 60 pictures, FLIP against the halves is too small for "
              << flip_of_halves_too_small << ", the unbiased rmse for " << unbiased_too_small
              << "; the bound of rmse is at most " << widest << " too large at noise of .005\n";
    EXPECT_GT(unbiased_too_small, 10); // an unbiased estimate errs to both sides
    EXPECT_GT(flip_of_halves_too_small, 3);
    EXPECT_LT(widest, .003);
}

/// Clamping at 1 lowers the noise of bright halves, and with it the estimate of an error. The bound
/// must hold there, too.
TEST(Halves, BoundHoldsWhereClampingHidesAnError) {
    Picture truth(kTestPictureEdge, kTestPictureEdge), dark = truth;
    for (vec3& pixel : truth.pixels) pixel = vec3(1);
    for (vec3& pixel : dark.pixels) pixel = vec3(.9f);
    test::RandomNumbers numbers(1);
    const measure::NoisyHalves halves = measure::make_halves(add_noise(truth, .08, numbers),
                                                             add_noise(truth, .08, numbers), 0);
    const measure::Difference found = measure::difference_from_halves(
        dark, halves, {}, std::vector<float>(truth.pixels.size(), 0.f));
    EXPECT_LT(found.rmse, .08); // the true rmse is .1
    EXPECT_GE(measure::rmse_bound(found), .1);
}

TEST(Halves, BoundOfFewPixelsIsWideAndBoundWithoutNoiseIsTheError) {
    const Picture truth = make_noise_free_picture(), wrong = make_picture_with_known_error();
    const auto bound = [&](const measure::Mask& mask, double deviation) {
        test::RandomNumbers numbers(3);
        const measure::NoisyHalves halves = measure::make_halves(
            add_noise(truth, deviation, numbers), add_noise(truth, deviation, numbers), 0);
        return measure::rmse_bound(measure::difference_from_halves(
            wrong, halves, mask, std::vector<float>(truth.pixels.size(), 0.f)));
    };
    measure::Mask few(truth.pixels.size(), 0);
    for (std::size_t i = 0; i < 8; ++i) few[i * 1000] = 255;
    EXPECT_GT(bound(few, .02), 1.15 * .05);
    EXPECT_LT(bound({}, .02), 1.05 * .05);
    EXPECT_NEAR(bound({}, 0), .05, 1e-6);
    measure::Difference plain;
    plain.rmse = .1, plain.flip = .2;
    EXPECT_EQ(measure::rmse_bound(plain), .1);
    EXPECT_EQ(measure::flip_bound(plain), .2);
    plain.rmse = -.1, plain.square_margin = .0109; // below the noise: -.01 + .0109
    EXPECT_NEAR(measure::rmse_bound(plain), .03, 1e-9);
}

TEST(Halves, IntervalIsUnknownForFewTiles) {
    const Picture picture = make_noise_free_picture();
    measure::Mask mask(picture.pixels.size(), 0);
    for (int k = 0; k < 9; ++k)
        mask[std::size_t(k) * measure::kBootstrapTileEdge % kTestPictureEdge +
             std::size_t(k / 8) * measure::kBootstrapTileEdge * kTestPictureEdge] = 255;
    EXPECT_FALSE(estimate_error_of_all_pixels(picture, picture, picture, mask).ci95.is_known());
    mask.back() = 255;
    EXPECT_TRUE(estimate_error_of_all_pixels(picture, picture, picture, mask).ci95.is_known());
    const measure::Mask none(picture.pixels.size(), 0);
    EXPECT_TRUE(
        std::isnan(estimate_error_of_all_pixels(picture, picture, picture, none).squared_error));
}

TEST(Halves, CrossingIsTheShareOfPixelsThatClampingBiases) {
    Picture a(4, 1), b(4, 1), x(4, 1);
    a.pixels = {vec3(.5f), vec3(1.5f, .5f, .5f), vec3(2), vec3(3)};
    b.pixels = {vec3(.5f), vec3(.5f), vec3(3), vec3(.5f)};
    x.pixels = {vec3(.5f), vec3(.5f), vec3(1), vec3(1)};
    const measure::NoiseFreeError found = estimate_error_of_all_pixels(x, a, b);
    EXPECT_DOUBLE_EQ(found.crossing, .5);
    EXPECT_DOUBLE_EQ(found.squared_error, 0); // clamped: (1-1)(1-1) and (1-1)(1-.5)
    // Pixel 3: (1-2)(1-3) = 2 in three channels. Pixel 4: (1-3)(1-.5) = -1.
    EXPECT_DOUBLE_EQ(found.unclamped, (3 * 2 - 3 * 1) / 12.);
}

/// Returns the difference of a perfect picture from a reference whose halves lie on both sides of
/// the picture.
measure::Difference make_difference_below_noise() {
    Picture x(kTestPictureEdge, kTestPictureEdge), a = x, b = x;
    for (std::size_t i = 0; i < x.pixels.size(); ++i)
        x.pixels[i] = vec3(.5f), a.pixels[i] = vec3(.6f), b.pixels[i] = vec3(.4f);
    const measure::NoisyHalves halves = measure::make_halves(a, b, 0);
    return measure::difference_from_halves(x, halves, {},
                                           measure::flip_against_halves(x, halves, 0));
}

TEST(Halves, NegativeEstimateReadsBelowTheNoise) {
    const measure::Difference hidden = make_difference_below_noise();
    EXPECT_NEAR(hidden.rmse, -.1, 1e-6);
    EXPECT_FALSE(hidden.psnr);
    EXPECT_GT(hidden.flip_floor, hidden.flip);
    EXPECT_TRUE(measure::is_below_noise(hidden));
    EXPECT_EQ(report::format_error(hidden.rmse), "below the noise");
    EXPECT_THAT(report::format_flip(hidden), HasSubstr(", below the noise"));

    report::Row row = report::sample::make_row("parallax", 5, .1, .1);
    row.error = hidden;
    measure::set_noise(row, {{.squared_error = -.01, .flip = .1, .flip_floor = .2}});
    report::Comparison made = report::sample::make_comparison({row});
    made.studies = {std::string(measure::kNoiseMetricName)};
    made.noise = std::make_shared<measure::ReferenceNoise>();
    made.noise->flip_floor = hidden.flip_floor;
    made.pareto = {0};
    const std::string text = report::sample::report_text_of_comparison(made);
    EXPECT_THAT(text, HasSubstr("| below the noise |")); // rmse in the table of rows
    EXPECT_THAT(text, HasSubstr("Errors against a reference with noise"));
    const std::string page = report::to_html(made);
    EXPECT_THAT(page, HasSubstr("class=\"noise\"")); // the floor of the plot
    EXPECT_THAT(page, HasSubstr("hidden"));
    const auto document = nlohmann::json::parse(report::to_json(made));
    EXPECT_EQ(document["rows"][0]["noise"][0]["mask"], "mirrors");
    EXPECT_EQ(document["rows"][0]["noise"][0]["squared_error"], -.01);
    EXPECT_EQ(document["reference"]["noise"]["flip_floor"], hidden.flip_floor);
}

TEST(Halves, ReportWithoutNoiseSaysNothingOfIt) {
    const report::Comparison usual = report::sample::make_usual_comparison();
    EXPECT_THAT(report::to_json(usual), Not(HasSubstr("noise")));
    EXPECT_THAT(report::to_markdown(usual), Not(HasSubstr("noise")));
    EXPECT_THAT(report::to_csv(usual), Not(HasSubstr("noise")));
}

TEST(Halves, EqualHalvesGiveTheFiguresWithoutNoise) {
    const Picture truth = make_noise_free_picture(), wrong = make_picture_with_known_error();
    const measure::NoisyHalves halves = measure::make_halves(truth, truth, 1);
    const std::vector<float> map = measure::flip_against_halves(wrong, halves, 1);
    Picture shown = wrong;
    for (vec3& pixel : shown.pixels) pixel *= 2;
    const measure::Difference found = measure::difference_from_halves(shown, halves, {}, map),
                              plain = measure::difference(shown, halves.mean, {}, map);
    EXPECT_EQ(map, measure::flip(measure::to_unrounded_display(wrong, 1),
                                 measure::to_unrounded_display(truth, 1)));
    EXPECT_NEAR(found.rmse, plain.rmse, 1e-12);
    EXPECT_NEAR(found.psnr.value_or(0), plain.psnr.value_or(1), 1e-9);
    EXPECT_EQ(found.mae, plain.mae);
    EXPECT_EQ(found.flip, plain.flip);
    EXPECT_EQ(found.flip_floor, 0);
    EXPECT_FALSE(measure::is_below_noise(found));
}

TEST(Halves, DifferencesBelowTheFloorTie) {
    using report::sample::make_row;
    report::Row near = make_row("near", 2, .1, .20), far = make_row("far", 1, .1, .21);
    EXPECT_EQ(measure::compare_flip(near, far), measure::Order::less);
    near.error.flip_floor = far.error.flip_floor = .005;
    EXPECT_EQ(measure::compare_flip(near, far), measure::Order::less);
    near.error.flip_floor = far.error.flip_floor = .02;
    EXPECT_EQ(measure::compare_flip(near, far), measure::Order::equal);
    report::Comparison made = report::sample::make_comparison({near, far});
    EXPECT_TRUE(measure::RowJudge(made.rows).beats(far, near)) << "it is faster and ties in FLIP";
    made.pareto = measure::find_pareto_front(made.rows);
    EXPECT_EQ(made.pareto, std::vector<std::size_t>{1});
    EXPECT_EQ(measure::find_closest_row(made), &made.rows[0]);
    EXPECT_EQ(measure::find_closest_ties(made), std::vector<const measure::Row*>{&made.rows[1]});
    // Over several views, a difference that is below the noise floor in each view counts as none.
    for (int k = 0; k < 6; ++k) {
        made.rows[0].views.push_back(made.rows[0]);
        made.rows[1].views.push_back(made.rows[1]);
    }
    EXPECT_FALSE(measure::rows_differ(made.rows[0], made.rows[1], "flip"));
    for (report::Row& each : made.rows)
        for (measure::Errors& view : each.views) view.error.flip_floor = 0;
    EXPECT_TRUE(measure::rows_differ(made.rows[0], made.rows[1], "flip"));
}

TEST(Halves, WantedFloorIsAFifthOfTheLeastFlipOfARowWithCaptures) {
    report::Row traced = report::sample::make_row("raytrace", 1, .1, .01);
    traced.rays = RayCounts{1, 1, 1};
    const report::Row reuse = report::sample::make_row("reuse", 1, .1, .3),
                      parallax = report::sample::make_row("parallax", 1, .1, .2);
    EXPECT_DOUBLE_EQ(measure::target_noise_floor({&traced, &reuse, &parallax}), .04);
    EXPECT_DOUBLE_EQ(measure::target_noise_floor({&traced}), .002);
    EXPECT_EQ(measure::target_noise_floor({}), 0);
}

} // namespace
