// Tests of the figures in a report. Each figure is computed again, from pictures rendered
// separately and by code that shares nothing with the engine.
#include "compare.hpp"
#include "measure/flip.hpp"
#include "measure/masks.hpp"
#include "measure/statistics.hpp"
#include "report/writer.hpp"
#include "scene/built_in.hpp"
#include "support/refusal.hpp"
#include "support/rendering.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <numeric>

namespace {

using namespace catoptric;
using nlohmann::json;

constexpr uvec2 kReportPictureSize{40, 30};
constexpr int kReportFrameCount = 8, kReportWarmupFrames = 3;
const std::vector<std::size_t> kFramesOfRounds{2, 2, 1, 1, 1, 1}; ///< measured frames in each round
constexpr double kExposureStops = -1;

/// Returns the test scene `make_mirror_hall` with a camera that sees the lamp.
scene::Scene make_hall_with_visible_lamp() {
    scene::Scene scene = test::make_mirror_hall();
    scene.cameras.front().target = {0, .5, 0};
    return scene;
}

study::CompareRequest make_report_request(const std::vector<std::string>& rows) {
    study::CompareRequest request;
    request.base = test::make_test_request(make_hall_with_visible_lamp(), rows, kReportPictureSize);
    request.base.frames = kReportFrameCount, request.base.warmup = kReportWarmupFrames;
    request.base.exposure = kExposureStops;
    return request;
}

json compare_and_read_report(const study::CompareRequest& request) {
    return json::parse(report::to_json(study::compare(test::get_test_engine(), request)));
}

session::TechniqueResult render_report_row(const std::string& technique) {
    session::Request request = test::make_test_request(make_hall_with_visible_lamp(), {technique},
                                                       kReportPictureSize);
    request.frames = kReportFrameCount, request.warmup = kReportWarmupFrames;
    request.exposure = kExposureStops;
    return std::move(session::run(test::get_test_engine(), request).parts.front());
}

/// Returns whether a figure includes a pixel, given the first and second mirror that its ray meets;
/// 0: none.
using Chosen = std::function<bool(unsigned, unsigned)>;

/// Returns the FLIP map of two pictures as they are displayed, without rounding to eight bits.
std::vector<float> flip_map_of_results(const session::TechniqueResult& a,
                                       const session::TechniqueResult& b, double stops) {
    return measure::flip(measure::to_unrounded_display(a.hdr, stops),
                         measure::to_unrounded_display(b.hdr, stops));
}

/// Checks the error figures against their definitions: linear colours times the exposure, clamped
/// to [0,1], over the chosen pixels and all channels.
void expect_error_figures(const json& found, const session::TechniqueResult& part,
                          const session::TechniqueResult& truth,
                          const std::vector<std::uint32_t>& hits, const Chosen& chosen) {
    const std::vector<float> map = flip_map_of_results(part, truth, kExposureStops);
    const double gain = std::exp2(kExposureStops);
    double squares = 0, sum = 0, flip = 0;
    std::vector<std::pair<double, std::size_t>> largest;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (!chosen(hits[i] & 0xffff, hits[i] >> 16)) continue;
        double most = 0;
        for (int c = 0; c < 3; ++c) {
            const double a = std::clamp<double>(gain * part.hdr.pixels[i][c], 0, 1);
            const double b = std::clamp<double>(gain * truth.hdr.pixels[i][c], 0, 1);
            squares += (a - b) * (a - b), sum += std::abs(a - b);
            most = std::max(most, std::abs(a - b));
        }
        flip += map[i];
        largest.emplace_back(most, i);
    }
    const auto count = static_cast<double>(largest.size());
    ASSERT_GT(count, 0);
    EXPECT_EQ(found["pixels"], largest.size());
    EXPECT_EQ(found["nonfinite"], 0);
    const double rmse = std::sqrt(squares / (3 * count));
    EXPECT_NEAR(found["rmse"].get<double>(), rmse, 1e-9);
    EXPECT_NEAR(found["mae"].get<double>(), sum / (3 * count), 1e-9);
    EXPECT_NEAR(found["flip"].get<double>(), flip / count, 1e-6);
    if (rmse > 0) {
        EXPECT_NEAR(found["psnr"].get<double>(), -20 * std::log10(rmse), 1e-6);
    }
    std::ranges::stable_sort(largest, [](auto a, auto b) { return a.first < b.first; });
    const double position = .99 * (count - 1);
    const auto below = static_cast<std::size_t>(position);
    const double above = largest[std::min(below + 1, largest.size() - 1)].first;
    EXPECT_NEAR(found["p99"].get<double>(),
                largest[below].first +
                    (position - static_cast<double>(below)) * (above - largest[below].first),
                1e-9);
    EXPECT_NEAR(found["max"].get<double>(), largest.back().first, 1e-9);
    const auto first = std::ranges::find(largest, largest.back().first,
                                         &std::pair<double, std::size_t>::first);
    EXPECT_EQ(found["max_at"],
              json({first->second % kReportPictureSize.x, first->second / kReportPictureSize.x}));
}

void expect_mean_figure(const json& found, const measure::Picture& picture, double most) {
    for (int c = 0; c < 3; ++c) {
        double sum = 0;
        for (const vec3& pixel : picture.pixels) sum += std::clamp<double>(pixel[c], 0, most);
        EXPECT_NEAR(found[c].get<double>(), sum / static_cast<double>(picture.pixels.size()), 1e-6);
    }
}

TEST(ReportFigures, ErrorsEqualThoseOfSeparatePictures) {
    const std::vector<std::string> rows{"parallax:face=32", "raytrace:depth=1",
                                        "raytrace:depth=1,samples=4"};
    const json document = compare_and_read_report(make_report_request(rows));
    const session::TechniqueResult truth = render_report_row(study::kReference);
    const session::TechniqueResult finer = render_report_row("raytrace:depth=16,samples=4");
    // The first of four rays in a pixel hits nearly always the same mirror as the ray through its
    // centre.
    std::size_t others = 0;
    // Counts of pixels by their second mirror. Each mirror is seen in another, and none in itself.
    std::array<std::size_t, 4> second{};
    for (std::size_t i = 0; i < truth.hits.size(); ++i) {
        others += finer.hits[i] != truth.hits[i] ? 1 : 0;
        const std::uint32_t first = truth.hits[i] & 0xffff, next = truth.hits[i] >> 16;
        ASSERT_LE(std::max(first, next), 3U);
        EXPECT_TRUE(next == 0 || next != first) << i;
        ++second[next];
    }
    for (const std::size_t pixels : second) EXPECT_GT(pixels, 0U);
    EXPECT_GT(others, 0U);
    EXPECT_LT(others, truth.hits.size() / 20);
    const std::map<std::string, Chosen> masks{
        {"error", [](unsigned first, unsigned) { return first != 0; }},
        {"error_first_order", [](unsigned first, unsigned next) { return first && !next; }},
        {"error_mirror_in_mirror", [](unsigned first, unsigned next) { return first && next; }},
        {"error_non_mirror", [](unsigned first, unsigned) { return first == 0; }},
        {"error_all", [](unsigned, unsigned) { return true; }}};
    for (std::size_t i = 0; i < rows.size(); ++i) {
        SCOPED_TRACE(rows[i]);
        const json& row = document["rows"][i];
        const session::TechniqueResult part = render_report_row(rows[i]);
        // The reference uses the row's own number of samples.
        const session::TechniqueResult& wanted = i == 2 ? finer : truth;
        for (const auto& [name, chosen] : masks) {
            SCOPED_TRACE(name);
            expect_error_figures(row[name], part, wanted, truth.hits, chosen);
        }
        ASSERT_EQ(row["error_per_mirror"].size(), 3U);
        for (unsigned mirror = 1; mirror <= 3; ++mirror) {
            SCOPED_TRACE(mirror);
            EXPECT_EQ(row["error_per_mirror"][mirror - 1]["mirror"], mirror);
            expect_error_figures(row["error_per_mirror"][mirror - 1], part, wanted, truth.hits,
                                 [&](unsigned first, unsigned) { return first == mirror; });
        }
        expect_mean_figure(row["mean"], part.hdr, 1e9);
        expect_mean_figure(row["mean_clamped"], part.hdr, 1);
        EXPECT_NE(row["mean"], row["mean_clamped"]) << "the lamp is in view";
        EXPECT_EQ(row["scene_passes"], part.scene_passes);
        EXPECT_EQ(row["scene_draws"], part.scene_draws);
        EXPECT_EQ(row["memory_bytes"], part.memory_bytes);
        EXPECT_EQ(row["is_reference"], false);
    }
}

/// A row's reference must have the row's own sample count, whatever rows come before it.
TEST(ReportFigures, RowIsComparedAtItsOwnSampleCount) {
    const std::vector<std::string> rows{"raytrace:depth=16,samples=4", "raytrace:depth=16",
                                        "raytrace:depth=16,samples=9", "reuse:face=32"};
    const json document = compare_and_read_report(make_report_request(rows));
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(document["rows"][i]["error_all"]["max"], 0) << rows[i];
        EXPECT_EQ(document["rows"][i]["is_reference"], true) << rows[i];
    }
    const session::TechniqueResult truth = render_report_row(study::kReference);
    expect_error_figures(document["rows"][3]["error"], render_report_row(rows[3]), truth,
                         truth.hits, [](unsigned first, unsigned) { return first != 0; });
}

/// Returns the percentile of samples, interpolated linearly between the two nearest of the sorted
/// samples.
double percentile_of_samples(std::vector<double> samples, double fraction) {
    std::ranges::sort(samples);
    const double position = fraction * static_cast<double>(samples.size() - 1);
    const auto below = static_cast<std::size_t>(position);
    if (below + 1 == samples.size()) return samples.back();
    return std::lerp(samples[below], samples[below + 1], position - static_cast<double>(below));
}

/// Checks a summary of times. `frames`: number of frames in each round; empty: the row was measured
/// without rounds.
void expect_time_summary(const json& found, const std::vector<std::size_t>& frames) {
    const auto samples = found["samples"].get<std::vector<double>>();
    ASSERT_EQ(samples.size(), std::size_t{kReportFrameCount});
    EXPECT_EQ(found["n"], samples.size());
    const double median = percentile_of_samples(samples, .5);
    std::vector<double> rounds;
    for (auto from = samples.begin(); const std::size_t count : frames) {
        const auto end = from + static_cast<std::ptrdiff_t>(count);
        rounds.push_back(percentile_of_samples({from, end}, .5));
        from = end;
    }
    EXPECT_EQ(found["rounds"].get<std::vector<double>>(), rounds);
    EXPECT_DOUBLE_EQ(found["median"].get<double>(),
                     rounds.empty() ? median : percentile_of_samples(rounds, .5));
    if (rounds.size() == 6) {
        EXPECT_EQ(found["ci95"][0], *std::ranges::min_element(rounds));
        EXPECT_EQ(found["ci95"][1], *std::ranges::max_element(rounds));
    } else {
        EXPECT_TRUE(found["ci95"].is_null());
    }
    EXPECT_DOUBLE_EQ(found["p05"].get<double>(), percentile_of_samples(samples, .05));
    EXPECT_DOUBLE_EQ(found["p95"].get<double>(), percentile_of_samples(samples, .95));
    std::vector<double> off;
    for (const double sample : samples) off.push_back(std::abs(sample - median));
    EXPECT_NEAR(found["mad"].get<double>(), percentile_of_samples(off, .5), 1e-12);
}

/// Returns the GPU time of all passes of a row in measured frame `k`, in ms.
double sum_of_pass_times(const json& row, int k) {
    double sum = 0;
    for (const json& pass : row["passes"]) sum += pass["gpu_ms"]["samples"][k].get<double>();
    return sum;
}

TEST(ReportFigures, TimesEqualThoseOfFramesAndPasses) {
    const json document = compare_and_read_report(
        make_report_request({"parallax:face=32", "raytrace"}));
    for (const json& row : document["rows"]) {
        SCOPED_TRACE(row["label"]);
        for (const char* name :
             {"gpu_ms", "cpu_record_ms", "wall_ms", "closure", "host_ms", "frame_ms", "wait_ms"})
            expect_time_summary(row[name], kFramesOfRounds);
        if (test::get_test_engine().device().type == "cpu") {
            expect_time_summary(row["cpu_ms"], kFramesOfRounds);
            EXPECT_GE(row["cpu_ms"]["median"].get<double>(), row["host_parts"]["record"]);
        }
        for (const json& pass : row["passes"]) expect_time_summary(pass["gpu_ms"], kFramesOfRounds);
        for (int k = 0; k < kReportFrameCount; ++k) {
            const double passes = sum_of_pass_times(row, k);
            const double gpu = row["gpu_ms"]["samples"][k], wall = row["wall_ms"]["samples"][k];
            EXPECT_NEAR(row["closure"]["samples"][k].get<double>(), passes / wall, 1e-9);
            EXPECT_LE(passes, gpu * (1 + 1e-9)) << "passes lie between the first and last stamp";
            EXPECT_LE(gpu, wall) << "stamps lie between submit and fence";
            const double host = row["host_ms"]["samples"][k];
            EXPECT_NEAR(row["frame_ms"]["samples"][k].get<double>(), host + gpu, 1e-9);
            EXPECT_LE(row["cpu_record_ms"]["samples"][k].get<double>(), host);
            EXPECT_LE(row["wait_ms"]["samples"][k].get<double>(), wall)
                << "for this frame, not for one of the warm-up";
        }
    }
    const json& setup = document["setup"];
    EXPECT_TRUE(setup["load_ms"].is_null()) << "nobody has read a file";
    EXPECT_GT(setup["upload_ms"], 0);
    EXPECT_GT(setup["hierarchy_ms"], 0);
    EXPECT_GE(setup["compile_ms"], 0);
    EXPECT_GE(setup["pipelines"], 0) << "those of other tests are there";
    EXPECT_EQ(setup["pipeline_cache"], "none");
    expect_time_summary(document["reference"]["gpu_ms"], {});
}

/// The report states how far a picture of pixel centres is from the mean over the pixels.
TEST(ReportFigures, ReferenceStatesItsDistanceFromTheMeanOverPixels) {
    study::CompareRequest request = make_report_request({"parallax:face=32"});
    const json document = compare_and_read_report(request);
    const measure::Picture centre =
        test::render_technique(request.base.scene, "raytrace:depth=16", kReportPictureSize).hdr;
    const session::TechniqueResult area = test::render_technique(
        request.base.scene, "raytrace:depth=16,samples=16", kReportPictureSize);
    const std::vector<float> map = measure::flip(
        measure::to_unrounded_display(centre, request.base.exposure),
        measure::to_unrounded_display(area.hdr, request.base.exposure));
    const measure::Mask mirrors = measure::mask_mirrors(
        test::render_technique(request.base.scene, "raytrace:depth=1", kReportPictureSize).hits);
    EXPECT_GT(measure::flip_mean(map, mirrors), .001);
    EXPECT_NEAR(document["reference"]["area_flip"], measure::flip_mean(map, mirrors), 1e-7);
    // The distance from the mean over pixels is not stated for other references: the first has four
    // samples a pixel, and the other two cannot trace 16 samples a pixel.
    for (const char* other : {"raytrace:depth=16,samples=4", "raytrace:depth=4,first=raster",
                              "raytrace:depth=4,rays=8192"}) {
        request.reference = other;
        if (request.reference.find("rays=8192") != std::string::npos) request.base.size = {8, 6};
        const json found = compare_and_read_report(request);
        EXPECT_TRUE(found["complete"]) << other;
        EXPECT_TRUE(found["reference"]["area_flip"].is_null()) << other;
    }
}

/// The host's work for a moving scene must be reported in the parts of the frame to which the work
/// belongs.
TEST(ReportFigures, MovingSceneNeedsHostWork) {
    study::CompareRequest request = make_report_request({"parallax:face=32", "raytrace"});
    const json still = compare_and_read_report(request);
    request.base.scene = scene::make_cornell(); // a scene with a moving ball
    request.base.camera = request.base.scene.cameras.front();
    request.base.animate = true;
    const json moving = compare_and_read_report(request);
    for (const json& row : still["rows"]) {
        EXPECT_FALSE(row.contains("moves"));
        EXPECT_EQ(row["host_parts"]["update"], 0) << "nothing is written for a still frame";
    }
    for (const json& row : moving["rows"]) {
        EXPECT_EQ(row["moves"], true);
        EXPECT_GT(row["host_parts"]["update"], 0);
        EXPECT_GT(row["host_parts"]["record"], 0);
    }
    const json &parallax = moving["rows"][0], &raytrace = moving["rows"][1];
    EXPECT_GT(raytrace["host_parts"]["hierarchy"].get<double>(),
              10 * parallax["host_parts"]["hierarchy"].get<double>())
        << "raster rows make no tree";
}

/// With fewer frames than rounds, each frame is a round. Five rounds give no confidence interval.
TEST(ReportFigures, FewFramesAreOneRoundEach) {
    study::CompareRequest request = make_report_request({"reuse:face=32"});
    request.base.frames = 5;
    const json document = compare_and_read_report(request);
    EXPECT_EQ(document["rounds"], 5);
    const json& times = document["rows"][0]["gpu_ms"];
    EXPECT_EQ(times["rounds"], times["samples"]);
    EXPECT_TRUE(times["ci95"].is_null());
    request.rounds = 5;
    EXPECT_EQ(
        test::catch_error_text(Failure::usage, [&] { compare_and_read_report(request); }),
        "rounds: wanted at least 6, because fewer give no 95 % interval of the median, found 5");
}

/// Rows take turns in rounds, but each row must show what it shows when measured alone: it keeps
/// its own history, frame number and clock. Its picture is that of its last frame.
TEST(ReportFigures, RowContinuesFromRoundToRound) {
    const std::vector<std::string> rows{"reuse:face=32", "pyramid:face=auto", "raytrace",
                                        "naive:face=16", "reuse:face=16"};
    study::CompareRequest request;
    request.base = test::make_test_request(scene::make_cornell(), rows, kReportPictureSize);
    request.base.camera = request.base.scene.cameras.front();
    request.base.animate = true;
    request.base.frames = kReportFrameCount, request.base.warmup = kReportWarmupFrames;
    std::vector<int> pictured;
    request.on_finished_row = [&](const report::Comparison& so_far) {
        pictured.push_back(so_far.rows.back().pictured);
    };
    const report::Comparison compared = study::compare(test::get_test_engine(), request);
    EXPECT_EQ(pictured, (std::vector<int>{5, 5, 5, 5, 5, 5, 5, 5, 5, 11}))
        << "told after each row of the first round, then after each round";
    for (std::size_t i = 0; i < rows.size(); ++i) {
        session::Request alone = request.base;
        alone.techniques = {rows[i]};
        const session::TechniqueResult part = std::move(
            session::run(test::get_test_engine(), alone).parts.front());
        EXPECT_TRUE(test::have_equal_pixel_bytes(compared.rows[i].hdr, part.hdr)) << rows[i];
        alone.techniques = {"raytrace:depth=16"};
        alone.time = alone.instant(alone.total()), alone.animate = false;
        alone.frames = 1, alone.warmup = 0;
        const session::TechniqueResult truth = std::move(
            session::run(test::get_test_engine(), alone).parts.front());
        const std::vector<float> map = flip_map_of_results(part, truth, request.base.exposure);
        EXPECT_EQ(compared.rows[i].flip_map, map) << rows[i];
    }
}

TEST(ReportFigures, RowCostsItsOwnPassesWhenRowsShareAFrame) {
    study::CompareRequest request = make_report_request({"parallax:face=32", "raytrace"});
    request.together = true;
    const json document = compare_and_read_report(request);
    for (int k = 0; k < kReportFrameCount; ++k) {
        double all = 0;
        for (const json& row : document["rows"]) {
            EXPECT_NEAR(row["gpu_ms"]["samples"][k].get<double>(), sum_of_pass_times(row, k), 1e-9);
            all += sum_of_pass_times(row, k);
        }
        // Closure: time of all passes over that of the whole frame.
        for (const json& row : document["rows"])
            EXPECT_NEAR(row["closure"]["samples"][k].get<double>(),
                        all / row["wall_ms"]["samples"][k].get<double>(), 1e-9);
    }
}

/// In every second round, rows run in reverse order, so that no row always follows the same row. On
/// a graphics card, the first round is measured again at the end. The repeated round must not
/// change pictures, errors and calls of `on_finished_row`.
TEST(Rounds, FirstRoundIsMeasuredAgainOnRequest) {
    study::CompareRequest request = make_report_request({"reuse:face=16", "raytrace:depth=1"});
    request.base.animate = true;
    std::vector<std::string> again;
    std::size_t calls = 0, measurements = 0;
    request.on_finished_row = [&](const report::Comparison&) { ++calls; };
    request.watcher.on_row = [&](const std::string& label, std::size_t index, std::size_t count) {
        if (label.ends_with(", first round again")) again.push_back(label);
        EXPECT_LT(index, count) << label;
        if (label.find("round") != std::string::npos) {
            EXPECT_EQ(index, measurements++) << label;
        }
    };
    for (const bool together : {false, true}) {
        request.together = together;
        report::Comparison found[2];
        std::size_t called[2];
        for (const bool repeats : {false, true}) {
            request.repeats_first_round = repeats;
            calls = measurements = 0, again.clear();
            found[repeats] = study::compare(test::get_test_engine(), request);
            called[repeats] = calls;
            const std::vector<std::string> wanted =
                !repeats   ? std::vector<std::string>{}
                : together ? std::vector<std::string>{"all rows in one frame, first round again"}
                           : std::vector<std::string>{"reuse:face=16, first round again",
                                                      "raytrace:depth=1, first round again"};
            EXPECT_EQ(again, wanted);
        }
        EXPECT_EQ(called[0], called[1]);
        for (std::size_t row = 0; row < 2; ++row) {
            const report::Row &once = found[0].rows[row], &twice = found[1].rows[row];
            EXPECT_TRUE(test::have_equal_pixel_bytes(once.hdr, twice.hdr));
            EXPECT_EQ(once.pictured, twice.pictured);
            EXPECT_EQ(once.flip_map, twice.flip_map);
            EXPECT_EQ(once.gpu_ms.samples.size(), twice.gpu_ms.samples.size());
            EXPECT_EQ(twice.gpu_ms.rounds.size(), 6u);
        }
    }
}

/// If a signal stops the run during the repeated first round, rows keep the times of the earlier
/// rounds.
TEST(Rounds, StopInTheRepeatedRoundKeepsAllRows) {
    study::CompareRequest request = make_report_request({"reuse:face=16", "raytrace:depth=1"});
    std::atomic<int> signal = 0;
    request.watcher.stop = &signal;
    request.repeats_first_round = true;
    std::vector<double> times;
    request.on_finished_row = [&](const report::Comparison& so_far) {
        times.clear();
        for (const report::Row& row : so_far.rows) times.push_back(row.gpu_ms.rounds.front());
    };
    request.watcher.on_row = [&](const std::string& label, std::size_t, std::size_t) {
        if (label == "raytrace:depth=1, first round again") signal = 2;
    };
    const report::Comparison found = study::compare(test::get_test_engine(), request);
    ASSERT_TRUE(found.stopped);
    ASSERT_EQ(found.rows.size(), 2u);
    for (std::size_t row = 0; row < 2; ++row)
        EXPECT_EQ(found.rows[row].gpu_ms.rounds.front(), times[row]);
}

TEST(Rounds, OrderOfRowsAlternates) {
    study::CompareRequest request = make_report_request(
        {"reuse:face=16,shadow_map=16", "raytrace:depth=1"});
    std::vector<std::string> measured;
    request.watcher.on_row = [&](const std::string& label, std::size_t, std::size_t) {
        if (label.find(", round ") != std::string::npos)
            measured.push_back(label.substr(0, label.find(':')));
    };
    const report::Comparison found = study::compare(test::get_test_engine(), request);
    ASSERT_EQ(measured.size(), 2 * kFramesOfRounds.size());
    for (std::size_t i = 0; i < measured.size(); ++i)
        EXPECT_EQ(measured[i], i % 4 == 0 || i % 4 == 3 ? "reuse" : "raytrace") << i;
    EXPECT_EQ(found.rows[0].technique, "reuse");
    EXPECT_EQ(found.rows[1].technique, "raytrace");
}

} // namespace
