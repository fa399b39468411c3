// Tests of glTF animations: each kind of track, each interpolation, and moving parents.
#include "scene/file_options.hpp"
#include "scene/pose.hpp"
#include "scene/transform.hpp"
#include "unit/load_fixture.hpp"

#include <cmath>

namespace {

using namespace test::loading;

class LoadAnimation : public Load {
protected:
    /// Builds a glTF file whose node 0 moves by a track of `path`, with keys at `times` in seconds.
    static Gltf moving(const std::string& path, const std::vector<float>& values,
                       const char* interpolation = "LINEAR",
                       const std::vector<float>& times = {0, 1, 3}) {
        Gltf gltf = small();
        add(gltf, 0, path, values, interpolation, times);
        return gltf;
    }
    /// Adds a channel to the file's only animation.
    static void add(Gltf& gltf, int node, const std::string& path, const std::vector<float>& values,
                    const char* interpolation = "LINEAR",
                    const std::vector<float>& times = {0, 1, 3}) {
        Json& animation = gltf.root["animations"][0];
        const std::size_t input = gltf.add(times, "SCALAR", 5126);
        const std::size_t output = gltf.add(values, path == "rotation" ? "VEC4" : "VEC3", 5126);
        animation["channels"].push_back({{"sampler", animation["samplers"].size()},
                                         {"target", {{"node", node}, {"path", path}}}});
        animation["samplers"].push_back(
            {{"input", input}, {"output", output}, {"interpolation", interpolation}});
    }
    Scene scene_of(const Gltf& gltf, const FileOptions& options = {}) const {
        return load_file(write("x.glb", gltf.glb()), options);
    }
    static dvec3 carried(const Scene& scene, double seconds, const dvec3& point = dvec3(0)) {
        const Scene now = scene_at_time(scene, seconds);
        return transform_point(now.objects.at(0).world_from_object, point);
    }
    static void expect_near(const dvec3& found, const dvec3& wanted) {
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i], wanted[i], 1e-6) << "component " << i;
    }
};

const float kHalf = std::sqrt(.5f);

TEST_F(LoadAnimation, TranslationsFollowEachInterpolation) {
    const std::vector<float> values = {0, 0, 0, 2, 4, 0, 0, 0, 8};
    const Scene linear = scene_of(moving("translation", values));
    expect_near(carried(linear, .25), {.5, 1, 0});
    expect_near(carried(linear, 2), {1, 2, 4});
    expect_near(carried(linear, 3), {0, 0, 8});
    expect_near(carried(linear, 100), {0, 0, 8});
    expect_near(carried(linear, -5), {0, 0, 0});
    EXPECT_EQ(period(linear), 3);
    const Scene step = scene_of(moving("translation", values, "STEP"));
    expect_near(carried(step, .999), {0, 0, 0});
    expect_near(carried(step, 1), {2, 4, 0});
    expect_near(carried(step, 2.999), {2, 4, 0});
    // A cubic spline with flat tangents gives x = 3 s^2 - 2 s^3. A tangent of 1 at the start adds
    // s^3 - 2 s^2 + s.
    const std::vector<float> cubic = {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0};
    const Scene smooth = scene_of(moving("translation", cubic, "CUBICSPLINE", {0, 1}));
    expect_near(carried(smooth, .25), {3. / 16 - 2. / 64, 1. / 64 - 2. / 16 + .25, 0});
    expect_near(carried(smooth, 2), {1, 0, 0});
}

TEST_F(LoadAnimation, RotationsFollowEachInterpolation) {
    // The three keys are rotations about z by 0, 90 and 180 degrees.
    const std::vector<float> values = {0, 0, 0, 1, 0, 0, kHalf, kHalf, 0, 0, 1, 0};
    const dvec3 x(1, 0, 0);
    const Scene linear = scene_of(moving("rotation", values));
    const double angle = M_PI / 2 * .25;
    expect_near(carried(linear, .25, x), {std::cos(angle), std::sin(angle), 0});
    expect_near(carried(linear, 1, x), {0, 1, 0});
    expect_near(carried(linear, 2, x), {-kHalf, kHalf, 0});
    expect_near(carried(linear, 9, x), {-1, 0, 0});
    const Scene step = scene_of(moving("rotation", values, "STEP"));
    expect_near(carried(step, .99, x), x);
    expect_near(carried(step, 2.99, x), {0, 1, 0});
    // Quaternions q and -q are the same rotation. Interpolation takes the shorter way, so nothing
    // turns.
    const Scene same = scene_of(moving("rotation", {0, 0, 0, 1, 0, 0, 0, -1}, "LINEAR", {0, 1}));
    expect_near(carried(same, .5, x), x);
    // In a cubic spline with flat tangents, the quaternion halfway is the normalised mean of both
    // keys.
    std::vector<float> cubic(24);
    cubic[7] = 1, cubic[18] = 1; // the quaternions of the two keys: unit w, unit z
    const Scene smooth = scene_of(moving("rotation", cubic, "CUBICSPLINE", {0, 1}));
    expect_near(carried(smooth, .5, x), {0, 1, 0});
    const double s = .25, b = 3 * s * s - 2 * s * s * s, a = 1 - b, n = a * a + b * b;
    expect_near(carried(smooth, s, x), {(a * a - b * b) / n, 2 * a * b / n, 0});
}

TEST_F(LoadAnimation, RotationsOfNormalisedShortsAreRead) {
    Gltf gltf = moving("rotation", {0, 0, 0, 1, 0, 0, kHalf, kHalf}, "LINEAR", {0, 1});
    const std::size_t shorts = gltf.add<std::int16_t>({0, 0, 0, 32767, 0, 0, 32767, 0}, "VEC4",
                                                      5122);
    gltf.root["accessors"][shorts]["normalized"] = true;
    gltf.root["animations"][0]["samplers"][0]["output"] = shorts;
    expect_near(carried(scene_of(gltf), 1, {1, 0, 0}), {-1, 0, 0});
}

TEST_F(LoadAnimation, AnimatedScaleKeepsTranslationAndRotation) {
    Gltf gltf = moving("scale", {1, 1, 1, 2, 3, 4, 2, 3, 4});
    gltf.root["nodes"][0]["translation"] = {10, 0, 0};
    gltf.root["nodes"][0]["rotation"] = {0, 0, kHalf, kHalf};
    const Scene scene = scene_of(gltf);
    expect_near(carried(scene, 1, {1, 0, 0}), {10, 2, 0});
    expect_near(carried(scene, .5, {0, 1, 0}), {8, 0, 0});
}

TEST_F(LoadAnimation, MovingParentsCarryTheirChildren) {
    Gltf gltf = moving("rotation", {0, 0, 0, 1, 0, 0, kHalf, kHalf}, "LINEAR", {0, 1});
    gltf.root["nodes"][0] = {{"children", {1}}, {"translation", {0, 0, 5}}};
    gltf.root["nodes"].push_back({{"children", {2}}, {"translation", {1, 0, 0}}});
    gltf.root["nodes"].push_back({{"mesh", 0}, {"scale", {2, 2, 2}}});
    add(gltf, 2, "translation", {0, 0, 0, 0, 3, 0}, "LINEAR", {0, 1});
    const Scene scene = scene_of(gltf);
    expect_near(carried(scene, 0), {1, 0, 5});
    expect_near(carried(scene, 1), {-3, 1, 5});
    expect_near(carried(scene, 1, {1, 0, 0}), {-3, 3, 5});
    EXPECT_TRUE(is_animated(scene));
    EXPECT_EQ(scene.meshes.size(), 1u);
    EXPECT_FALSE(is_animated(scene_at_time(scene, .5)));
    // Two objects with the same moving parent share one rig.
    gltf.root["nodes"][1]["mesh"] = 0;
    const Scene two = scene_of(gltf);
    EXPECT_EQ(std::get<RigAttachment>(two.objects[0].motion).rig,
              std::get<RigAttachment>(two.objects[1].motion).rig);
}

TEST_F(LoadAnimation, CamerasAndLightsMoveWithTheirNodes) {
    Gltf gltf = moving("rotation", {0, 0, 0, 1, 0, kHalf, 0, kHalf}, "LINEAR", {0, 1});
    gltf.root["nodes"][0]["children"] = {1, 2};
    gltf.root["cameras"] = {
        {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
    gltf.root["nodes"].push_back({{"camera", 0}, {"translation", {0, 0, 2}}});
    gltf.root["nodes"].push_back(
        {{"translation", {0, 1, 1}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    gltf.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
    const Scene scene = scene_of(gltf);
    expect_near(scene.cameras.at(0).eye, {0, 0, 2});
    for (const Camera& camera :
         {camera_at(scene.cameras[0], 1), scene_at_time(scene, 1).cameras.at(0)}) {
        expect_near(camera.eye, {2, 0, 0}); // after a quarter turn about y
        expect_near(camera.target, {1, 0, 0});
        expect_near(camera.up, {0, 1, 0});
    }
    expect_near(dvec3(scene_at_time(scene, 1).punctual.at(0).world_from_light[3]), {1, 1, 0});
    EXPECT_EQ(camera_at(Camera(), 3), Camera());
    // A camera that moves along a single translation track.
    Gltf sliding = moving("translation", {1, 0, 0, 5, 0, 0}, "LINEAR", {0, 1});
    sliding.root["nodes"][0]["camera"] = 0;
    sliding.root["nodes"][0]["translation"] = {1, 0, 0};
    sliding.root["cameras"] = gltf.root["cameras"];
    const Scene slides = scene_of(sliding);
    expect_near(camera_at(slides.cameras.at(0), .5).eye, {3, 0, 0});
    expect_near(camera_at(slides.cameras.at(0), .5).target, {3, 0, -1});
}

TEST_F(LoadAnimation, OneAnimationIsPlayedAndTheOthersAreListed) {
    Gltf gltf = moving("translation", {0, 0, 0, 1, 0, 0}, "STEP", {0, 1});
    gltf.root["animations"][0]["name"] = "walk";
    Json other = gltf.root["animations"][0];
    other["name"] = "run";
    other["samplers"][0]["output"] = gltf.add<float>({0, 0, 0, 9, 0, 0}, "VEC3", 5126);
    gltf.root["animations"].push_back(other);
    const Scene first = scene_of(gltf);
    expect_near(carried(first, 2), {1, 0, 0});
    ASSERT_EQ(first.unsupported.size(), 1u);
    EXPECT_EQ(first.unsupported[0].id, "other-animations");
    EXPECT_EQ(first.unsupported[0].first, "animations[1] 'run'");
    expect_near(carried(scene_of(gltf, {.animation = "run"}), 2), {9, 0, 0});
    const Scene still = scene_of(gltf, {.animation = "none"});
    EXPECT_FALSE(is_animated(still));
    EXPECT_EQ(still.unsupported.at(0).count, 2u);
}

} // namespace
