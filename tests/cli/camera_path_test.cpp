// Tests of `render --camera-path`: the spline, the pictures along it, and the text of errors.
#include "catoptric/camera_path.hpp"
#include "cli/program.hpp"

#include <glm/glm.hpp>

#include <cmath>

namespace {

using namespace catoptric;
using cli::CameraKey;
using cli::CameraPath;
using testing::HasSubstr;

CameraKey make_camera_key(double seconds, dvec3 eye, dvec3 target, double degrees = 45) {
    return {seconds, {.eye = eye, .target = target, .vertical_fov_degrees = degrees}};
}

TEST(CameraPathSpline, PassesThroughTheKeysAndStopsAtTheLast) {
    const std::vector<CameraKey> keys{make_camera_key(1, {0, 0, 4}, {0, 1, 0}, 30),
                                      make_camera_key(1.5, {3, 1, 2}, {0, 0, 0}, 60),
                                      make_camera_key(4, {-2, 5, 1}, {1, 0, 0}, 50)};
    const CameraPath path(keys);
    EXPECT_EQ(path.duration(), 3);
    for (const CameraKey& key : keys) {
        const scene::Camera camera = path.camera_after(key.seconds - 1);
        EXPECT_EQ(camera.eye, key.camera.eye);
        EXPECT_EQ(camera.target, key.camera.target);
        EXPECT_EQ(camera.vertical_fov_degrees, key.camera.vertical_fov_degrees);
    }
    EXPECT_EQ(path.camera_after(100).eye, keys[2].camera.eye);
    EXPECT_EQ(path.camera_after(-1).eye, keys[0].camera.eye);
    const CameraPath decimal(
        {make_camera_key(.1, {0, 0, 4}, {0, 1, 0}), make_camera_key(.7, {.3, .1, 2}, {0, 0, 0})});
    EXPECT_EQ(decimal.camera_after(decimal.duration()).eye, dvec3(.3, .1, 2));
}

TEST(CameraPathSpline, TwoKeysGiveAStraightLineOfConstantSpeed) {
    const CameraPath path({make_camera_key(0, {0, 0, 4}, {0, 1, 0}, 30),
                           make_camera_key(2, {4, 0, 0}, {0, 1, 0}, 60)});
    for (const double share : {.1, .25, .5, .9}) {
        const scene::Camera camera = path.camera_after(2 * share);
        EXPECT_LT(glm::distance(camera.eye, dvec3(4 * share, 0, 4 - 4 * share)), 1e-14);
        EXPECT_NEAR(camera.vertical_fov_degrees, 30 + 30 * share, 1e-13);
    }
}

/// With tangents by central differences a spline reproduces straight motion through keys at unequal
/// distances in time. Tangents of the uniform spline do not.
TEST(CameraPathSpline, UnevenKeysOnALineKeepTheSpeed) {
    const auto eye = [](double t) { return dvec3(3 * t, -t, 4 + 2 * t); };
    std::vector<CameraKey> keys;
    for (const double t : {0., .1, 1., 1.2, 3.})
        keys.push_back(make_camera_key(t, eye(t), {9, 9, 9}));
    const CameraPath path(keys);
    for (double t = 0; t <= 3; t += .05)
        EXPECT_LT(glm::distance(path.camera_after(t).eye, eye(t)), 1e-13) << t;
}

TEST(CameraPathSpline, SpeedDoesNotJumpAtAKey) {
    const CameraPath path(
        {make_camera_key(0, {0, 0, 4}, {0, 0, 0}), make_camera_key(1, {2, 0, 2}, {0, 0, 0}),
         make_camera_key(1.5, {0, 3, 1}, {0, 0, 0}), make_camera_key(4, {1, 1, 1}, {0, 0, 0})});
    constexpr double kStep = 1e-6;
    for (const double t : {1., 1.5}) {
        const dvec3 before = (path.camera_after(t).eye - path.camera_after(t - kStep).eye) / kStep;
        const dvec3 after = (path.camera_after(t + kStep).eye - path.camera_after(t).eye) / kStep;
        EXPECT_GT(glm::length(before), .1);
        EXPECT_LT(glm::distance(before, after), 1e-4) << t;
    }
}

class CameraPathCliTest : public CommandLineTest {
protected:
    /// Renders with ray tracing at 32x24 and returns the bytes of a picture.
    std::string render_picture_at_camera(const std::string& camera) {
        const test::ProcessResult ended = run_cli({"render", "--technique", "raytrace:depth=1",
                                                   "--size", "32x24", "--exposure", "0", "--camera",
                                                   camera, "-o", "still.png"});
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        return read_output_file("still.png");
    }
    void expect_path_refused(const std::string& path, const std::vector<std::string>& parts) {
        write_input_file("path.json", path);
        const test::ProcessResult ended = run_cli({"render", "--technique", "raytrace:depth=0",
                                                   "--size", "16x16", "--camera-path", "path.json",
                                                   "-o", "p{n}.png"});
        EXPECT_EQ(ended.exit_code, 65) << path;
        for (const std::string& part : parts) EXPECT_THAT(ended.err, HasSubstr(part)) << path;
        EXPECT_FALSE(std::filesystem::exists(folder / "p1.png"));
    }
};

TEST_F(CameraPathCliTest, PicturesAreThoseOfTheCamerasAlongThePath) {
    write_input_file("path.json",
                     R"({"keys": [{"time": 0, "camera": "0,1,3:0,1,0:40"},)"
                     R"({"time": 0.06666666666666667, "camera": "0.5,1.5,3:0,1,0:48"}]})");
    const test::ProcessResult ended = run_cli(
        {"render", "--technique", "raytrace:depth=1", "--size", "32x24", "--exposure", "0",
         "--warmup", "2", "--camera-path", "path.json", "-o", "p{n}.png", "--json"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const nlohmann::json said = nlohmann::json::parse(ended.out);
    EXPECT_EQ(said["frames"], 5) << "4 steps of 1/60 s";
    EXPECT_EQ(said["camera"], "path.json");
    EXPECT_FALSE(std::filesystem::exists(folder / "p6.png"));
    const std::string first = read_output_file("p1.png");
    EXPECT_EQ(first, render_picture_at_camera("0,1,3:0,1,0:40"))
        << "warm-up frames stand at the first key";
    EXPECT_EQ(read_output_file("p3.png"), render_picture_at_camera("0.25,1.25,3:0,1,0:44"));
    EXPECT_EQ(read_output_file("p5.png"), render_picture_at_camera("0.5,1.5,3:0,1,0:48"));
    EXPECT_NE(first, read_output_file("p3.png"));
}

TEST_F(CameraPathCliTest, FramesAfterThePathStandAtItsEnd) {
    write_input_file("path.json", R"({"keys": [{"time": 0, "camera": "0,1,3:0,1,0:40"},)"
                                  R"({"time": 0.02, "camera": "0.5,1.5,3:0,1,0:40"}]})");
    const test::ProcessResult ended = run_cli(
        {"render", "--technique", "raytrace:depth=1", "--size", "32x24", "--exposure", "0",
         "--warmup", "0", "--frames", "4", "--camera-path", "path.json", "-o", "p{n}.png"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_EQ(read_output_file("p3.png"), render_picture_at_camera("0.5,1.5,3:0,1,0:40"));
    EXPECT_EQ(read_output_file("p4.png"), read_output_file("p3.png"));
    EXPECT_NE(read_output_file("p2.png"), read_output_file("p3.png"));
}

TEST_F(CameraPathCliTest, LastFrameOfAPathShowsItsLastKey) {
    write_input_file("path.json", R"({"keys": [{"time": 0, "camera": "0,1,3:0,1,0:40"},)"
                                  R"({"time": 0.02, "camera": "0.5,1.5,3:0,1,0:40"}]})");
    const test::ProcessResult ended = run_cli({"render", "--technique", "raytrace:depth=1",
                                               "--size", "32x24", "--exposure", "0",
                                               "--camera-path", "path.json", "-o", "last.png"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_EQ(read_output_file("last.png"), render_picture_at_camera("0.5,1.5,3:0,1,0:40"));
}

TEST_F(CameraPathCliTest, FileOfThePathIsNotOverwritten) {
    const std::string path = R"({"keys": [{"time": 0, "camera": "0,1,3:0,1,0:40"},)"
                             R"({"time": 1, "camera": "0.5,1.5,3:0,1,0:40"}]})";
    write_input_file("path.json", path);
    const test::ProcessResult ended = run_cli({"render", "--technique", "raytrace:depth=0",
                                               "--size", "16x16", "--camera-path", "path.json",
                                               "--profile", "path.json", "-o", "p.png"});
    EXPECT_NE(ended.exit_code, 0);
    EXPECT_THAT(ended.err, HasSubstr("path.json"));
    EXPECT_EQ(read_output_file("path.json"), path);
}

TEST_F(CameraPathCliTest, InvalidPathIsRefusedWithItsPlace) {
    const test::ProcessResult missing = run_cli({"render", "--technique", "raytrace:depth=0",
                                                 "--camera-path", "none.json", "-o", "p{n}.png"});
    EXPECT_EQ(missing.exit_code, 66);
    EXPECT_THAT(missing.err, HasSubstr("none.json"));
    const test::ProcessResult of_folder = run_cli(
        {"render", "--technique", "raytrace:depth=0", "--camera-path", ".", "-o", "p{n}.png"});
    EXPECT_EQ(of_folder.exit_code, 65);
    EXPECT_THAT(of_folder.err, HasSubstr(".: wanted a file with a camera path"));
    expect_path_refused("{", {"path.json"});
    expect_path_refused("[]", {"path.json: wanted an object with at least two 'keys'", "a list"});
    const std::string first = R"({"time": 0, "camera": "0,1,3:0,1,0:40"})";
    expect_path_refused(R"({"keys": [)" + first + "]}", {"at least two 'keys', found 1"});
    expect_path_refused(R"({"keys": [)" + first + R"(, 7]})", {"keys[1]: wanted an object", "7"});
    expect_path_refused(R"({"keys": [)" + first + ", " + first + R"(]})",
                        {"keys[1].time: wanted more than 0, found 0"});
    expect_path_refused(R"({"keys": [)" + first + R"(, {"time": -1, "camera": "0"}]})",
                        {"keys[1].time: wanted seconds", "-1"});
    expect_path_refused(R"({"keys": [)" + first + R"(, {"time": 1}]})",
                        {"keys[1].camera: wanted the text of a camera", "nothing"});
    expect_path_refused(R"({"keys": [)" + first + R"(, {"time": 1, "camera": "none"}]})",
                        {"keys[1].camera", "no camera 'none'"});
    expect_path_refused(R"({"keys": [)" + first + R"(, {"time": 1, "camera": "seeded"}]})",
                        {"keys[1].camera", "found 'seeded'"});
    expect_path_refused(R"({"keys": [)" + first + R"(, {"time": 1, "eye": 0}]})",
                        {"keys[1]: wanted time and camera, found 'eye'"});
    expect_path_refused(R"({"keys": [)" + first + R"(, {"time": 1, "camera": "0,1,3:0,1,0:h=2"}]})",
                        {"keys[1].camera: wanted all cameras perspective or all orthographic"});
    expect_path_refused(R"({"keys": [)" + first + "," +
                            R"({"time": 1, "camera": "0,1,1:0,1,2:40"}],)" + R"("loop": true})",
                        {"wanted only 'keys', found 'loop'"});
    // Halfway along this path the eye passes through the target, so the path is refused.
    expect_path_refused(R"({"keys": [)" + first + R"(, {"time": 1, "camera": "0,1,-3:0,1,0:40"}]})",
                        {"path.json: after 0.5 s", "beside its up axis"});
    expect_usage_refused({"render", "--technique", "raytrace", "--camera-path", "path.json",
                          "--camera", "0", "-o", "p{n}.png"},
                         2, {"--camera-path", "without --camera"});
}

} // namespace
