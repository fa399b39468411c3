// Tests that an output path may not name an input file or another output, also through links. The
// program exits with 2 and names both paths before it renders.
#include "cli/program.hpp"

namespace {

namespace fs = std::filesystem;

class Places : public CommandLineTest {
protected:
    static constexpr const char* kMirror =
        "mtllib room.mtl\nusemtl mirror\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    static constexpr const char* kMaterials = "newmtl mirror\nKd 0 0 0\nKs 1 1 1\nillum 3\n";

    void SetUp() override {
        write_input_file("room.obj", kMirror);
        write_input_file("room.mtl", kMaterials);
    }
    static Words render_words(const std::string& scene, const Words& outputs) {
        Words words{"render", scene, "--technique", "raytrace:depth=1"};
        words.insert(words.end(), outputs.begin(), outputs.end());
        words.push_back("--quiet");
        return add_small_frame_options(words);
    }
    static Words make_compare_words(const std::string& scene) {
        return add_small_frame_options({"compare", scene, "--quiet", "-o", "out", "--techniques",
                                        "raytrace:depth=1", "reuse"});
    }
    void expect_inputs_unchanged() const {
        EXPECT_EQ(read_output_file("room.obj"), kMirror);
        EXPECT_EQ(read_output_file("room.mtl"), kMaterials);
    }
};

TEST_F(Places, OutputOverASceneFileIsRefused) {
    fs::create_directory(folder / "sub");
    fs::create_symlink("../room.obj", folder / "sub/link.png");
    fs::create_directory_symlink("sub", folder / "also");
    fs::create_hard_link(folder / "room.mtl", folder / "hard.png");
    fs::create_symlink("room.obj", folder / "scene.obj");
    for (const auto& [scene, output, input] :
         {std::tuple{"room.obj", "sub/link.png", "room.obj"},
          std::tuple{"room.obj", "also/../sub/link.png", "room.obj"},
          std::tuple{"scene.obj", "sub/link.png", ".obj"},
          std::tuple{"./sub/../room.obj", "hard.png", "room.mtl"}})
        for (const Words& outputs : {Words{"-o", output}, Words{"-o", "x.png", "--trace", output},
                                     Words{"-o", "x.png", "--profile", output}})
            expect_usage_refused(
                render_words(scene, outputs), 2,
                {std::string(output) + ": cannot be written: it is the same file as ",
                 std::string(input) + ", which the scene is read from"});
    EXPECT_FALSE(fs::exists(folder / "x.png"));
    expect_inputs_unchanged();
}

TEST_F(Places, CompareRefusesToOverwriteFilesOfItsScene) {
    fs::create_directories(folder / "out/images");
    for (const std::string name :
         {"report.json", "report.html", "report.md", "rows.csv", "images/reference.png",
          "images/raytrace-depth1.exr", "images/raytrace-depth1.png",
          "images/raytrace-depth1-error.png", "images/reuse.exr"}) {
        const fs::path file = folder / "out" / name;
        fs::create_hard_link(folder / "room.obj", file);
        expect_usage_refused(make_compare_words("room.obj"), 2,
                             {"out/" + name + ": cannot be written: it is the same file as ",
                              "room.obj, which the scene is read from"});
        fs::remove(file);
        fs::create_symlink(folder / "room.mtl", file);
        expect_usage_refused(make_compare_words("room.obj"), 2,
                             {"out/" + name + ": cannot be written: it is the same file as ",
                              "room.mtl, which the scene is read from"});
        fs::remove(file);
    }
    expect_inputs_unchanged();
}

TEST_F(Places, OutputOverAGltfBufferIsRefused) {
    write_input_file("room.gltf",
                     R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],)"
                     R"("nodes":[{"mesh":0}],)"
                     R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
                     R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,)"
                     R"("type":"VEC3","min":[0,0,0],"max":[1,1,0]}],)"
                     R"("bufferViews":[{"buffer":0,"byteLength":36}],)"
                     R"("buffers":[{"uri":"room.bin","byteLength":36}]})");
    const float triangle[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const std::string bytes(reinterpret_cast<const char*>(triangle), sizeof triangle);
    write_input_file("room.bin", bytes);
    fs::create_symlink("room.bin", folder / "x.png");
    expect_usage_refused(render_words("room.gltf", {"-o", "x.png"}), 2,
                         {"x.png: cannot be written: it is the same file as ", "room.bin"});
    EXPECT_EQ(read_output_file("room.bin"), bytes);
}

TEST_F(Places, TwoOutputsInTheSameFileAreRefused) {
    expect_usage_refused(
        render_words("room.obj", {"-o", "x.png", "--trace", "./x.png"}), 2,
        {"./x.png: cannot be written: it is the same file as x.png, which is written "
         "too"});
    expect_usage_refused(render_words("room.obj", {"-o", "x.png", "--trace", "x.png"}), 2,
                         {"x.png: wanted one output in a place, found two"});
    expect_usage_refused(
        render_words("room.obj", {"-o", "x.png", "--trace", "t.json", "--profile", "./t.json"}), 2,
        {"./t.json", "the same file as t.json, which is written too"});
    fs::create_symlink("t.json", folder / "later.png"); // neither file exists yet
    expect_usage_refused(render_words("room.obj", {"-o", "later.png", "--trace", "t.json"}), 2,
                         {"t.json", "the same file as later.png, which is written too"});
    fs::create_directory(folder / "out");
    fs::create_symlink("report.md", folder / "out/rows.csv");
    expect_usage_refused(make_compare_words("room.obj"), 2,
                         {"out/rows.csv", "the same file as out/report.md"});
    write_input_file("out/stress.md", "old");
    fs::create_hard_link(folder / "out/stress.md", folder / "out/stress.html");
    expect_usage_refused({"stress", "-o", "out", "--only", "N10"}, 2,
                         {"out/stress.md", "the same file as out/stress.html"});
    EXPECT_EQ(read_output_file("out/stress.md"), "old");
    EXPECT_FALSE(fs::exists(folder / "x.png"));
}

/// The file to which the shell redirects stdout counts as an output if the program prints its
/// result, as with `--json`.
TEST_F(Places, OutputThatIsAlsoStdoutIsRefused) {
    test::ProcessStartOptions process = make_process_start(
        render_words("room.obj", {"-o", "x.png", "--trace", "t.json", "--json"}));
    process.out_path = (folder / "t.json").string();
    expect_exit_code(test::run_process(process), 2, {"t.json", "the same file as /dev/stdout"});
    process = make_process_start({"graph", "room.obj", "--technique", "raytrace", "-q"});
    process.out_path = (folder / "room.mtl").string(); // which this empties
    expect_exit_code(test::run_process(process), 2,
                     {"/dev/stdout", "the same file as", "room.mtl"});
    write_input_file("room.mtl", kMaterials);
    process = make_process_start(render_words("room.obj", {"-o", "x.png", "--trace", "t.json"}));
    process.out_path = (folder / "t.json").string();
    EXPECT_EQ(test::run_process(process).exit_code, 0);
}

/// /dev/null may be named for two outputs, because it is no regular file.
TEST_F(Places, DeviceFileMayBeNamedForTwoOutputs) {
    fs::create_symlink("/dev/null", folder / "null.png");
    const test::ProcessResult ended = run_cli(
        render_words("room.obj", {"-o", "null.png", "--trace", "/dev/null"}));
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
}

} // namespace
