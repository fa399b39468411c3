// Tests of scene overrides and of the output of `catoptric info`.
#include "cli/program.hpp"

#include <fstream>

namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// Writes a scene of a floor and a board above the floor, without light, camera or mirror.
class SceneOverrides : public CommandLineTest {
protected:
    SceneOverrides() {
        write_input_file("m.mtl", "newmtl wood\nKd .5 .4 .3\nnewmtl tin\nKd .8 .8 .8\n");
        write_input_file(
            "x.obj", "mtllib m.mtl\nv -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv -1 0 -1\nv 1 0 -1\n"
                     "v 1 2 -1\nv -1 2 -1\no floor\nusemtl wood\nf 4 3 2 1\n"
                     "o the board\nusemtl tin\nf 5 6 7 8\n");
    }
    json run_info_as_json(const Words& more = {}) const {
        Words words{"info", "x.obj", "--json", "--size", "64x64"};
        words.insert(words.end(), more.begin(), more.end());
        const test::ProcessResult ended = run_cli(words);
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        return json::parse(ended.out);
    }
    static std::vector<std::string> list_unsupported_ids(const json& unsupported) {
        std::vector<std::string> ids;
        for (const json& gap : unsupported) ids.push_back(gap["id"]);
        return ids;
    }
};

TEST_F(SceneOverrides, InfoJsonDescribesTheScene) {
    const json found = run_info_as_json();
    EXPECT_EQ(found["schema"], "catoptric/scene/1");
    EXPECT_EQ(found["scene"], "x");
    EXPECT_EQ(found["triangles"], 4);
    EXPECT_EQ(found["objects"], 2);
    EXPECT_EQ(found["instances"], 0);
    EXPECT_EQ(found["bytes"]["files"], std::filesystem::file_size(folder / "x.obj") +
                                           std::filesystem::file_size(folder / "m.mtl"));
    ASSERT_EQ(found["materials"].size(), 2u);
    EXPECT_EQ(found["materials"][0]["name"], "wood");
    EXPECT_EQ(found["materials"][0]["kind"], "diffuse");
    EXPECT_EQ(found["mirrors"], json::array());
    EXPECT_EQ(found["mirror_options"][0], "--mirror 'floor'");
    EXPECT_EQ(found["lights"], json::array());
    EXPECT_EQ(found["environment"], json::parse(R"({"name": "studio", "scale": 1,
                                                    "rotation_degrees": 0})"));
    EXPECT_EQ(found["cameras"], json::array());
    EXPECT_EQ(found["camera"]["vertical_fov_degrees"], 40);
    EXPECT_TRUE(found["exposure"].is_number());
    EXPECT_EQ(found["auto_exposure"], true);
    EXPECT_EQ(found["ambient"], 0);
    EXPECT_THAT(list_unsupported_ids(found["gaps"]),
                testing::ElementsAre("indirect-left-out", "environment-unshadowed", "added-studio",
                                     "added-camera"));
    EXPECT_GT(found["gaps"][0]["pixel_share"], .2) << "what costs most stands first";
    EXPECT_TRUE(found["gaps"][2]["pixel_share"].is_null());
}

TEST_F(SceneOverrides, InfoShowsAMirrorThatWasChosenByName) {
    const json found = run_info_as_json(
        {"--mirror", "the board=.5,.25,1", "--environment", "none"});
    ASSERT_EQ(found["mirrors"].size(), 1u);
    const json& mirror = found["mirrors"][0];
    EXPECT_EQ(mirror["mirror"], 1);
    EXPECT_EQ(mirror["name"], "the board");
    EXPECT_EQ(mirror["shape"]["kind"], "flat");
    EXPECT_EQ(mirror["shape"]["closed"], false);
    EXPECT_EQ(mirror["reflectance"], json({.5, .25, 1}));
    EXPECT_EQ(mirror["capture_centre"], json({0, 1, -1}));
    EXPECT_GT(mirror["screen_share"], .05);
    EXPECT_LT(mirror["screen_share"], .6);
    EXPECT_THAT(list_unsupported_ids(found["gaps"]), testing::ElementsAre("added-camera"));
    EXPECT_EQ(found["ambient"], .05);
}

/// Without `--json`, `run_info_as_json` prints the same facts as text.
TEST_F(SceneOverrides, InfoTextShowsSceneMirrorsAndGaps) {
    const test::ProcessResult ended = run_cli(
        {"info", "x.obj", "--size", "64x64", "--mirror", "tin"});
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_THAT(ended.out, StartsWith("scene        x, hash "));
    for (const char* words : {"triangles    4 shown, 4 stored", "environment  studio",
                              "Materials\n", "Mirrors\n", "flat, open", "added-camera"})
        EXPECT_THAT(ended.out, HasSubstr(words));
    EXPECT_THAT(ended.err, HasSubstr("no light: lit by the environment studio"));
    EXPECT_THAT(ended.err, HasSubstr("no camera: using --camera "));
    EXPECT_THAT(run_cli({"info", "x.obj"}).out,
                HasSubstr("  --mirror 'floor'\n  --mirror 'the board'"));
}

TEST_F(SceneOverrides, InfoReportsAnOrthographicCamera) {
    write_input_file("m.mtl",
                     "newmtl wood\nKd .5 .4 .3\nnewmtl tin\nKd .8 .8 .8\nillum 3\nKs 1 1 1\n");
    // The orthographic camera looks straight down and sees a height of 4 units. The floor is 2 by 2
    // units.
    const json found = run_info_as_json({"--camera", "0,10,0:0,0,0:h=4", "--mirror", "floor"});
    EXPECT_EQ(found["camera"]["orthographic_height"], 4);
    EXPECT_TRUE(found["camera"]["vertical_fov_degrees"].is_null());
}

/// `run_info_as_json` and `render` compute automatic exposure with the camera that `--camera`
/// gives.
TEST_F(SceneOverrides, AutomaticExposureUsesTheGivenCamera) {
    const Words floor{"--camera", "0,.4,0:0,0,.1:40", "--environment", "studio", "--mirror", "tin"};
    const json by_info = run_info_as_json(floor);
    EXPECT_NE(by_info["exposure"], run_info_as_json({"--mirror", "tin"})["exposure"]);
    Words words{"render", "x.obj",    "--technique", "raytrace", "--size", "64x64",
                "--json", "--frames", "1",           "-o",       "x.png"};
    words.insert(words.end(), floor.begin(), floor.end());
    const test::ProcessResult rendered = run_cli(words);
    EXPECT_EQ(rendered.exit_code, 0) << rendered.err;
    EXPECT_EQ(json::parse(rendered.out)["exposure"], by_info["exposure"]);
    Words text{"info", "x.obj", "--size", "64x64"};
    text.insert(text.end(), floor.begin(), floor.end());
    EXPECT_THAT(run_cli(text).out, HasSubstr(" stops (auto, by camera '0,.4,0:0,0,.1:40')"));
}

TEST_F(SceneOverrides, OverrideFileBesideTheSceneIsRead) {
    const Words write_it{"info",     "x.obj",          "--write",    "--mirror", "tin=.5",
                         "--camera", "0,1,9:0,1,0:30", "--exposure", "1"};
    EXPECT_EQ(run_cli(write_it).exit_code, 0);
    EXPECT_EQ(json::parse(read_output_file("x.obj.catoptric.json")),
              json::parse(R"({"mirrors": ["tin=0.5"], "environment": "studio", "exposure": 1.0,
                              "camera": "0,1,9:0,1,0:30"})"));
    const test::ProcessResult again = run_cli(write_it);
    EXPECT_EQ(again.exit_code, 73);
    EXPECT_THAT(again.err,
                HasSubstr("x.obj.catoptric.json: is there already; --force replaces it"));
    Words by_force = write_it;
    by_force.emplace_back("--force");
    EXPECT_EQ(run_cli(by_force).exit_code, 0);

    const json found = run_info_as_json();
    EXPECT_EQ(found["scene_file"], "x.obj.catoptric.json");
    EXPECT_EQ(found["mirrors"].size(), 1u);
    EXPECT_EQ(found["exposure"], 1);
    EXPECT_EQ(found["camera"]["eye"], json({0, 1, 9}));
    EXPECT_THAT(list_unsupported_ids(found["gaps"]),
                testing::ElementsAre("indirect-left-out", "environment-unshadowed"));
    EXPECT_NE(found["hash"], run_info_as_json({"--no-scene-file"})["hash"]);
    const Words render = add_small_frame_options(
        {"render", "x.obj", "--technique", "raytrace", "-o", "x.png"});
    EXPECT_THAT(run_cli(render).err, HasSubstr("read beside the scene: x.obj.catoptric.json"));
    write_input_file("x.obj.catoptric.json", R"({"mirror": ["tin"]})");
    expect_usage_refused(render, 65, {"x.obj.catoptric.json: 'mirror': wanted one of mirrors, "});
    Words without = render;
    without.emplace_back("--no-scene-file");
    EXPECT_EQ(run_cli(without).exit_code, 0);
}

TEST_F(SceneOverrides, DrawnCameraIsWrittenAsNumbers) {
    const Words words{"--mirror", "tin", "--camera", "seeded", "--seed", "5"};
    Words write_it{"info", "x.obj", "--write"};
    write_it.insert(write_it.end(), words.begin(), words.end());
    EXPECT_EQ(run_cli(write_it).exit_code, 0);
    const json written = json::parse(read_output_file("x.obj.catoptric.json"));
    EXPECT_EQ(written["camera"], run_info_as_json()["camera"]["name"]);
    Words drawn = words;
    drawn.emplace_back("--no-scene-file");
    EXPECT_EQ(run_info_as_json()["camera"], run_info_as_json(drawn)["camera"]);
}

TEST_F(SceneOverrides, OutputOverTheOverrideFileIsRefused) {
    write_input_file("x.obj.catoptric.json", "{}");
    expect_usage_refused(
        add_small_frame_options({"render", "x.obj", "--technique", "raytrace", "-o", "y.png",
                                 "--quiet", "--mirror", "tin", "--trace", "x.obj.catoptric.json"}),
        2, {"x.obj.catoptric.json", "which the scene is read from"});
}

TEST_F(SceneOverrides, CompareReportsGapsAndOverridesOfTheScene) {
    const test::ProcessResult ended = run_cli(
        add_small_frame_options({"compare", "x.obj", "-o", "out", "--mirror", "tin", "--exposure",
                                 "-1", "--techniques", "reuse"}));
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    const json document = json::parse(read_output_file("out/report.json"));
    EXPECT_EQ(document["exposure"], -1);
    EXPECT_EQ(document["ambient"], 0);
    const json& scene = document["scene"];
    EXPECT_THAT(list_unsupported_ids(scene["gaps"]),
                testing::ElementsAre("indirect-left-out", "environment-unshadowed", "added-studio",
                                     "added-camera"));
    EXPECT_EQ(scene["environment"]["name"], "studio");
    EXPECT_EQ(scene["lights"], json::array());
    EXPECT_EQ(scene["camera"]["name"], "default");
    for (const char* page : {"out/report.md", "out/report.html"}) {
        EXPECT_THAT(read_output_file(page), HasSubstr("Added, approximated, left out")) << page;
        EXPECT_THAT(read_output_file(page), HasSubstr("added-studio")) << page;
    }
}

TEST_F(SceneOverrides, CompareOfSeveralScenesWritesOneReport) {
    Words words = add_small_frame_options({"compare", "x.obj", "cornell-mirrors", "-o", "out",
                                           "--mirror", "*o*", "--techniques", "reuse", "proxy"});
    const test::ProcessResult ended = run_cli(words);
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_THAT(ended.out, HasSubstr("x\n"));
    EXPECT_THAT(ended.out, HasSubstr("cornell-mirrors\n"));
    const json document = json::parse(read_output_file("out/report.json"));
    EXPECT_EQ(document["schema"], "catoptric/compare-scenes/1");
    EXPECT_EQ(document["complete"], true);
    EXPECT_EQ(document["asked"], json({"x.obj", "cornell-mirrors"}));
    ASSERT_EQ(document["scenes"].size(), 2u);
    for (const json& scene : document["scenes"]) {
        EXPECT_EQ(scene["schema"], "catoptric/compare/1");
        EXPECT_EQ(scene["rows"].size(), 2u);
        EXPECT_FALSE(scene["pareto"].empty());
        for (const json& row : scene["rows"])
            EXPECT_TRUE(std::filesystem::exists(folder / "out" / row["image"])) << row["image"];
    }
    EXPECT_EQ(document["scenes"][1]["rows"][0]["image"], "images/2-cornell-mirrors/reuse.png");
    const std::string page = read_output_file("out/report.html");
    for (const char* part : {"id=\"1-x-\"", "id=\"1-x-row-1\"", "id=\"2-cornell-mirrors-row-0\"",
                             "href=\"#2-cornell-mirrors-row-1\""})
        EXPECT_THAT(page, HasSubstr(part));
    const std::string csv = read_output_file("out/rows.csv");
    EXPECT_EQ(std::ranges::count(csv, '\n'), 5) << "a header and four rows";

    // An error in a later scene is found before any scene is rendered.
    words[2] = "gone.obj";
    EXPECT_EQ(run_cli(words).exit_code, 66);
    words[2] = "x.obj";
    EXPECT_EQ(run_cli(words).exit_code, 0) << "the same scene twice";
    EXPECT_TRUE(std::filesystem::exists(folder / "out/images/2-x/reuse.png"));
}

TEST_F(SceneOverrides, CompareOfSeveralScenesPrintsOneJsonDocument) {
    const test::ProcessResult ended = run_cli(
        add_small_frame_options({"compare", "cornell-mirrors", "cornell-mirrors-closed", "-o",
                                 "out", "--techniques", "proxy", "--json"}));
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_EQ(ended.out, read_output_file("out/report.json"));
}

/// --set takes the keys of the file, and draws what the option of that name draws.
TEST_F(SceneOverrides, SetTakesTheKeysOfTheSceneFile) {
    const auto render = [&](const Words& more, const std::string& picture) {
        Words words{"render",  "x.obj", "--technique", "raytrace:depth=1", "--size", "16x16",
                    "--quiet", "-o",    picture};
        words.insert(words.end(), more.begin(), more.end());
        return run_cli(words);
    };
    ASSERT_EQ(render({"--ambient", ".5", "--exposure", "1", "--mirror", "tin=.5", "--camera",
                      "0,1,9:0,1,0:30"},
                     "options.png")
                  .exit_code,
              0);
    const test::ProcessResult set = render({"--set", "ambient=.5", "--set", "exposure=1", "--set",
                                            "mirrors=tin=.5", "--set", "camera=0,1,9:0,1,0:30",
                                            "--ambient", "0"},
                                           "set.png");
    ASSERT_EQ(set.exit_code, 0) << set.err;
    EXPECT_EQ(read_output_file("set.png"), read_output_file("options.png"));
    ASSERT_EQ(render({"--mirror", "tin"}, "plain.png").exit_code, 0);
    EXPECT_NE(read_output_file("plain.png"), read_output_file("options.png"));
    for (const auto& [text, says] : std::vector<std::pair<std::string, std::string>>{
             {"ambient", "--set: wanted KEY=VALUE, such as ambient=0, found 'ambient'"},
             {"ambeint=1", "did you mean 'ambient'"},
             {"ambient=-1", "--set: ambient: wanted a number from 0"},
             {"ambient=much", "--set: ambient: wanted a number from 0"},
             {"light_samples=1.5", "--set: light_samples: wanted a whole number"},
             {"up=x", "--set: up: wanted \"y\" or \"z\""},
             {"lights=[1]", "--set: lights: wanted a text"}}) {
        const test::ProcessResult refused = render({"--set", text}, "x.png");
        EXPECT_EQ(refused.exit_code, 2) << text << refused.err;
        EXPECT_THAT(refused.err, HasSubstr(says));
    }
}

} // namespace
