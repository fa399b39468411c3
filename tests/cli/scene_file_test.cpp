// Tests of scene files that name files outside their folder, use unknown extensions, have many
// mirrors, or hold control characters in names.
#include "cli/triangle.hpp"

#include <algorithm>

namespace {

namespace fs = std::filesystem;
using namespace test::loading;

bool is_printable_text(const std::string& text) {
    return std::ranges::all_of(
        text, [](unsigned char c) { return c == '\n' || c == '\r' || (c >= 0x20 && c != 0x7f); });
}

class SceneFile : public CommandLineTest {
protected:
    static Words make_scene_render_words(const std::string& scene, const Words& more = {}) {
        Words words = {"render", scene, "--technique", "raytrace", "-o", "x.png"};
        words.insert(words.end(), more.begin(), more.end());
        return add_small_frame_options(words);
    }
};

TEST_F(SceneFile, FilesOutsideTheFolderNeedTheRootOption) {
    fs::create_directories(folder / "in");
    write_input_file("secret.bin", encode_triangle_corners());
    fs::create_symlink("../secret.bin", folder / "in/link.bin");
    for (const std::string uri : {"../secret.bin", "link.bin", "%2e%2e/secret.bin"}) {
        write_input_file("in/x.gltf", make_triangle_gltf(uri).dump());
        expect_usage_refused(make_scene_render_words("in/x.gltf"), 65,
                             {"in/x.gltf: buffers[0]", "--root", "secret.bin'"});
        expect_usage_refused({"graph", "in/x.gltf", "--technique", "reuse"}, 65, {"--root"});
        expect_usage_refused({"compare", "in/x.gltf", "-o", "out"}, 65, {"--root"});
        EXPECT_EQ(run_cli(make_scene_render_words("in/x.gltf", {"--root", "."})).exit_code, 0)
            << uri;
    }
    expect_usage_refused(make_scene_render_words("in/x.gltf", {"--root", "in"}), 65, {"--root"});
    expect_usage_refused(make_scene_render_words("in/x.gltf", {"--root", "gone"}), 66,
                         {"--root", "'gone'"});
    expect_usage_refused(make_scene_render_words("in/x.gltf", {"--root", ""}), 2, {"--root"});
}

TEST_F(SceneFile, PlusInAUriIsNotReadAsASpace) {
    write_input_file("a b.bin", "not this one");
    write_input_file("x.gltf", make_triangle_gltf("a+b.bin").dump());
    expect_usage_refused(make_scene_render_words("x.gltf"), 66, {"'a+b.bin' is not there"});
    write_input_file("a+b.bin", encode_triangle_corners());
    EXPECT_EQ(run_cli(make_scene_render_words("x.gltf")).exit_code, 0);
}

TEST_F(SceneFile, UnreadExtensionIsNamed) {
    Json scene = make_triangle_gltf("a.bin");
    scene["extensions"]["EXT_moon"] = Json::object();
    write_input_file("a.bin", encode_triangle_corners());
    write_input_file("x.gltf", scene.dump());
    const std::string err = run_cli(make_scene_render_words("x.gltf", {"--quiet"})).err;
    EXPECT_THAT(err,
                testing::HasSubstr("catoptric: warning: x.gltf: extension 'EXT_moon', not read: 1 "
                                   "(first: of the whole file)\n"));
}

// Every verb that loads a scene with more than 64 mirrors warns of the cost of captures. The report
// keeps the warning.
TEST_F(SceneFile, CostOfManyMirrorsIsReported) {
    write_input_file("a.bin", encode_triangle_corners());
    const auto write_mirrors = [&](int count) {
        Json scene = make_triangle_gltf("a.bin");
        scene["nodes"] = Json::array();
        for (int i = 0; i < count; ++i)
            scene["nodes"].push_back(
                {{"mesh", 0}, {"name", "m" + std::to_string(i)}, {"translation", {1.5 * i, 0, 0}}});
        write_input_file("x.gltf", scene.dump());
    };
    write_mirrors(64);
    EXPECT_THAT(run_cli(make_scene_render_words("x.gltf", {"--mirror", "m*"})).err,
                testing::Not(testing::HasSubstr("captures")));
    write_mirrors(65);
    const std::string sentence = "scene 'x' has 65 mirrors: 65 captures of six faces a frame, 390 "
                                 "to 780 MiB at face=256; a smaller face=, --plan and --model "
                                 "required lessen that";
    EXPECT_THAT(run_cli(make_scene_render_words("x.gltf", {"--mirror", "m*", "--quiet"})).err,
                testing::HasSubstr("catoptric: warning: " + sentence + "\n"));
    const Json info = Json::parse(run_cli({"info", "x.gltf", "--json", "--mirror", "m*"}).out);
    EXPECT_THAT(info["warnings"], testing::Contains(Json(sentence)));
    const test::ProcessResult compared = run_cli(add_small_frame_options(
        {"compare", "x.gltf", "--mirror", "m*", "--techniques", "reuse:face=1", "-o", "out"}));
    EXPECT_EQ(compared.exit_code, 0) << compared.err;
    EXPECT_THAT(Json::parse(read_output_file("out/report.json"))["warnings"],
                testing::Contains(Json(sentence)));
}

/// The names in this scene hold codes that clear a terminal, set its title, begin a line or reverse
/// the direction of writing.
TEST_F(SceneFile, NamesPrintNoTerminalControlCharacters) {
    const std::string evil = "\x1b[2J\x1b]0;title\x07\rcatoptric: \xc2\x9b"
                             "31m\xe2\x80\xae";
    write_input_file(evil + ".obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\no " + evil +
                                        "\nusemtl " + evil + "\nf 1 2 3\nf 1 1 2\n" + evil +
                                        " 1\n");
    write_input_file("m.mtl", "newmtl " + evil + "\nillum 3\nKs 1 1 1\n" + evil + "\n");
    const test::ProcessResult render_it = run_cli(make_scene_render_words(evil + ".obj"));
    EXPECT_EQ(render_it.exit_code, 0) << render_it.err;
    EXPECT_THAT(render_it.err, testing::HasSubstr("\\x1b[2J"));
    EXPECT_TRUE(is_printable_text(render_it.err));
    EXPECT_TRUE(is_printable_text(run_cli(make_scene_render_words(evil + ".gltf")).err));

    const test::ProcessResult compare = run_cli(
        add_small_frame_options({"compare", evil + ".obj", "-o", "out", "--techniques", "reuse"}));
    EXPECT_EQ(compare.exit_code, 0) << compare.err;
    EXPECT_TRUE(is_printable_text(compare.out)) << compare.out;
    EXPECT_TRUE(is_printable_text(compare.err));
    for (const char* name : {"report.json", "report.md", "report.html", "rows.csv"}) {
        const std::string text = read_output_file(std::string("out/") + name);
        EXPECT_FALSE(text.empty());
        EXPECT_TRUE(is_printable_text(text)) << name;
        EXPECT_EQ(text.find("\xe2\x80\xae"), text.npos) << name;
        EXPECT_EQ(text.find("\xc2\x9b"), text.npos) << name;
    }
    EXPECT_EQ(Json::parse(read_output_file("out/report.json"))["scene"]["name"], evil)
        << "nothing is lost";
}

} // namespace
