// Tests of errors over drawn views: they must equal errors of pictures that `render_reported_view`
// writes for the same views.
#include "cli/program.hpp"

#include <fmt/format.h>

#include <set>

namespace {

using nlohmann::json;

constexpr int kDrawnViewCount = 6;

class DrawnViews : public CommandLineTest {
protected:
    /// Runs a small and quick comparison over drawn views. Returns its JSON document.
    json compare_over_drawn_views(const std::string& folder_name, const std::string& seed,
                                  const Words& techniques) const {
        Words words = add_small_frame_options({"compare", "-o", folder_name, "--views",
                                               std::to_string(kDrawnViewCount), "--seed", seed,
                                               "--json"});
        words.emplace_back("--techniques");
        words.insert(words.end(), techniques.begin(), techniques.end());
        const test::ProcessResult ended = run_cli(words);
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        return json::parse(ended.out);
    }
    /// Renders the picture of a view with the camera and time that the report states for the view.
    void render_reported_view(const json& view, const std::string& technique,
                              const std::string& file) const {
        const test::ProcessResult ended = run_cli(
            {"render", "--technique", technique, "-o", file, "--size", "32x32", "--camera",
             view["camera"]["name"], "--time", fmt::format("{}", view["time"].get<double>())});
        ASSERT_EQ(ended.exit_code, 0) << ended.err;
    }
};

std::string format_camera_option(const json& camera) {
    const json &eye = camera["eye"], &target = camera["target"];
    return fmt::format("{},{},{}:{},{},{}:{}", eye[0].get<double>(), eye[1].get<double>(),
                       eye[2].get<double>(), target[0].get<double>(), target[1].get<double>(),
                       target[2].get<double>(), camera["vertical_fov_degrees"].get<double>());
}

/// `reuse` shows captures of earlier frames, so `render_reported_view` draws frames until they stop
/// changing.
TEST_F(DrawnViews, ErrorsMatchPicturesRenderedFromTheSameViews) {
    const json document = compare_over_drawn_views("out", "1",
                                                   {"reuse:face=32", "naive:bounces=0"});
    ASSERT_EQ(document["views"].size(), kDrawnViewCount);
    for (const int i : {0, 4}) {
        const json& view = document["views"][i];
        render_reported_view(view, "raytrace:depth=16", "truth.exr");
        for (const json& row : document["rows"]) {
            render_reported_view(view, row["label"], "row.exr");
            const json found = json::parse(run_cli({"diff", "row.exr", "truth.exr", "--json"}).out);
            const json& all = row["views"]["error_all"];
            EXPECT_GT(found["flip"].get<double>(), 0);
            for (const char* figure : {"flip", "off", "mae", "rmse", "longest_line", "p99", "max"})
                EXPECT_NEAR(all[figure]["values"][i].get<double>(), found[figure].get<double>(),
                            1e-6)
                    << row["label"] << " " << figure << " view " << i;
        }
    }
    // The seed of a view gives its camera again. The same camera as text gives the same picture.
    const json& view = document["views"][4];
    render_reported_view(
        {{"camera", {{"name", format_camera_option(view["camera"])}}}, {"time", view["time"]}},
        "raytrace:depth=1", "typed.exr");
    ASSERT_EQ(
        run_cli({"render", "--technique", "raytrace:depth=1", "-o", "drawn.exr", "--size", "32x32",
                 "--camera", "seeded", "--seed", std::to_string(view["seed"].get<std::uint64_t>()),
                 "--time", fmt::format("{}", view["time"].get<double>())})
            .exit_code,
        0);
    EXPECT_EQ(read_output_file("typed.exr"), read_output_file("drawn.exr"));
}

TEST_F(DrawnViews, ViewsAreDrawnFromTheSeedAndSeeAMirror) {
    const json one = compare_over_drawn_views("one", "1", {"naive:bounces=0"}),
               again = compare_over_drawn_views("again", "1", {"naive:bounces=0"}),
               other = compare_over_drawn_views("other", "2", {"naive:bounces=0"});
    EXPECT_EQ(one["views"], again["views"]);
    EXPECT_EQ(one["rows"][0]["views"], again["rows"][0]["views"]);
    std::set<std::string> cameras;
    for (const json* document : {&one, &other}) {
        for (const json& view : (*document)["views"]) cameras.insert(view["camera"]["name"]);
        const json& error = (*document)["rows"][0]["views"]["error"];
        for (const json& pixels : error["pixels"]["values"]) EXPECT_GT(pixels, 0);
        const json& values = error["flip"]["values"];
        EXPECT_EQ(error["flip"]["ci95"], json({*std::min_element(values.begin(), values.end()),
                                               *std::max_element(values.begin(), values.end())}))
            << "of six views, the range";
    }
    EXPECT_EQ(cameras.size(), 2 * kDrawnViewCount);
    // For each row the report has a picture of its worst view, beside the reference.
    std::set<std::size_t> worst_views;
    for (const auto& [place, document] : {std::pair("one", &one), std::pair("other", &other)}) {
        const json& views = (*document)["rows"][0]["views"];
        const json &worst = views["worst"], &flips = views["error"]["flip"]["values"];
        EXPECT_EQ(worst["flip"], *std::max_element(flips.begin(), flips.end()));
        EXPECT_EQ(flips[worst["view"].get<std::size_t>()], worst["flip"]);
        EXPECT_TRUE(std::filesystem::exists(folder / place / worst["image"].get<std::string>()));
        worst_views.insert(worst["view"].get<std::size_t>());
    }
    EXPECT_NE(worst_views, std::set<std::size_t>{0}) << "the first could be taken for it";
    EXPECT_THAT(read_output_file("one/report.md"), testing::HasSubstr("## Over 6 views"));
    EXPECT_THAT(read_output_file("one/report.html"), testing::HasSubstr("<h2>Worst views</h2>"));
}

/// With `--views 1`, the report has no drawn views and no pictures of worst views.
TEST_F(DrawnViews, ReportHasNoDrawnViewsUnlessAsked) {
    const test::ProcessResult ended = run_cli(add_small_frame_options(
        {"compare", "-o", "out", "--json", "--views", "1", "--techniques", "naive:bounces=0"}));
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_EQ(json::parse(ended.out)["views"], json::array());
    EXPECT_FALSE(std::filesystem::exists(folder / "out/images/worst-naive-bounces0.png"));
}

TEST_F(DrawnViews, TooFewViewsForAMedianAreRefused) {
    for (const std::string count : {"0", "-3", "x", "1e9"})
        expect_usage_refused(
            {"compare", "-o", "out", "--views", count}, 2,
            {"--views: wanted a whole number from 1 to 10000, found '" + count + "'"});
    for (const std::string count : {"2", "3", "5"})
        expect_usage_refused(
            {"compare", "-o", "out", "--views", count}, 2,
            {"--views: wanted 1 or at least 6, because fewer give no 95 % interval of the "
             "median, found " +
             count});
}

/// Neighbouring views share an instant, and the report says how many views they count for.
TEST_F(DrawnViews, CamerasOfOneInstantAreStatedInTheReport) {
    Words words = add_small_frame_options(
        {"compare", "-o", "out", "--views", "12", "--cameras-per-instant", "2", "--json"});
    words.insert(words.end(), {"--techniques", "reuse:face=32"});
    const test::ProcessResult ended = run_cli(words);
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const json document = json::parse(ended.out);
    for (const int i : {0, 2, 10})
        EXPECT_EQ(document["views"][i]["time"], document["views"][i + 1]["time"]);
    const json& shared = document["rows"][0]["views"]["shared_instants"];
    EXPECT_EQ(shared["instants"], 6);
    EXPECT_NEAR(shared["flip_design_effect"].get<double>() *
                    shared["effective_views"].get<double>(),
                12, 1e-9);
    expect_usage_refused({"compare", "-o", "x", "--views", "30", "--cameras-per-instant", "6"}, 2,
                         {"--cameras-per-instant: wanted at most a sixth of the 30 views, so that "
                          "they have at least 6 instants, found 6"});
    expect_usage_refused({"compare", "-o", "x", "--cameras-per-instant", "2"}, 2,
                         {"--cameras-per-instant: wanted --views N as well, found no drawn views"});
}

} // namespace
