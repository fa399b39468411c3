// Tests of glTF animations: each kind of track, each interpolation, and moving parents.
#include "import/file_options.hpp"
#include "scene/pose.hpp"
#include "scene/transform.hpp"
#include "unit/load_fixture.hpp"

#include <cmath>

namespace {

using namespace test::loading;

class LoadAnimationTest : public Load {
protected:
    /// Builds a glTF file whose node 0 moves by a track of `path`, with keys at `times` in seconds.
    static GltfFileBuilder make_gltf_with_moving_node(const std::string& path,
                                                      const std::vector<float>& values,
                                                      const char* interpolation = "LINEAR",
                                                      const std::vector<float>& times = {0, 1, 3}) {
        GltfFileBuilder gltf = make_small_gltf();
        add_animation_channel(gltf, 0, path, values, interpolation, times);
        return gltf;
    }
    /// Adds a channel to the file's only animation.
    static void add_animation_channel(GltfFileBuilder& gltf, int node, const std::string& path,
                                      const std::vector<float>& values,
                                      const char* interpolation = "LINEAR",
                                      const std::vector<float>& times = {0, 1, 3}) {
        Json& animation = gltf.root["animations"][0];
        const std::size_t input = gltf.add_accessor(times, "SCALAR", 5126);
        const std::size_t output = gltf.add_accessor(values, path == "rotation" ? "VEC4" : "VEC3",
                                                     5126);
        animation["channels"].push_back({{"sampler", animation["samplers"].size()},
                                         {"target", {{"node", node}, {"path", path}}}});
        animation["samplers"].push_back(
            {{"input", input}, {"output", output}, {"interpolation", interpolation}});
    }
    Scene load_animated_gltf(const GltfFileBuilder& gltf, const FileOptions& options = {}) const {
        return load_file(write_loaded_file("x.glb", gltf.glb_bytes()), options);
    }
    static dvec3 move_point_with_object(const Scene& scene, double seconds,
                                        const dvec3& point = dvec3(0)) {
        const Scene now = scene_at(scene, seconds);
        return transform_point(now.objects.at(0).world_from_object, point);
    }
    static void expect_near_point(const dvec3& found, const dvec3& wanted) {
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i], wanted[i], 1e-6) << "component " << i;
    }
};

const float kSineOf45Degrees = std::sqrt(.5f);

TEST_F(LoadAnimationTest, TranslationsFollowEachInterpolation) {
    const std::vector<float> values = {0, 0, 0, 2, 4, 0, 0, 0, 8};
    const Scene linear = load_animated_gltf(make_gltf_with_moving_node("translation", values));
    expect_near_point(move_point_with_object(linear, .25), {.5, 1, 0});
    expect_near_point(move_point_with_object(linear, 2), {1, 2, 4});
    expect_near_point(move_point_with_object(linear, 3), {0, 0, 8});
    expect_near_point(move_point_with_object(linear, 100), {0, 0, 8});
    expect_near_point(move_point_with_object(linear, -5), {0, 0, 0});
    EXPECT_EQ(scene_period(linear), 3);
    const Scene step = load_animated_gltf(
        make_gltf_with_moving_node("translation", values, "STEP"));
    expect_near_point(move_point_with_object(step, .999), {0, 0, 0});
    expect_near_point(move_point_with_object(step, 1), {2, 4, 0});
    expect_near_point(move_point_with_object(step, 2.999), {2, 4, 0});
    // A cubic spline with flat tangents gives x = 3 s^2 - 2 s^3. A tangent of 1 at the start adds
    // s^3 - 2 s^2 + s.
    const std::vector<float> cubic = {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0};
    const Scene smooth = load_animated_gltf(
        make_gltf_with_moving_node("translation", cubic, "CUBICSPLINE", {0, 1}));
    expect_near_point(move_point_with_object(smooth, .25),
                      {3. / 16 - 2. / 64, 1. / 64 - 2. / 16 + .25, 0});
    expect_near_point(move_point_with_object(smooth, 2), {1, 0, 0});
}

TEST_F(LoadAnimationTest, RotationsFollowEachInterpolation) {
    // The three keys are rotations about z by 0, 90 and 180 degrees.
    const std::vector<float> values = {0, 0, 0, 1, 0, 0, kSineOf45Degrees, kSineOf45Degrees,
                                       0, 0, 1, 0};
    const dvec3 x(1, 0, 0);
    const Scene linear = load_animated_gltf(make_gltf_with_moving_node("rotation", values));
    const double angle = M_PI / 2 * .25;
    expect_near_point(move_point_with_object(linear, .25, x),
                      {std::cos(angle), std::sin(angle), 0});
    expect_near_point(move_point_with_object(linear, 1, x), {0, 1, 0});
    expect_near_point(move_point_with_object(linear, 2, x),
                      {-kSineOf45Degrees, kSineOf45Degrees, 0});
    expect_near_point(move_point_with_object(linear, 9, x), {-1, 0, 0});
    const Scene step = load_animated_gltf(make_gltf_with_moving_node("rotation", values, "STEP"));
    expect_near_point(move_point_with_object(step, .99, x), x);
    expect_near_point(move_point_with_object(step, 2.99, x), {0, 1, 0});
    // Quaternions q and -q are the same rotation. Interpolation takes the shorter way, so nothing
    // turns.
    const Scene same = load_animated_gltf(
        make_gltf_with_moving_node("rotation", {0, 0, 0, 1, 0, 0, 0, -1}, "LINEAR", {0, 1}));
    expect_near_point(move_point_with_object(same, .5, x), x);
    // In a cubic spline with flat tangents, the quaternion halfway is the normalised mean of both
    // keys.
    std::vector<float> cubic(24);
    cubic[7] = 1, cubic[18] = 1; // the quaternions of the two keys: unit w, unit z
    const Scene smooth = load_animated_gltf(
        make_gltf_with_moving_node("rotation", cubic, "CUBICSPLINE", {0, 1}));
    expect_near_point(move_point_with_object(smooth, .5, x), {0, 1, 0});
    const double s = .25, b = 3 * s * s - 2 * s * s * s, a = 1 - b, n = a * a + b * b;
    expect_near_point(move_point_with_object(smooth, s, x),
                      {(a * a - b * b) / n, 2 * a * b / n, 0});
}

TEST_F(LoadAnimationTest, RotationsOfNormalisedShortsAreRead) {
    GltfFileBuilder gltf = make_gltf_with_moving_node(
        "rotation", {0, 0, 0, 1, 0, 0, kSineOf45Degrees, kSineOf45Degrees}, "LINEAR", {0, 1});
    const std::size_t shorts = gltf.add_accessor<std::int16_t>({0, 0, 0, 32767, 0, 0, 32767, 0},
                                                               "VEC4", 5122);
    gltf.root["accessors"][shorts]["normalized"] = true;
    gltf.root["animations"][0]["samplers"][0]["output"] = shorts;
    expect_near_point(move_point_with_object(load_animated_gltf(gltf), 1, {1, 0, 0}), {-1, 0, 0});
}

TEST_F(LoadAnimationTest, AnimatedScaleKeepsTranslationAndRotation) {
    GltfFileBuilder gltf = make_gltf_with_moving_node("scale", {1, 1, 1, 2, 3, 4, 2, 3, 4});
    gltf.root["nodes"][0]["translation"] = {10, 0, 0};
    gltf.root["nodes"][0]["rotation"] = {0, 0, kSineOf45Degrees, kSineOf45Degrees};
    const Scene scene = load_animated_gltf(gltf);
    expect_near_point(move_point_with_object(scene, 1, {1, 0, 0}), {10, 2, 0});
    expect_near_point(move_point_with_object(scene, .5, {0, 1, 0}), {8, 0, 0});
}

TEST_F(LoadAnimationTest, MovingParentsCarryTheirChildren) {
    GltfFileBuilder gltf = make_gltf_with_moving_node(
        "rotation", {0, 0, 0, 1, 0, 0, kSineOf45Degrees, kSineOf45Degrees}, "LINEAR", {0, 1});
    gltf.root["nodes"][0] = {{"children", {1}}, {"translation", {0, 0, 5}}};
    gltf.root["nodes"].push_back({{"children", {2}}, {"translation", {1, 0, 0}}});
    gltf.root["nodes"].push_back({{"mesh", 0}, {"scale", {2, 2, 2}}});
    add_animation_channel(gltf, 2, "translation", {0, 0, 0, 0, 3, 0}, "LINEAR", {0, 1});
    const Scene scene = load_animated_gltf(gltf);
    expect_near_point(move_point_with_object(scene, 0), {1, 0, 5});
    expect_near_point(move_point_with_object(scene, 1), {-3, 1, 5});
    expect_near_point(move_point_with_object(scene, 1, {1, 0, 0}), {-3, 3, 5});
    EXPECT_TRUE(is_animated(scene));
    EXPECT_EQ(scene.meshes.size(), 1u);
    EXPECT_FALSE(is_animated(scene_at(scene, .5)));
    // Two objects with the same moving parent share one rig.
    gltf.root["nodes"][1]["mesh"] = 0;
    const Scene two = load_animated_gltf(gltf);
    EXPECT_EQ(std::get<RigAttachment>(two.objects[0].motion).rig,
              std::get<RigAttachment>(two.objects[1].motion).rig);
}

TEST_F(LoadAnimationTest, CamerasAndLightsMoveWithTheirNodes) {
    GltfFileBuilder gltf = make_gltf_with_moving_node(
        "rotation", {0, 0, 0, 1, 0, kSineOf45Degrees, 0, kSineOf45Degrees}, "LINEAR", {0, 1});
    gltf.root["nodes"][0]["children"] = {1, 2};
    gltf.root["cameras"] = {
        {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
    gltf.root["nodes"].push_back({{"camera", 0}, {"translation", {0, 0, 2}}});
    gltf.root["nodes"].push_back(
        {{"translation", {0, 1, 1}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    gltf.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
    const Scene scene = load_animated_gltf(gltf);
    expect_near_point(scene.cameras.at(0).eye, {0, 0, 2});
    for (const Camera& camera :
         {camera_at(scene.cameras[0], 1), scene_at(scene, 1).cameras.at(0)}) {
        expect_near_point(camera.eye, {2, 0, 0}); // after a quarter turn about y
        expect_near_point(camera.target, {1, 0, 0});
        expect_near_point(camera.up, {0, 1, 0});
    }
    expect_near_point(dvec3(scene_at(scene, 1).punctual.at(0).world_from_light[3]), {1, 1, 0});
    EXPECT_EQ(camera_at(Camera(), 3), Camera());
    // A camera that moves along a single translation track.
    GltfFileBuilder sliding = make_gltf_with_moving_node("translation", {1, 0, 0, 5, 0, 0},
                                                         "LINEAR", {0, 1});
    sliding.root["nodes"][0]["camera"] = 0;
    sliding.root["nodes"][0]["translation"] = {1, 0, 0};
    sliding.root["cameras"] = gltf.root["cameras"];
    const Scene slides = load_animated_gltf(sliding);
    expect_near_point(camera_at(slides.cameras.at(0), .5).eye, {3, 0, 0});
    expect_near_point(camera_at(slides.cameras.at(0), .5).target, {3, 0, -1});
}

TEST_F(LoadAnimationTest, OneAnimationIsPlayedAndTheOthersAreListed) {
    GltfFileBuilder gltf = make_gltf_with_moving_node("translation", {0, 0, 0, 1, 0, 0}, "STEP",
                                                      {0, 1});
    gltf.root["animations"][0]["name"] = "walk";
    Json other = gltf.root["animations"][0];
    other["name"] = "run";
    other["samplers"][0]["output"] = gltf.add_accessor<float>({0, 0, 0, 9, 0, 0}, "VEC3", 5126);
    gltf.root["animations"].push_back(other);
    const Scene first = load_animated_gltf(gltf);
    expect_near_point(move_point_with_object(first, 2), {1, 0, 0});
    ASSERT_EQ(first.unsupported.size(), 1u);
    EXPECT_EQ(first.unsupported[0].id, "other-animations");
    EXPECT_EQ(first.unsupported[0].first, "animations[1] 'run'");
    expect_near_point(move_point_with_object(load_animated_gltf(gltf, {.animation = "run"}), 2),
                      {9, 0, 0});
    const Scene still = load_animated_gltf(gltf, {.animation = "none"});
    EXPECT_FALSE(is_animated(still));
    EXPECT_EQ(still.unsupported.at(0).count, 2u);
}

} // namespace
