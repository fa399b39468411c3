// Tests of plans: rules that give each mirror a technique, and the plan that the program reports.
#include "cli/program.hpp"

#include <nlohmann/json.hpp>

#include <fstream>

namespace {

using Json = nlohmann::json;

constexpr const char* kMixedPlanText = "1=reuse:face=16 2=hybrid:face=16 *=raytrace:shadow=map";

TEST_F(CommandLineTest, RenderJsonContainsThePlanThatWasDrawn) {
    const test::ProcessResult ended = run_cli({"render", "--plan", kMixedPlanText, "--size",
                                               "16x16", "--frames", "1", "--warmup", "0", "-o",
                                               "p.png", "--json"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const Json document = Json::parse(ended.out);
    EXPECT_EQ(document["technique"], "plan");
    EXPECT_EQ(document["label"], kMixedPlanText);
    EXPECT_EQ(document["scene_passes"], 4 + 2);
    const Json& plan = document["plan"];
    ASSERT_EQ(plan.size(), 4u);
    EXPECT_EQ(plan[0]["mirror"], 1);
    EXPECT_EQ(plan[0]["name"], "ball1");
    EXPECT_EQ(plan[0]["technique"], "reuse");
    EXPECT_EQ(plan[0]["settings"]["face"], 16);
    EXPECT_EQ(plan[0]["why"], "rule '1'");
    EXPECT_EQ(plan[1]["technique"], "hybrid");
    EXPECT_EQ(plan[3]["technique"], "raytrace");
    EXPECT_EQ(plan[3]["settings"]["shadow"], "map");
    EXPECT_EQ(plan[3]["settings"]["capture"], 256);
    EXPECT_EQ(plan[3]["why"], "rule '*'");
    // The JSON that `render` prints can be given to `--plan` and draws the same picture.
    std::ofstream(folder / "saved.json") << document.dump();
    const test::ProcessResult again = run_cli({"render", "--plan", (folder / "saved.json").string(),
                                               "--size", "16x16", "--frames", "1", "--warmup", "0",
                                               "-o", "q.png", "--json"});
    ASSERT_EQ(again.exit_code, 0) << again.err;
    EXPECT_EQ(Json::parse(again.out)["mean"], document["mean"]);
}

/// `auto` reports a technique and a reason for each mirror. The same techniques given as a plan
/// draw the same picture.
TEST_F(CommandLineTest, AutoReportsAPlanThatDrawsTheSamePicture) {
    const Words size{"--size", "48x48", "--frames", "1", "--warmup", "1", "--json"};
    const auto render = [&](Words words) {
        words.insert(words.end(), size.begin(), size.end());
        const test::ProcessResult ended = run_cli(words);
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        return Json::parse(ended.out);
    };
    const Json document = render({"render", "gallery", "--technique", "auto", "-o", "a.exr"});
    EXPECT_EQ(document["technique"], "auto");
    const Json& plan = document["plan"];
    ASSERT_EQ(plan.size(), 16u);
    std::string rules, first;
    bool is_one_technique = true; // which may draw the whole picture itself
    for (const Json& entry : plan) {
        const std::string why = entry["why"], technique = why.substr(0, why.find(": "));
        EXPECT_TRUE(technique.starts_with(entry["technique"].get<std::string>())) << why;
        rules += std::to_string(entry["mirror"].get<int>()) + "=" + technique + " ";
        if (first.empty()) first = technique;
        is_one_technique = is_one_technique && technique == first;
    }
    EXPECT_EQ(plan[12]["name"], "left panel");
    render({"render", "gallery", is_one_technique ? "--technique" : "--plan",
            is_one_technique ? first : rules, "-o", "b.exr"});
    EXPECT_EQ(read_output_file("a.exr"), read_output_file("b.exr"));
    const test::ProcessResult list = run_cli({"list", "techniques"});
    EXPECT_NE(list.out.find("\nauto  "), std::string::npos);
}

/// If a technique cannot draw a mirror, its row of the table and stderr say so.
TEST_F(CommandLineTest, CompareRowNamesMirrorsThatItsTechniqueCannotDraw) {
    const test::ProcessResult ended = run_cli(
        add_small_frame_options({"compare", "-o", "out", "--techniques", "planar"}));
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    const std::string said = "not flat, drawn by reuse";
    EXPECT_NE(ended.err.find("planar: mirrors 1 'ball1', 2 'ball2', 3 'ball3' and 1 more: " + said),
              std::string::npos)
        << ended.err;
    const std::size_t row = ended.out.find("\nplanar ");
    ASSERT_NE(row, std::string::npos) << ended.out;
    EXPECT_NE(ended.out.substr(row, ended.out.find('\n', row + 1) - row).find(said),
              std::string::npos)
        << ended.out;
    EXPECT_NE(read_output_file("out/report.md").find(said), std::string::npos);
}

TEST_F(CommandLineTest, CompareAcceptsPlansAsRows) {
    std::ofstream(folder / "mixed.json") << R"([{"mirror": "ball1,2", "technique": "reuse:face=16"},
               {"mirror": "*", "technique": "raytrace:capture=none"}])";
    const std::string file = "plan:" + (folder / "mixed.json").string();
    const test::ProcessResult ended = run_cli(
        {"compare", "-o", "out", "--size", "16x16", "--frames", "1", "--warmup", "1", "--causes",
         "--techniques", "reuse:face=16", file, kMixedPlanText, "--json"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const Json rows = Json::parse(ended.out)["rows"];
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(rows[1]["technique"], "plan");
    EXPECT_EQ(rows[1]["label"], file);
    EXPECT_EQ(rows[1]["scene_passes"], 2 + 2) << "two captures, shadow map and view";
    EXPECT_EQ(rows[1]["plan"][1]["why"], "rule 'ball1,2'");
    EXPECT_EQ(rows[1]["plan"][2]["why"], "rule '*'; black in the captures of others, capture=none");
    EXPECT_EQ(rows[0]["plan"][0]["why"], "one technique was asked for");
    EXPECT_EQ(rows[2]["label"], kMixedPlanText);
    EXPECT_TRUE(rows[2]["causes"].is_null()) << "no one search can be blamed";
    EXPECT_EQ(rows[0]["causes"]["list"][2]["cause"], "direction");
    EXPECT_TRUE(exists(folder / "out/images/causes-reuse-face16.png"));
    for (const Json& row : rows)
        EXPECT_TRUE(exists(folder / "out" / row["image"].get<std::string>())) << row["image"];
}

TEST_F(CommandLineTest, ModelRequiredDrawsTheSamePictureAsModelEverything) {
    for (const char* model : {"everything", "required"}) {
        const test::ProcessResult ended = run_cli({"render", "--plan", kMixedPlanText, "--size",
                                                   "16x16", "--model", model, "-o",
                                                   std::string(model) + ".exr", "--json"});
        ASSERT_EQ(ended.exit_code, 0) << ended.err;
        EXPECT_EQ(Json::parse(ended.out)["model"], model);
        EXPECT_TRUE(Json::parse(ended.out)["left_out"].is_array());
    }
    EXPECT_EQ(read_output_file("everything.exr"), read_output_file("required.exr"));
    const std::string plan =
        run_cli({"graph", "--technique", "parallax:face=16", "--model", "required"}).out;
    EXPECT_THAT(plan, testing::StartsWith("2 passes"));
}

TEST_F(CommandLineTest, CompareWithModelBothHasARowForEachModel) {
    const test::ProcessResult ended = run_cli({"compare", "-o", "out", "--size", "16x16",
                                               "--frames", "6", "--model", "both", "--techniques",
                                               "parallax:face=16", "raytrace", "--json"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const Json document = Json::parse(ended.out);
    EXPECT_EQ(document["model"], "both");
    EXPECT_EQ(document["warmup"], 28) << "until what is kept comes to rest";
    const Json& rows = document["rows"];
    ASSERT_EQ(rows.size(), 4u);
    for (std::size_t i = 0; i < rows.size(); ++i)
        EXPECT_EQ(rows[i]["model"], i % 2 == 0 ? "everything" : "required");
    EXPECT_EQ(rows[0]["label"], "parallax:face=16");
    EXPECT_EQ(rows[1]["label"], "parallax:face=16, model=required");
    EXPECT_EQ(rows[0]["scene_passes"], 4 + 2);
    EXPECT_EQ(rows[1]["scene_passes"], 1) << "all captures are kept";
    EXPECT_EQ(rows[0]["error"], rows[1]["error"]);
    EXPECT_TRUE(exists(folder / "out/images/parallax-face16-required.png"));
}

TEST_F(CommandLineTest, InvalidPlanIsRefused) {
    const auto refused = [&](const std::vector<std::string>& options, int exit_code,
                             const std::vector<std::string>& words) {
        std::vector<std::string> arguments{"render", "-o", "x.png", "--size", "16x16"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        expect_usage_refused(arguments, exit_code, words);
        EXPECT_FALSE(exists(folder / "x.png"));
    };
    refused({"--plan", "1=reuse 5=hybrid *=secant"}, 2,
            {"pattern '5' matches no mirror", "4 mirrors", "1 'ball1'"});
    refused({"--plan", "1=reuse 2,3=hybrid"}, 2, {"no rule for mirror 4 'ball4'"});
    refused({"--plan", "secant"}, 2, {"--plan", "found 'secant'", "--technique"});
    refused({"--technique", "1=secant *=reuse"}, 2, {"--technique", "--plan takes several"});
    refused({"--technique", "reuse", "--plan", "*=reuse"}, 2, {"wanted one of them, found both"});
    refused({"--plan", "none.json"}, 66, {"none.json"});
    refused({"--plan", "*=reuse", "--reference", "1=reuse *=raytrace"}, 2, {"--reference"});
    expect_usage_refused({"compare", "-o", "out", "--techniques", "reuse", "7=reuse *=secant"}, 2,
                         {"pattern '7' matches no mirror"});
    EXPECT_FALSE(exists(folder / "out" / "report.json"));
    expect_usage_refused(
        {"compare", "-o", "out", "--techniques", "1=reuse *=secant", "1=reuse *=secant"}, 2,
        {"asked for twice"});
}

} // namespace
