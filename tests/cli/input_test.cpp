// Tests of exit codes: 66 for a missing input file, 65 for an invalid file, 69 without a Vulkan
// device.
#include "cli/program.hpp"

namespace {

TEST_F(CommandLineTest, MissingInputFileIsRefused) {
    for (const std::string name : {"none.glb", "none.gltf", "none.obj"})
        expect_usage_refused({"render", name, "--technique", "reuse", "-o", "x.png"}, 66, {name});
    expect_usage_refused({"diff", "none.exr", "none.png"}, 66, {"none.exr"});
}

TEST_F(CommandLineTest, InvalidSceneFileIsRefused) {
    write_input_file("garbage.glb", "this is no scene at all, whatever its name says");
    expect_usage_refused({"render", "garbage.glb", "--technique", "reuse", "-o", "x.png"}, 65,
                         {"garbage.glb"});
    write_input_file("empty.glb", "");
    expect_usage_refused({"render", "empty.glb", "--technique", "reuse", "-o", "x.png"}, 65,
                         {"empty.glb"});
    write_input_file("garbage.gltf", "{\"asset\": ");
    expect_usage_refused({"render", "garbage.gltf", "--technique", "reuse", "-o", "x.png"}, 65,
                         {"garbage.gltf"});
}

/// The first message says that the scene lacks a mirror and how to make a mirror. Messages of the
/// loader may only follow after it.
TEST_F(CommandLineTest, CompareOfASceneWithoutAMirrorSaysHowToMakeOne) {
    write_input_file("plain.obj", "o a b\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const test::ProcessResult ended = run_cli({"compare", "plain.obj", "-o", "out"});
    EXPECT_EQ(ended.exit_code, 65);
    EXPECT_EQ(ended.err,
              "catoptric: scene 'plain': wanted a mirror, whose reflections are what is compared, "
              "found none; make one with --mirror PATTERN[=REFLECTANCE], such as\n"
              "  --mirror 'a b'\n");
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
    // The option that the message suggests makes the command succeed.
    EXPECT_EQ(run_cli(add_small_frame_options({"compare", "plain.obj", "-o", "out", "--mirror",
                                               "a b", "--techniques", "reuse"}))
                  .exit_code,
              0);
    const std::string warning =
        "catoptric: warning: scene 'plain' has no mirror; try --mirror 'a b'\n";
    for (const Words& words :
         {add_small_frame_options({"render", "plain.obj", "--technique", "reuse", "-o", "x.png"}),
          {"graph", "plain.obj", "--technique", "reuse"},
          {"info", "plain.obj"}}) {
        const test::ProcessResult goes_on = run_cli(words);
        EXPECT_EQ(goes_on.exit_code, 0);
        EXPECT_THAT(goes_on.err, testing::HasSubstr(warning)) << words[0];
    }
}

TEST_F(CommandLineTest, TruncatedGlbIsRefused) {
    // The header of this .glb file states a length of 4096 bytes, but the file ends within its
    // JSON.
    std::string bytes = "glTF";
    for (const unsigned word : {2U, 4096U, 2048U, 0x4E4F534AU})
        for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(word >> shift);
    write_input_file("cut.glb", bytes + "{\"asset\":{\"version\":\"2.0\"}");
    expect_usage_refused({"render", "cut.glb", "--technique", "reuse", "-o", "x.png"}, 65,
                         {"cut.glb"});
}

TEST_F(CommandLineTest, ObjWithoutTrianglesIsRefused) {
    write_input_file("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    expect_usage_refused({"render", "points.obj", "--technique", "reuse", "-o", "x.png"}, 65,
                         {"points.obj"});
}

TEST_F(CommandLineTest, DiffRefusesFilesThatAreNoPictures) {
    write_input_file("a.png", "no PNG");
    write_input_file("a.exr", "no EXR");
    expect_usage_refused({"diff", "a.png", "a.png"}, 65, {"a.png"});
    expect_usage_refused({"diff", "a.exr", "a.exr"}, 65, {"a.exr"});
}

TEST_F(CommandLineTest, SceneWithoutACameraGetsOneWithAMessage) {
    write_input_file("triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const test::ProcessResult ended = run_cli(add_small_frame_options(
        {"render", "triangle.obj", "--technique", "raytrace", "-o", "x.png"}));
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_THAT(ended.err, testing::HasSubstr("no camera: using --camera "));
    const test::ProcessResult quiet = run_cli(add_small_frame_options(
        {"render", "triangle.obj", "--technique", "raytrace", "-o", "x.png", "--quiet"}));
    EXPECT_THAT(quiet.err, testing::Not(testing::HasSubstr("no camera")));
}

TEST_F(CommandLineTest, ErrorForAMissingDriverSaysWhatToInstall) {
    const auto without = [&](const Words& words) {
        test::ProcessStartOptions process = make_process_start(words);
        for (const char* name : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"})
            process.environment[name] = (folder / "none.json").string();
        return test::run_process(process);
    };
    expect_exit_code(without({"render", "--technique", "reuse", "-o", "x.png"}), 69,
                     {"mesa-vulkan-drivers"});
    expect_exit_code(without({"compare", "-o", "x"}), 69, {"mesa-vulkan-drivers"});
    expect_exit_code(without({"list", "devices"}), 69, {"mesa-vulkan-drivers"});
    EXPECT_FALSE(std::filesystem::exists(folder / "x"));

    const test::ProcessResult info = without({"info", "--json"});
    EXPECT_EQ(info.exit_code, 0) << info.err;
    const nlohmann::json document = nlohmann::json::parse(info.out);
    EXPECT_TRUE(document["device"].is_null());
    EXPECT_THAT(document["no_device"], testing::HasSubstr("mesa-vulkan-drivers"));
}

} // namespace
