// Tests of successful commands: lists, pictures, JSON, traces and reports.
#include "cli/program.hpp"
#include "core/byte_source.hpp"
#include "core/image_codec.hpp"
#include "measure/lag.hpp"
#include "measure/metric.hpp"
#include "measure/picture.hpp"

#include <fmt/format.h>

namespace {

using nlohmann::json;

TEST_F(CommandLineTest, ListJsonIsValid) {
    for (const std::string kind : {"techniques", "scenes", "devices", "metrics"}) {
        const test::ProcessResult ended = run_cli({"list", kind, "--json"});
        ASSERT_EQ(ended.exit_code, 0) << ended.err;
        const json document = json::parse(ended.out);
        EXPECT_FALSE(document[kind].empty()) << kind;
        const std::string text = run_cli({"list", kind}).out;
        for (const json& row : document[kind])
            EXPECT_THAT(text, testing::HasSubstr(row["name"].get<std::string>()));
    }
}

/// `list metrics` prints every row of the table of metrics. `diff` prints every metric that
/// compares two pictures.
TEST_F(CommandLineTest, ListMetricsShowsEveryMetric) {
    std::vector<std::string> names, of_differences;
    for (const auto& quantity : catoptric::measure::metrics()) names.emplace_back(quantity.name);
    for (const auto& quantity : catoptric::measure::difference_metrics())
        of_differences.emplace_back(quantity.name);
    std::vector<std::string> found;
    const json metrics = json::parse(run_cli({"list", "metrics", "--json"}).out)["metrics"];
    for (const json& row : metrics) {
        found.push_back(row["name"]);
        EXPECT_FALSE(row["summary"].get<std::string>().empty()) << row["name"];
    }
    EXPECT_EQ(found, names);
    EXPECT_THAT(names, testing::IsSupersetOf({"gpu_ms", "rmse", "flip", "lookup/miss"}));
    const json flip = *std::ranges::find(metrics, json("flip"),
                                         [](const json& row) { return row["name"]; });
    EXPECT_EQ(flip["mask"], "each");
    EXPECT_EQ(flip["better"], "less");

    ASSERT_EQ(run_cli(add_small_frame_options({"render", "--technique", "raytrace", "-o", "a.exr"}))
                  .exit_code,
              0);
    const json document = json::parse(run_cli({"diff", "a.exr", "a.exr", "--json"}).out);
    const std::string text = run_cli({"diff", "a.exr", "a.exr"}).out;
    for (const std::string& name : of_differences) {
        EXPECT_TRUE(document.contains(name)) << name;
        EXPECT_THAT(text, testing::HasSubstr(name));
    }
}

TEST_F(CommandLineTest, ReportStatesTheNumberOfLanes) {
    ASSERT_EQ(
        run_cli(add_small_frame_options({"compare", "-o", "out", "--techniques", "reuse:face=8"}))
            .exit_code,
        0);
    const json report = json::parse(read_file_at_path(folder / "out/report.json"))["device"],
               info = json::parse(run_cli({"info", "--json"}).out)["device"];
    EXPECT_GT(report["lanes"], 0);
    EXPECT_EQ(report["lanes"], info["lanes"]);
    EXPECT_THAT(read_file_at_path(folder / "out/report.md"),
                testing::HasSubstr(" " + report["lanes"].dump() + " lanes"));
}

TEST_F(CommandLineTest, InfoJsonIsValid) {
    const json document = json::parse(run_cli({"info", "--json"}).out);
    EXPECT_EQ(document["version"], "0.1.0");
    EXPECT_TRUE(document["device"]["usable"].get<bool>());
    EXPECT_FALSE(document["features"]["techniques"].empty());
    EXPECT_THAT(run_cli({"info"}).out,
                testing::HasSubstr(document["device"]["name"].get<std::string>()));
}

TEST_F(CommandLineTest, SameRenderCommandWritesTheSameBytes) {
    for (const std::string ending : {".png", ".exr"})
        for (const std::string technique : {"raytrace:samples=3", "parallax:face=32"}) {
            ASSERT_EQ(run_cli(add_small_frame_options(
                                  {"render", "--technique", technique, "-o", "a" + ending}))
                          .exit_code,
                      0);
            ASSERT_EQ(run_cli(add_small_frame_options(
                                  {"render", "--technique", technique, "-o", "b" + ending}))
                          .exit_code,
                      0);
            EXPECT_GT(read_output_file("a" + ending).size(), 100U);
            EXPECT_EQ(read_output_file("a" + ending), read_output_file("b" + ending))
                << technique << ending;
        }
}

/// `compare --max-ms` and `--max-flip` print the best row within the budget, also in each report
/// file. The exit code says whether any row keeps the budget.
TEST_F(CommandLineTest, CompareSaysWhichRowKeepsABudget) {
    const auto compare = [&](const Words& more) {
        Words words{"compare", "-o", "out", "--techniques", "reuse:face=8", "raytrace:depth=2"};
        words.insert(words.end(), more.begin(), more.end());
        words.insert(words.end(), {"--size", "32x32", "--frames", "6", "--warmup", "1"});
        return run_cli(words);
    };
    const test::ProcessResult plenty = compare({"--max-ms", "100000"});
    EXPECT_EQ(plenty.exit_code, 0) << plenty.err;
    const json budget = json::parse(read_file_at_path(folder / "out/report.json"))["budget"];
    EXPECT_EQ(budget["max_ms"], 100000);
    EXPECT_TRUE(budget["max_flip"].is_null());
    EXPECT_EQ(budget["row"], "raytrace:depth=2");
    const std::string text = budget["text"];
    EXPECT_THAT(text, testing::StartsWith("Within 100000 ms on "));
    EXPECT_THAT(plenty.out, testing::HasSubstr(text));
    for (const char* file : {"out/report.md", "out/report.html"})
        EXPECT_THAT(read_file_at_path(folder / file), testing::HasSubstr("has the least FLIP"))
            << file;

    const test::ProcessResult close = compare({"--max-rmse", "1", "--max-flip", "1"});
    EXPECT_EQ(close.exit_code, 0) << close.err;
    EXPECT_THAT(close.out, testing::HasSubstr("Within FLIP 1 and rmse 1 on "));
    EXPECT_EQ(json::parse(read_file_at_path(folder / "out/report.json"))["budget"]["max_rmse"], 1);
    const test::ProcessResult none = compare({"--max-ms", "0", "--max-flip", "0.5"});
    EXPECT_EQ(none.exit_code, 1) << none.err;
    EXPECT_THAT(none.out, testing::HasSubstr("No row keeps 0 ms and FLIP 0.5 on "));
    const json missed = json::parse(read_file_at_path(folder / "out/report.json"))["budget"];
    EXPECT_TRUE(missed["row"].is_null());
    EXPECT_FALSE(missed["nearest"].is_null());
    ASSERT_EQ(compare({}).exit_code, 0);
    const json free = json::parse(read_file_at_path(folder / "out/report.json"));
    EXPECT_FALSE(free.contains("budget"));
    // On a processor, rows are judged by processor time.
    const bool on_processor = free["device"]["type"] == "cpu";
    EXPECT_EQ(free["judged_time"], on_processor ? "cpu_ms" : "gpu_ms");
    const auto verdict = free["verdict"]["text"].get<std::string>();
    EXPECT_EQ(verdict.find(", by processor time, ") != verdict.npos, on_processor) << verdict;
    // One frame has no interval, so that nothing can be told of its time.
    const test::ProcessResult one = run_cli(add_small_frame_options(
        {"compare", "-o", "out", "--max-ms", "100000", "--techniques", "reuse:face=8"}));
    EXPECT_EQ(one.exit_code, 1);
    EXPECT_THAT(one.out, testing::HasSubstr("Cannot tell whether a row keeps 100000 ms on "));
    expect_usage_refused({"compare", "-o", "out", "--max-flip", "2"}, 2,
                         {"--max-flip", "from 0 to 1"});
}

TEST_F(CommandLineTest, CameraOptionPlacesTheCamera) {
    // The text `same` below describes the camera that the scene uses by default.
    ASSERT_EQ(run_cli(add_small_frame_options({"render", "--technique", "raytrace", "-o", "a.png"}))
                  .exit_code,
              0);
    const std::string same = "278,273,-800:278,273,0:37.5", other = "278,273,-700:278,273,0:37.5";
    ASSERT_EQ(run_cli(add_small_frame_options(
                          {"render", "--technique", "raytrace", "-o", "b.png", "--camera", same}))
                  .exit_code,
              0);
    ASSERT_EQ(run_cli(add_small_frame_options(
                          {"render", "--technique", "raytrace", "-o", "c.png", "--camera", other}))
                  .exit_code,
              0);
    ASSERT_EQ(run_cli(add_small_frame_options(
                          {"render", "--technique", "raytrace", "-o", "d.png", "--camera", "0"}))
                  .exit_code,
              0);
    EXPECT_EQ(read_output_file("a.png"), read_output_file("b.png"));
    EXPECT_NE(read_output_file("a.png"), read_output_file("c.png"));
    EXPECT_EQ(read_output_file("a.png"), read_output_file("d.png"));
}

TEST_F(CommandLineTest, SeededCameraCanBeRepeatedFromItsPrintedText) {
    const auto render = [&](const std::string& picture, const Words& more) {
        Words words{"render", "--technique", "parallax:face=32", "-o", picture};
        words.insert(words.end(), more.begin(), more.end());
        const test::ProcessResult ended = run_cli(add_small_frame_options(words));
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        return ended.err;
    };
    const std::string said = render("a.exr",
                                    {"--camera", "seeded", "--seed", "7", "--time", "1.5"});
    const std::string words = "camera drawn from seed 7: ";
    ASSERT_THAT(said, testing::HasSubstr(words));
    const std::string from = said.substr(said.find(words) + words.size());
    const std::string camera = from.substr(0, from.find('\n'));
    render("b.exr", {"--camera", "seeded", "--seed", "7", "--time", "1.5"});
    render("c.exr", {"--camera", camera, "--time", "1.5"});
    render("d.exr", {"--camera", "seeded", "--seed", "8", "--time", "1.5"});
    EXPECT_EQ(read_output_file("a.exr"), read_output_file("b.exr"));
    EXPECT_EQ(read_output_file("a.exr"), read_output_file("c.exr")) << camera;
    EXPECT_NE(read_output_file("a.exr"), read_output_file("d.exr"));
    EXPECT_EQ(render("e.exr", {"--camera", "seeded", "--quiet"}), "");
}

TEST_F(CommandLineTest, OriginInThePicturesHeaderIsEnoughToMakeThePictureAgain) {
    const Words seeded{"--camera", "seeded", "--seed",   "7", "--animate",
                       "--frames", "3",      "--warmup", "0"};
    const auto render = [&](const std::string& file, Words words) {
        words.insert(words.begin(), {"render", "--size", "32x24", "-o", file});
        const test::ProcessResult ended = run_cli(words);
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
    };
    Words words = seeded;
    words.insert(words.end(),
                 {"--time", ".5", "--technique", "raytrace:depth=3,samples=5", "--origin"});
    render("a_%d.exr", words);
    const auto read_header_text = [&](const std::string& file) {
        const auto bytes = catoptric::open_source(folder / file);
        return catoptric::ImageReader(*bytes, "openexr", file).shape().description;
    };
    const json origin = json::parse(read_header_text("a_3.exr"));
    EXPECT_EQ(origin["schema"], "catoptric/picture/1");
    EXPECT_EQ(origin["scene"], "cornell-mirrors");
    EXPECT_EQ(origin["device"],
              json::parse(run_cli({"list", "devices", "--json"}).out)["devices"][0]["name"]);
    EXPECT_NEAR(origin["time"], .5 + 2 / 60., 1e-12);
    EXPECT_NE(read_header_text("a_2.exr"), read_header_text("a_3.exr")); // another instant
    const auto join = [](const json& point) {
        return fmt::format("{},{},{}", point[0].get<double>(), point[1].get<double>(),
                           point[2].get<double>());
    };
    const json& camera = origin["camera"];
    render("b.exr",
           {"--technique", origin["technique"], "--seed", std::to_string(origin["seed"].get<int>()),
            "--model", origin["model"], "--time", fmt::format("{}", origin["time"].get<double>()),
            "--frames", "1", "--warmup", "0", "--camera",
            fmt::format("{}:{}:{}", join(camera["eye"]), join(camera["target"]),
                        camera["vertical_fov_degrees"].get<double>())});
    EXPECT_EQ(catoptric::measure::read_picture(folder / "a_3.exr").pixels,
              catoptric::measure::read_picture(folder / "b.exr").pixels);
    EXPECT_EQ(read_header_text("b.exr"), "");
    expect_usage_refused({"render", "--technique", "reuse", "--origin", "-o", "x.png"}, 2,
                         {"--origin", ".exr", "'x.png'"});
}

TEST_F(CommandLineTest, RenderWritesJsonAndATraceOfItsPasses) {
    const test::ProcessResult ended = run_cli(
        add_small_frame_options({"render", "--technique", "naive:bounces=1", "--model",
                                 "everything", "-o", "x.exr", "--trace", "t.json", "--json"}));
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const json document = json::parse(ended.out);
    EXPECT_EQ(document["label"], "naive:bounces=1");
    EXPECT_EQ(document["settings"]["bounces"], 1);
    EXPECT_EQ(document["scene_passes"], 6);
    EXPECT_EQ(document["size"], json({32, 32}));
    EXPECT_EQ(document["gpu_ms"]["n"], 1);
    const json trace = json::parse(read_output_file("t.json"));
    std::size_t passes = 0;
    for (const json& event : trace["traceEvents"]) {
        if (event["ph"] != "X") continue;
        ++passes;
        EXPECT_GE(event["dur"].get<double>(), 0);
    }
    EXPECT_EQ(passes, document["passes"].size());
}

/// `--profile FILE` writes the JSON that `--json` prints. The option also turns on the timing of
/// frames.
TEST_F(CommandLineTest, RenderProfileFileEqualsItsJson) {
    const test::ProcessResult ended = run_cli({"render", "flat", "--technique", "reuse:face=16",
                                               "--size", "16x16", "-o", "x.png", "--profile",
                                               "p.json", "--json"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_EQ(read_output_file("p.json"), ended.out);
    const json document = json::parse(ended.out);
    EXPECT_TRUE(document["settled"].is_null());
    for (const char* times : {"gpu_ms", "frame_ms", "host_ms", "cpu_record_ms", "wall_ms"})
        EXPECT_EQ(document[times]["n"], 20) << times;
    EXPECT_EQ(document["cpu_ms"].is_null(), document["device"]["type"] != "cpu");
    EXPECT_EQ(document["gpu_ms"]["samples"].size(), 20U);
    EXPECT_EQ(document["host_parts"].size(), 4U);
    for (const json& pass : document["passes"]) EXPECT_EQ(pass["gpu_ms"]["n"], 20) << pass;
    EXPECT_THAT(document["passes"].back()["name"], "compose");
}

/// Without `--frames`, a still scene is rendered until frames stop changing. Its picture equals the
/// picture after 20 frames.
TEST_F(CommandLineTest, RenderOfAStillSceneStopsWhenFramesStopChanging) {
    const auto render = [&](const std::string& technique, Words more) {
        Words words{"render", "--technique", technique, "--size", "48x48", "--time", "1.3"};
        words.insert(words.end(), {"--camera", "300,300,545:300,90,200:75", "--json"});
        words.insert(words.end(), more.begin(), more.end());
        const test::ProcessResult ended = run_cli(words);
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        return json::parse(ended.out);
    };
    const json still = render("reuse:face=32", {"-o", "still.exr"}),
               counted = render("reuse:face=32", {"-o", "counted.exr", "--frames", "20"});
    EXPECT_TRUE(still["settled"].get<bool>());
    EXPECT_GT(still["frames"], 3) << "mirrors in mirrors take frames";
    EXPECT_LT(still["frames"], 28);
    EXPECT_EQ(read_output_file("still.exr"), read_output_file("counted.exr"));
    EXPECT_TRUE(still["gpu_ms"].is_null()) << "its frames compile what they use first";
    EXPECT_EQ(counted["gpu_ms"]["n"], 20);
    EXPECT_TRUE(counted["settled"].is_null());

    for (const std::string technique : {"naive:face=32", "raytrace"})
        EXPECT_EQ(render(technique, {"-o", "x.exr"})["frames"], 1)
            << technique << " remembers nothing";
    EXPECT_EQ(render("reuse:face=32", {"-o", "x.exr", "--animate"})["gpu_ms"]["n"], 20);
}

TEST_F(CommandLineTest, PixelsThatAreNotFiniteAreReported) {
    const Words too_bright{"--ambient", "1e300", "--quiet"};
    Words render = add_small_frame_options({"render", "--technique", "raytrace", "-o", "x.exr"});
    render.insert(render.end(), too_bright.begin(), too_bright.end());
    EXPECT_THAT(run_cli(render).err, testing::HasSubstr("pixels are not finite"));
    Words compare = add_small_frame_options({"compare", "-o", "out", "--techniques", "raytrace"});
    compare.insert(compare.end(), too_bright.begin(), too_bright.end());
    const test::ProcessResult ended = run_cli(compare);
    EXPECT_EQ(ended.exit_code, 70);
    EXPECT_THAT(ended.err, testing::HasSubstr("'raytrace' has "));
    EXPECT_TRUE(std::filesystem::exists(folder / "out/report.json"));
}

TEST_F(CommandLineTest, QuietRenderPrintsNothing) {
    const test::ProcessResult ended = run_cli(
        add_small_frame_options({"render", "--technique", "reuse", "-o", "x.png", "--quiet"}));
    EXPECT_EQ(ended.exit_code, 0);
    EXPECT_EQ(ended.err, "");
    EXPECT_EQ(ended.out, "");
}

TEST_F(CommandLineTest, GraphPrintsTextDotAndJson) {
    EXPECT_THAT(run_cli({"graph", "--technique", "reuse"}).out, testing::HasSubstr("capture"));
    EXPECT_THAT(run_cli({"graph", "--technique", "reuse", "--format", "dot"}).out,
                testing::HasSubstr("digraph"));
    const std::string document = run_cli({"graph", "--technique", "reuse", "--format", "json"}).out;
    EXPECT_TRUE(json::accept(document));
    EXPECT_EQ(run_cli({"graph", "--technique", "reuse", "--json"}).out, document);
}

TEST_F(CommandLineTest, CaptureBudgetReportsTheGreatestAgeOfCaptures) {
    const std::string said = "captures: at most 1 of 4 mirrors a frame; a reflection is at most 3 "
                             "frames old, and 4 more for each further mirror on the light's path";
    const Words small{"--technique", "parallax:face=8,shadow_map=16", "--size", "16x16"};
    const auto run = [&](Words words) {
        words.insert(words.end(), small.begin(), small.end());
        return run_cli(words).out;
    };
    EXPECT_THAT(run({"graph", "--why", "--budget-ms", "1e-9"}), testing::HasSubstr(said + "\n"));
    const json moving = json::parse(run({"render", "--json", "--animate", "--frames", "6",
                                         "--warmup", "0", "--budget-ms", "1e-9", "-o", "x.exr"}));
    EXPECT_EQ(moving["captures"]["said"], said);
    EXPECT_EQ(moving["captures"]["drawn"], 1);
    EXPECT_EQ(moving["captures"]["waiting"], 3);
    EXPECT_EQ(moving["captures"]["round_frames"], 4);
}

TEST_F(CommandLineTest, GraphWhyListsTheCapturesThatAPictureRequires) {
    const std::string text = run_cli({"graph", "flat", "--why"}).out;
    EXPECT_THAT(text, testing::HasSubstr("mirror 1 'mirror': in the camera's view; captured, faces "
                                         "+X -X +Y -Y -Z, no other mirror in it"));
    EXPECT_THAT(text, testing::HasSubstr("face +Z of the capture of mirror 1 'mirror'"));
    EXPECT_THAT(text, testing::HasSubstr("changes: no pixel"));
    EXPECT_THAT(text, testing::HasSubstr("suggested --plan \""));
    // The candidates are listed with their predicted times, and the rule of the choice.
    for (const char* candidate : {"planar", "raytrace", "raytrace:first=raster"})
        EXPECT_THAT(text, testing::HasSubstr("\n  " + std::string(candidate) + ": predicted "));
    EXPECT_THAT(text,
                testing::ContainsRegex("\n  why: least score, .*; unit costs: [a-z0-9.-]+, "));
    const json document = json::parse(run_cli({"graph", "flat", "--why", "--json"}).out);
    EXPECT_EQ(document["schema"], "catoptric/why/1");
    EXPECT_EQ(document["candidates"][0]["plan"], document["suggested"]);
    EXPECT_LE(document["candidates"][0]["score"], document["candidates"][1]["score"]);
    EXPECT_EQ(document["mirrors"][0]["faces"].size(), 5u);
    EXPECT_EQ(document["left_out"][0]["error"], 0);
    const test::ProcessResult dot = run_cli({"graph", "flat", "--why", "--format", "dot"});
    EXPECT_EQ(dot.exit_code, 2);
    EXPECT_THAT(dot.err, testing::HasSubstr("--why: wanted --format text or json, found dot"));
}

TEST_F(CommandLineTest, DiffComputesFlipFromFloatsUnlessAFileHasEightBits) {
    const auto render = [&](const char* depth, const char* name) {
        ASSERT_EQ(run_cli(add_small_frame_options({"render", "--technique", "raytrace",
                                                   "--exposure", depth, "-o", name}))
                      .exit_code,
                  0);
    };
    render("0", "a.exr"), render("0", "a.png"), render(".004", "b.png");
    const auto diff = [&](const char* one, const char* other, const char* stops) {
        return json::parse(run_cli({"diff", one, other, "--exposure", stops, "--json"}).out);
    };
    EXPECT_EQ(diff("a.exr", "a.exr", "0")["flip_source"], "float");
    EXPECT_EQ(diff("a.png", "b.png", "0")["flip_source"], "8-bit");
    // A float picture and its own PNG differ only by rounding to 8 bits, so FLIP is 0 but rmse is
    // not.
    EXPECT_EQ(diff("a.exr", "a.png", "0")["flip_source"], "8-bit");
    EXPECT_EQ(diff("a.exr", "a.png", "0")["flip"], 0.0);
    EXPECT_GT(diff("a.exr", "a.png", "0")["rmse"], 0.0);
}

TEST_F(CommandLineTest, DiffIsZeroForEqualPicturesOnly) {
    ASSERT_EQ(run_cli(add_small_frame_options(
                          {"render", "--technique", "naive:bounces=0", "-o", "a.exr"}))
                  .exit_code,
              0);
    ASSERT_EQ(run_cli(add_small_frame_options({"render", "--technique", "raytrace", "-o", "b.exr"}))
                  .exit_code,
              0);
    const json equal = json::parse(run_cli({"diff", "a.exr", "a.exr", "--json"}).out);
    EXPECT_EQ(equal["rmse"], 0.0);
    EXPECT_EQ(equal["flip"], 0.0);
    EXPECT_TRUE(equal["psnr"].is_null());
    EXPECT_EQ(equal["off"], 0.0);
    EXPECT_EQ(equal["longest_line"], 0.0);
    EXPECT_EQ(run_cli({"diff", "a.exr", "a.exr", "--max-flip", "0", "--max-rmse", "0"}).exit_code,
              0);

    const json other = json::parse(run_cli({"diff", "a.exr", "b.exr", "--json"}).out);
    EXPECT_GT(other["rmse"], 0.0);
    EXPECT_EQ(other["pixels"], 32 * 32);
    EXPECT_GT(other["off"], 0.0);
    EXPECT_GT(other["longest_line"], 0.0);
    EXPECT_THAT(run_cli({"diff", "a.exr", "b.exr"}).out,
                testing::AllOf(testing::HasSubstr("rmse"), testing::HasSubstr("longest_line")));
    const test::ProcessResult flip = run_cli({"diff", "a.exr", "b.exr", "--max-flip", "0.0001"});
    EXPECT_EQ(flip.exit_code, 1);
    EXPECT_THAT(flip.err, testing::HasSubstr("over --max-flip 0.0001"));
    const test::ProcessResult rmse = run_cli(
        {"diff", "a.exr", "b.exr", "--max-rmse", "0.0001", "--max-flip", "1"});
    EXPECT_EQ(rmse.exit_code, 1);
    EXPECT_THAT(rmse.err, testing::HasSubstr("over --max-rmse 0.0001"));
    EXPECT_THAT(rmse.err, testing::Not(testing::HasSubstr("--max-flip")));
}

TEST_F(CommandLineTest, DiffOfAPngAndItsExrHasFlipZero) {
    for (const std::string name : {"a.exr", "a.png"})
        ASSERT_EQ(
            run_cli(add_small_frame_options({"render", "--technique", "raytrace", "-o", name}))
                .exit_code,
            0);
    const json document = json::parse(run_cli({"diff", "a.exr", "a.png", "--json"}).out);
    EXPECT_EQ(document["flip"], 0.0) << "a PNG shows what its EXR shows";
    EXPECT_LT(document["max"], 0.01);
    const json masked = json::parse(
        run_cli({"diff", "a.exr", "a.png", "--mask", "a.png", "--json"}).out);
    EXPECT_LT(masked["pixels"], 32 * 32 + 1);
}

TEST_F(CommandLineTest, DiffRefusesPicturesOfDifferentSizes) {
    ASSERT_EQ(run_cli(add_small_frame_options({"render", "--technique", "raytrace", "-o", "a.png"}))
                  .exit_code,
              0);
    ASSERT_EQ(run_cli({"render", "--technique", "raytrace", "-o", "b.png", "--size", "16x32",
                       "--frames", "1", "--warmup", "0"})
                  .exit_code,
              0);
    expect_usage_refused({"diff", "a.png", "b.png"}, 65, {"a.png is 32x32", "b.png is 16x32"});
    expect_usage_refused({"diff", "a.png", "a.png", "--mask", "b.png"}, 65, {"b.png"});
    expect_usage_refused({"diff", "a.png", "a.png", "--max-flip", "nan"}, 2,
                         {"--max-flip", "'nan'"});
}

TEST_F(CommandLineTest, CompareWritesReportFilesAndPrintsTheTable) {
    const Words words = add_small_frame_options(
        {"compare", "-o", "out", "--techniques", "naive:bounces=1", "reuse", "raytrace:depth=16"});
    const test::ProcessResult ended = run_cli(words);
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    for (const char* part : {"naive:bounces=1", "reuse", "raytrace:depth=16", "rmse", "flip"})
        EXPECT_THAT(ended.out, testing::HasSubstr(part));
    const json document = json::parse(read_output_file("out/report.json"));
    EXPECT_EQ(document["complete"], true);
    ASSERT_EQ(document["rows"].size(), 3U);
    EXPECT_EQ(document["rows"][2]["error"]["rmse"], 0.0);
    for (const char* name : {"out/report.html", "out/report.md", "out/rows.csv",
                             "out/images/reuse.png", "out/images/reference.png"})
        EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
}

TEST_F(CommandLineTest, CompareJsonEqualsTheReportFile) {
    const test::ProcessResult ended = run_cli(
        add_small_frame_options({"compare", "-o", "out", "--json", "--together", "--techniques",
                                 "reuse:face=32", "raytrace:depth=1"}));
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_EQ(json::parse(ended.out), json::parse(read_output_file("out/report.json")));
}

/// An OBJ scene of two facing mirrors and a lamp. Nothing moves, so lag is measured at one time
/// with a few frames per speed.
constexpr const char* kTwoMirrorObjText = R"(mtllib two.mtl
v -1 0 -1
v 1 0 -1
v 0 2 -1
v -1 0 1
v 1 0 1
v 0 2 1
v -1 3 -1
v 1 3 -1
v 0 3 1
o one
usemtl mirror
f 1 2 3
o two
usemtl mirror
f 6 5 4
o lamp
usemtl lamp
f 7 8 9
)";

TEST_F(CommandLineTest, CompareReportsLagIfAsked) {
    write_input_file("two.obj", kTwoMirrorObjText);
    write_input_file("two.mtl", "newmtl mirror\nillum 3\nKs 1 1 1\nnewmtl lamp\nKe 5 5 5\n");
    Words words = add_small_frame_options({"compare", "two.obj", "-o", "out", "--lag", "--json",
                                           "--techniques", "reuse:face=16", "raytrace"});
    const test::ProcessResult ended = run_cli(words);
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const json lag = json::parse(ended.out)["lag"];
    EXPECT_EQ(lag["without_history"], json::array({"raytrace"}));
    ASSERT_EQ(lag["rows"].size(), 1U);
    EXPECT_EQ(lag["rows"][0]["label"], "reuse:face=16");
    ASSERT_EQ(lag["rows"][0]["speeds"].size(), 6U);
    for (const json& speed : lag["rows"][0]["speeds"])
        EXPECT_EQ(speed["rmse"], json::array({0})) << speed;
    EXPECT_THAT(read_output_file("out/report.md"),
                testing::HasSubstr("## Lag: frames after a cut"));
    EXPECT_THAT(read_output_file("out/report.html"), testing::HasSubstr("<h2>Lag</h2>"));
    std::erase(words, "--lag");
    EXPECT_FALSE(json::parse(run_cli(words).out).contains("lag"));
}

TEST_F(CommandLineTest, CompareGivesNoValidationMessages) {
    const test::ProcessResult ended = run_cli(add_small_frame_options(
        {"compare", "-o", "out", "--validate", "--techniques", "parallax:face=32", "raytrace"}));
    if (ended.err.find("vulkan-validationlayers") != std::string::npos) GTEST_SKIP() << ended.err;
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
}

} // namespace
