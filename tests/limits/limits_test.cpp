// Tests on a device with the small limits of layer/limits_layer.cpp. The device must draw the same
// pictures and refuse settings that it cannot support. `./dev test --label limits-all` runs all
// tests of gpu/ and reflect/ on such a device.
#include "cli/program.hpp"

namespace {

class SmallDeviceLimitsTest : public CommandLineTest {
protected:
    test::ProcessResult run_on_device_with_small_limits(const Words& words) const {
        test::ProcessStartOptions process = make_process_start(words);
        process.environment["VK_ADD_LAYER_PATH"] = CATOPTRIC_LIMITS_LAYER;
        process.environment["VK_INSTANCE_LAYERS"] = "VK_LAYER_CATOPTRIC_limits";
        return test::run_process(process);
    }
    /// Renders on the small device and on the usual device. Expects equal bytes.
    void expect_same_picture(Words words) const {
        words.insert(words.end(), {"--validate", "-o", "small.exr"});
        const test::ProcessResult small = run_on_device_with_small_limits(
            add_small_frame_options(words));
        ASSERT_EQ(small.exit_code, 0) << small.err;
        words.back() = "usual.exr";
        ASSERT_EQ(run_cli(add_small_frame_options(words)).exit_code, 0);
        EXPECT_EQ(read_output_file("small.exr"), read_output_file("usual.exr"))
            << testing::PrintToString(words);
    }
    double difference_of_pictures() const {
        const test::ProcessResult ended = run_cli({"diff", "small.exr", "usual.exr", "--json"});
        return nlohmann::json::parse(ended.out)["rmse"].get<double>();
    }
};

/// The three scenes fill every texel buffer: surfaces, mirrors and their tree, attributes,
/// textures, the environment and the BVH.
TEST_F(SmallDeviceLimitsTest, RayTracerDrawsTheSamePicture) {
    for (const std::string scene : {"cornell-mirrors", "room", "courtyard"})
        expect_same_picture({"render", scene, "--technique", "raytrace"});
}

TEST_F(SmallDeviceLimitsTest, HalfFloatDistancesGiveTheSamePicture) {
    expect_same_picture({"render", "gallery", "--technique", "naive:face=32"});
    expect_same_picture({"render", "cornell-mirrors", "--technique", "layered:face=32"});
}

/// The device with small limits cannot filter 32-bit floats, so the shader filters distances
/// itself, with other rounding errors than the driver.
TEST_F(SmallDeviceLimitsTest, FilteredDistancesGiveNearlyTheSamePicture) {
    for (const std::string technique : {"parallax", "secant", "pyramid", "hybrid"}) {
        Words words = add_small_frame_options(
            {"render", "--technique", technique + ":face=64", "--validate"});
        words.insert(words.end(), {"-o", "small.exr"});
        const test::ProcessResult small = run_on_device_with_small_limits(words);
        ASSERT_EQ(small.exit_code, 0) << technique << ": " << small.err;
        words.back() = "usual.exr";
        ASSERT_EQ(run_cli(words).exit_code, 0);
        EXPECT_LT(difference_of_pictures(), 1e-3) << technique;
    }
}

/// 30,000 triangles have 90,000 corners, more than a texel buffer of the small device can hold.
TEST_F(SmallDeviceLimitsTest, SceneOfManyTrianglesIsDrawn) {
    std::string text = "mtllib m.mtl\nusemtl white\n";
    for (int i = 0; i < 30000; ++i) {
        const double x = i % 200 / 100.0 - 1, y = i / 200 / 75.0 - 1;
        text += "v " + std::to_string(x) + " " + std::to_string(y) + " 0\nv " +
                std::to_string(x + .01) + " " + std::to_string(y) + " 0\nv " + std::to_string(x) +
                " " + std::to_string(y + .012) + " .01\nf -3 -2 -1\n";
    }
    write_input_file("many.obj", text), write_input_file("m.mtl", "newmtl white\nKd .8 .7 .6\n");
    expect_same_picture({"render", "many.obj", "--technique", "raytrace"});
}

/// The device with small limits cannot blend attachments of a pass in different ways. Blended
/// surfaces are therefore cut out where their alpha is below .5, in rasterised and in traced
/// pictures.
TEST_F(SmallDeviceLimitsTest, BlendedSurfacesAreCutAtHalf) {
    const std::string wall = "mtllib m.mtl\nv -2 -2 -1\nv 2 -2 -1\nv 2 2 -1\nv -2 2 -1\n"
                             "usemtl white\nf 1 2 3 4\n",
                      veil = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nusemtl veil\nf 5 6 7 8\n";
    write_input_file("m.mtl", "newmtl white\nKd .8 .7 .6\nnewmtl veil\nKd .9 .1 .1\nd .3\n");
    write_input_file("veil.obj", wall + veil), write_input_file("wall.obj", wall);
    for (const std::string technique : {"naive:bounces=0", "raytrace", "raytrace:first=raster"}) {
        const auto make_words = [&](const char* file, const char* picture) {
            return add_small_frame_options({"render", file, "--technique", technique, "--camera",
                                            "0,0,4:0,0,0:40", "--validate", "-o", picture});
        };
        for (const auto& [file, picture] :
             {std::pair{"veil.obj", "small.exr"}, {"wall.obj", "usual.exr"}}) {
            const test::ProcessResult ended = run_on_device_with_small_limits(
                make_words(file, picture));
            ASSERT_EQ(ended.exit_code, 0) << technique << ": " << ended.err;
        }
        EXPECT_LT(difference_of_pictures(), 1e-4) << technique << ": the veil is cut out";
        ASSERT_EQ(run_cli(make_words("veil.obj", "small.exr")).exit_code, 0);
        EXPECT_GT(difference_of_pictures(), .01) << technique << ": the usual device blends it";
    }
}

TEST_F(SmallDeviceLimitsTest, TintedShadowsOfGlassAreRefused) {
    expect_exit_code(
        run_on_device_with_small_limits({"render", "glass", "--glass-shadow", "tint", "--size",
                                         "16x16", "--technique", "secant", "-o", "x.png"}),
        69,
        {"--glass-shadow tint", "blends one attachment alone", "render with --glass-shadow none"});
    EXPECT_FALSE(std::filesystem::exists(folder / "x.png"));
}

TEST_F(SmallDeviceLimitsTest, ColourOf32BitFloatsIsRefused) {
    expect_exit_code(run_on_device_with_small_limits(
                         {"render", "--technique", "parallax:colour=float", "-o", "x.png"}),
                     69, {"colour=float filters images of 32-bit floats", "take colour=half"});
    EXPECT_FALSE(std::filesystem::exists(folder / "x.png"));
    const test::ProcessResult half = run_on_device_with_small_limits(
        add_small_frame_options({"render", "--technique", "parallax:colour=half", "-o", "x.png"}));
    EXPECT_EQ(half.exit_code, 0) << half.err;
}

} // namespace
