// Tests of printed figures: each test computes the figures again from the written pictures and
// compares.
#include "cli/program.hpp"

#include "measure/picture_file.hpp"

#include <algorithm>
#include <cmath>

namespace {

using catoptric::measure::Picture;
using catoptric::measure::read_picture;
using nlohmann::json;

/// Returns the mean of each channel over the pixels that `counts` accepts. Values are clamped to
/// [0, `most`].
std::vector<double> mean_colour_of_pixels(const Picture& picture, double most,
                                          const std::function<bool(std::size_t)>& counts) {
    std::vector<double> sum(3);
    double pixels = 0;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        if (!counts(i)) continue;
        ++pixels;
        for (int c = 0; c < 3; ++c) sum[c] += std::clamp<double>(picture.pixels[i][c], 0, most);
    }
    for (double& channel : sum) channel /= pixels;
    return sum;
}

bool accept_every_pixel(std::size_t) { return true; }

void expect_near_numbers(const json& found, const std::vector<double>& wanted) {
    ASSERT_EQ(found.size(), wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i)
        EXPECT_NEAR(found[i].get<double>(), wanted[i], 1e-6) << i;
}

TEST_F(CommandLineTest, RenderReportsThePicturesMeanAndThePassesTimes) {
    const test::ProcessResult ended = run_cli({"render", "--technique", "parallax:face=32", "-o",
                                               "x.exr", "--size", "48x32", "--frames", "3",
                                               "--warmup", "1", "--trace", "t.json", "--json"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const json document = json::parse(ended.out);
    const Picture picture = read_picture(folder / "x.exr");
    expect_near_numbers(document["mean"], mean_colour_of_pixels(picture, 1e9, accept_every_pixel));
    expect_near_numbers(document["mean_clamped"],
                        mean_colour_of_pixels(picture, 1, accept_every_pixel));
    EXPECT_NE(document["mean"], document["mean_clamped"]) << "the lamp is in view";

    const json trace = json::parse(read_output_file("t.json"));
    std::size_t pass = 0;
    double first = 0, end = 0; // microseconds
    for (const json& event : trace["traceEvents"]) {
        if (event["ph"] != "X") continue;
        const json& said = document["passes"][pass];
        EXPECT_EQ(event["name"], said["name"]);
        const double last = said["gpu_ms"]["samples"][2];
        EXPECT_NEAR(event["dur"].get<double>(), 1000 * last, 1e-6) << event;
        if (pass == 0) first = event["ts"];
        EXPECT_GE(event["ts"].get<double>(), end - 1e-6) << event;
        end = event["ts"].get<double>() + event["dur"].get<double>();
        ++pass;
    }
    EXPECT_EQ(pass, document["passes"].size());
    EXPECT_NEAR(end - first, 1000 * document["gpu_ms"]["samples"][2].get<double>(), 1e-6);
}

TEST_F(CommandLineTest, DiffFiguresMatchThePicturesUnderTheMask) {
    for (const std::string technique : {"reuse:face=32", "raytrace"})
        ASSERT_EQ(run_cli(add_small_frame_options({"render", "--technique", technique, "-o",
                                                   technique.substr(0, 5) + ".exr"}))
                      .exit_code,
                  0);
    ASSERT_EQ(run_cli(add_small_frame_options(
                          {"render", "--technique", "naive:bounces=0", "-o", "mask.png"}))
                  .exit_code,
              0); // mirrors and background are black, so they are masked out
    const json found = json::parse(
        run_cli({"diff", "reuse.exr", "raytr.exr", "--mask", "mask.png", "--json"}).out);
    const Picture a = read_picture(folder / "reuse.exr"), b = read_picture(folder / "raytr.exr"),
                  mask = read_picture(folder / "mask.png");
    const auto counts = [&](std::size_t i) { return mask.pixels[i] != catoptric::vec3(0); };
    double squares = 0, sum = 0;
    std::vector<std::pair<double, std::size_t>> largest;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        if (!counts(i)) continue;
        double most = 0;
        for (int c = 0; c < 3; ++c) {
            const double off = std::abs(std::clamp<double>(a.pixels[i][c], 0, 1) -
                                        std::clamp<double>(b.pixels[i][c], 0, 1));
            squares += off * off, sum += off, most = std::max(most, off);
        }
        largest.emplace_back(most, i);
    }
    const auto pixels = static_cast<double>(largest.size());
    ASSERT_GT(pixels, 100);
    ASSERT_LT(pixels, 32 * 32) << "the mask leaves nothing out";
    EXPECT_EQ(found["pixels"], largest.size());
    EXPECT_NEAR(found["rmse"].get<double>(), std::sqrt(squares / (3 * pixels)), 1e-9);
    EXPECT_NEAR(found["mae"].get<double>(), sum / (3 * pixels), 1e-9);
    std::ranges::sort(largest);
    EXPECT_NEAR(found["max"].get<double>(), largest.back().first, 1e-9);
    EXPECT_NEAR(found["p99"].get<double>(), largest[std::size_t(.99 * (pixels - 1))].first, 2e-2);
    EXPECT_LT(found["p99"].get<double>(), found["max"].get<double>());
    EXPECT_EQ(found["max_at"], json({largest.back().second % 32, largest.back().second / 32}));
    expect_near_numbers(found["mean"]["a"], mean_colour_of_pixels(a, 1e9, counts));
    expect_near_numbers(found["mean"]["b"], mean_colour_of_pixels(b, 1e9, counts));
    expect_near_numbers(found["mean_clamped"]["a"], mean_colour_of_pixels(a, 1, counts));
    expect_near_numbers(found["mean_clamped"]["b"], mean_colour_of_pixels(b, 1, counts));
    EXPECT_NE(found["flip"],
              json::parse(run_cli({"diff", "reuse.exr", "raytr.exr", "--json"}).out)["flip"]);
}

/// A mask without pixels leaves nothing to compare. `diff` must then fail every threshold.
TEST_F(CommandLineTest, DiffWithAnEmptyMaskFailsEveryThreshold) {
    write_input_file("scene.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    ASSERT_EQ(run_cli(add_small_frame_options({"render", "scene.obj", "--technique", "raytrace",
                                               "--camera", "0,0,9:0,0,20:40", "--environment",
                                               "none", "-o", "black.png"}))
                  .exit_code,
              0);
    ASSERT_EQ(run_cli(add_small_frame_options({"render", "--technique", "raytrace", "-o", "a.exr"}))
                  .exit_code,
              0);
    for (const std::string option : {"--max-flip", "--max-rmse"}) {
        const test::ProcessResult ended = run_cli(
            {"diff", "a.exr", "a.exr", "--mask", "black.png", option, "1"});
        EXPECT_EQ(ended.exit_code, 1) << option;
        EXPECT_THAT(ended.err, testing::HasSubstr("nan is over " + option + " 1"));
    }
    const json found = json::parse(
        run_cli({"diff", "a.exr", "a.exr", "--mask", "black.png", "--json"}).out);
    EXPECT_EQ(found["pixels"], 0);
    for (const char* figure : {"rmse", "mae", "flip", "max"}) EXPECT_TRUE(found[figure].is_null());
}

} // namespace
