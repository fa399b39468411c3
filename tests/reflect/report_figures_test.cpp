// What a report says of pictures and times is what these say: every figure is computed again from
// pictures rendered apart, by loops that share nothing with the engine's.
#include "app/compare.hpp"
#include "measure/flip.hpp"
#include "report/report.hpp"
#include "support/refusal.hpp"
#include "support/rendering.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <numeric>

namespace {

using namespace catoptric;
using nlohmann::json;

constexpr uvec2 kSize{40, 30};
constexpr int kFrames = 8, kWarmup = 3;
const std::vector<std::size_t> kRounds{2, 2, 1, 1, 1, 1}; ///< of the frames
constexpr double kStops = -1;

/// The lamp is in view.
scene::Scene bright_hall() {
    scene::Scene scene = test::hall();
    scene.cameras.front().target = {0, .5, 0};
    return scene;
}

app::CompareRequest asked(const std::vector<std::string>& rows) {
    app::CompareRequest request;
    request.base = test::request(bright_hall(), rows, kSize);
    request.base.frames = kFrames, request.base.warmup = kWarmup;
    request.base.exposure = kStops;
    return request;
}

json compared(const app::CompareRequest& request) {
    return json::parse(report::to_json(app::compare(test::engine(), request)));
}

app::Part rendered(const std::string& technique) {
    app::Request request = test::request(bright_hall(), {technique}, kSize);
    request.frames = kFrames, request.warmup = kWarmup;
    request.exposure = kStops;
    return std::move(app::run(test::engine(), request).parts.front());
}

/// Which pixels a figure is about, by the first two mirrors that a ray meets; 0: none.
using Chosen = std::function<bool(unsigned, unsigned)>;

/// FLIP of floats as they are displayed.
std::vector<float> flip_of(const app::Part& a, const app::Part& b, double stops) {
    return measure::flip(measure::to_unrounded_display(a.hdr, stops),
                         measure::to_unrounded_display(b.hdr, stops));
}

/// Computed from the definitions: linear, exposed, clamped, over pixels and channels.
void expect_errors(const json& found, const app::Part& part, const app::Part& truth,
                   const std::vector<std::uint32_t>& hits, const Chosen& chosen) {
    const std::vector<float> map = flip_of(part, truth, kStops);
    const double gain = std::exp2(kStops);
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
    EXPECT_EQ(found["max_at"], json({first->second % kSize.x, first->second / kSize.x}));
}

void expect_mean(const json& found, const measure::Picture& picture, double most) {
    for (int c = 0; c < 3; ++c) {
        double sum = 0;
        for (const vec3& pixel : picture.pixels) sum += std::clamp<double>(pixel[c], 0, most);
        EXPECT_NEAR(found[c].get<double>(), sum / static_cast<double>(picture.pixels.size()), 1e-6);
    }
}

TEST(ReportFigures, AreThoseOfThePictures) {
    const std::vector<std::string> rows{"parallax:face=32", "raytrace:depth=1",
                                        "raytrace:depth=1,samples=4"};
    const json document = compared(asked(rows));
    const app::Part truth = rendered(app::kReference);
    const app::Part finer = rendered("raytrace:depth=16,samples=4");
    // The first of four rays meets nearly everywhere what the one through the middle does.
    std::size_t others = 0;
    std::array<std::size_t, 4> second{}; // by number: all three are seen in others, none in itself
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
        const app::Part part = rendered(rows[i]);
        const app::Part& wanted = i == 2 ? finer : truth; // at the row's own sample count
        for (const auto& [name, chosen] : masks) {
            SCOPED_TRACE(name);
            expect_errors(row[name], part, wanted, truth.hits, chosen);
        }
        ASSERT_EQ(row["error_per_mirror"].size(), 3U);
        for (unsigned mirror = 1; mirror <= 3; ++mirror) {
            SCOPED_TRACE(mirror);
            EXPECT_EQ(row["error_per_mirror"][mirror - 1]["mirror"], mirror);
            expect_errors(row["error_per_mirror"][mirror - 1], part, wanted, truth.hits,
                          [&](unsigned first, unsigned) { return first == mirror; });
        }
        expect_mean(row["mean"], part.hdr, 1e9);
        expect_mean(row["mean_clamped"], part.hdr, 1);
        EXPECT_NE(row["mean"], row["mean_clamped"]) << "the lamp is in view";
        EXPECT_EQ(row["scene_passes"], part.scene_passes);
        EXPECT_EQ(row["scene_draws"], part.scene_draws);
        EXPECT_EQ(row["memory_bytes"], part.memory_bytes);
        EXPECT_EQ(row["is_reference"], false);
    }
}

/// Whatever stands before it in the list.
TEST(ReportFigures, ARowIsJudgedAtItsOwnSampleCount) {
    const std::vector<std::string> rows{"raytrace:depth=16,samples=4", "raytrace:depth=16",
                                        "raytrace:depth=16,samples=9", "reuse:face=32"};
    const json document = compared(asked(rows));
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(document["rows"][i]["error_all"]["max"], 0) << rows[i];
        EXPECT_EQ(document["rows"][i]["is_reference"], true) << rows[i];
    }
    const app::Part truth = rendered(app::kReference);
    expect_errors(document["rows"][3]["error"], rendered(rows[3]), truth, truth.hits,
                  [](unsigned first, unsigned) { return first != 0; });
}

/// Linear between the two nearest of the sorted samples.
double percentile(std::vector<double> samples, double fraction) {
    std::ranges::sort(samples);
    const double position = fraction * static_cast<double>(samples.size() - 1);
    const auto below = static_cast<std::size_t>(position);
    if (below + 1 == samples.size()) return samples.back();
    return std::lerp(samples[below], samples[below + 1], position - static_cast<double>(below));
}

/// `frames` of each round; without rounds it was measured in one go.
void expect_summary(const json& found, const std::vector<std::size_t>& frames) {
    const auto samples = found["samples"].get<std::vector<double>>();
    ASSERT_EQ(samples.size(), std::size_t{kFrames});
    EXPECT_EQ(found["n"], samples.size());
    const double median = percentile(samples, .5);
    std::vector<double> rounds;
    for (auto from = samples.begin(); const std::size_t count : frames) {
        const auto end = from + static_cast<std::ptrdiff_t>(count);
        rounds.push_back(percentile({from, end}, .5));
        from = end;
    }
    EXPECT_EQ(found["rounds"].get<std::vector<double>>(), rounds);
    EXPECT_DOUBLE_EQ(found["median"].get<double>(),
                     rounds.empty() ? median : percentile(rounds, .5));
    if (rounds.size() == 6) {
        EXPECT_EQ(found["ci95"][0], *std::ranges::min_element(rounds));
        EXPECT_EQ(found["ci95"][1], *std::ranges::max_element(rounds));
    } else {
        EXPECT_TRUE(found["ci95"].is_null());
    }
    EXPECT_DOUBLE_EQ(found["p05"].get<double>(), percentile(samples, .05));
    EXPECT_DOUBLE_EQ(found["p95"].get<double>(), percentile(samples, .95));
    std::vector<double> off;
    for (const double sample : samples) off.push_back(std::abs(sample - median));
    EXPECT_NEAR(found["mad"].get<double>(), percentile(off, .5), 1e-12);
}

/// The time of the row's passes in measured frame `k`.
double of_passes(const json& row, int k) {
    double sum = 0;
    for (const json& pass : row["passes"]) sum += pass["gpu_ms"]["samples"][k].get<double>();
    return sum;
}

TEST(ReportFigures, TimesAreThoseOfTheFramesAndTheirPasses) {
    const json document = compared(asked({"parallax:face=32", "raytrace"}));
    for (const json& row : document["rows"]) {
        SCOPED_TRACE(row["label"]);
        for (const char* name :
             {"gpu_ms", "cpu_record_ms", "wall_ms", "closure", "host_ms", "frame_ms", "wait_ms"})
            expect_summary(row[name], kRounds);
        if (test::engine().device().type == "cpu") {
            expect_summary(row["cpu_ms"], kRounds);
            EXPECT_GE(row["cpu_ms"]["median"].get<double>(), row["host_parts"]["record"]);
        }
        for (const json& pass : row["passes"]) expect_summary(pass["gpu_ms"], kRounds);
        for (int k = 0; k < kFrames; ++k) {
            const double passes = of_passes(row, k);
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
    expect_summary(document["reference"]["gpu_ms"], {});
}

/// What a moving scene costs the host is in the parts that it belongs to, and ranks rows.
TEST(ReportFigures, AMovingSceneHasWorkForTheHost) {
    app::CompareRequest request = asked({"parallax:face=32", "raytrace"});
    const json still = compared(request);
    request.base.scene = scene::cornell_mirrors(); // in which a ball moves
    request.base.camera = request.base.scene.cameras.front();
    request.base.animate = true;
    const json moving = compared(request);
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

/// Fewer frames than rounds: one each, and no interval from five.
TEST(ReportFigures, FewFramesAreARoundEach) {
    app::CompareRequest request = asked({"reuse:face=32"});
    request.base.frames = 5;
    const json document = compared(request);
    EXPECT_EQ(document["rounds"], 5);
    const json& times = document["rows"][0]["gpu_ms"];
    EXPECT_EQ(times["rounds"], times["samples"]);
    EXPECT_TRUE(times["ci95"].is_null());
    request.rounds = 5;
    EXPECT_EQ(test::refusal(Failure::usage, [&] { compared(request); }),
              "rounds: wanted at least 6, fewer bound no median, found 5");
}

/// However many rows take turns, each shows what it shows when it is alone: its own history, frame
/// number and clock, and its last picture is that of its last frame.
TEST(ReportFigures, ARowGoesOnFromRoundToRound) {
    const std::vector<std::string> rows{"reuse:face=32", "pyramid:face=auto", "raytrace",
                                        "naive:face=16", "reuse:face=16"};
    app::CompareRequest request;
    request.base = test::request(scene::cornell_mirrors(), rows, kSize);
    request.base.camera = request.base.scene.cameras.front();
    request.base.animate = true;
    request.base.frames = kFrames, request.base.warmup = kWarmup;
    std::vector<int> pictured;
    request.on_finished_row = [&](const report::Comparison& so_far) {
        pictured.push_back(so_far.rows.back().pictured);
    };
    const report::Comparison compared = app::compare(test::engine(), request);
    EXPECT_EQ(pictured, (std::vector<int>{5, 5, 5, 5, 5, 5, 5, 5, 5, 11}))
        << "told after each row of the first round, then after each round";
    for (std::size_t i = 0; i < rows.size(); ++i) {
        app::Request alone = request.base;
        alone.techniques = {rows[i]};
        const app::Part part = std::move(app::run(test::engine(), alone).parts.front());
        EXPECT_TRUE(test::same_bytes(compared.rows[i].hdr, part.hdr)) << rows[i];
        alone.techniques = {"raytrace:depth=16"};
        alone.time = alone.instant(alone.total()), alone.animate = false;
        alone.frames = 1, alone.warmup = 0;
        const app::Part truth = std::move(app::run(test::engine(), alone).parts.front());
        const std::vector<float> map = flip_of(part, truth, request.base.exposure);
        EXPECT_EQ(compared.rows[i].flip_map, map) << rows[i];
    }
}

TEST(ReportFigures, TogetherARowCostsItsOwnPasses) {
    app::CompareRequest request = asked({"parallax:face=32", "raytrace"});
    request.together = true;
    const json document = compared(request);
    for (int k = 0; k < kFrames; ++k) {
        double all = 0;
        for (const json& row : document["rows"]) {
            EXPECT_NEAR(row["gpu_ms"]["samples"][k].get<double>(), of_passes(row, k), 1e-9);
            all += of_passes(row, k);
        }
        for (const json& row : document["rows"]) // of the whole frame
            EXPECT_NEAR(row["closure"]["samples"][k].get<double>(),
                        all / row["wall_ms"]["samples"][k].get<double>(), 1e-9);
    }
}

/// So that no row always follows the same one.
TEST(Rounds, GoThereAndBack) {
    app::CompareRequest request = asked({"reuse:face=16,shadow_map=16", "raytrace:depth=1"});
    std::vector<std::string> measured;
    request.watcher.on_row = [&](const std::string& label, std::size_t, std::size_t) {
        if (label.find(", round ") != std::string::npos)
            measured.push_back(label.substr(0, label.find(':')));
    };
    const report::Comparison found = app::compare(test::engine(), request);
    ASSERT_EQ(measured.size(), 2 * kRounds.size());
    for (std::size_t i = 0; i < measured.size(); ++i)
        EXPECT_EQ(measured[i], i % 4 == 0 || i % 4 == 3 ? "reuse" : "raytrace") << i;
    EXPECT_EQ(found.rows[0].technique, "reuse");
    EXPECT_EQ(found.rows[1].technique, "raytrace");
}

} // namespace
