// Tests that a scene made in memory is refused as a file would be, with its place and what was
// found.
#include "import/load.hpp"
#include "scene/built_in.hpp"
#include "support/refusal.hpp"
#include "support/scenes.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <limits>

namespace {

using namespace catoptric;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();

scene::Texture make_white_texture() {
    return {.image = std::make_shared<scene::Image>(scene::Image{"white", {1, 1}, {~0u}})};
}

/// Returns a furnace with a texture, a light, a motion and an environment, which is valid.
scene::Scene make_scene_of_all_parts() {
    scene::Scene scene = test::make_furnace_scene(1);
    scene.materials[0].albedo_texture = make_white_texture();
    scene.punctual.push_back({.name = "bulb", .intensity = vec3(1)});
    auto keys = std::make_shared<scene::TranslationTrack>();
    keys->times = {0, 1}, keys->values = {dvec3(0), dvec3(1)};
    scene.objects.back().motion = scene::Keyframes{.keys = keys};
    scene.environment = std::make_shared<scene::Environment>(
        scene::Environment{.name = "sky", .size = {2, 1}, .texels = {vec3(1), vec3(2)}});
    return scene;
}

struct WrongScene {
    std::string part, found;
    std::function<void(scene::Scene&)> break_it;
};

/// Sets a member of the environment.
auto set(const std::function<void(scene::Environment&)>& change) {
    return [change](scene::Scene& scene) {
        scene::Environment wrong = *scene.environment;
        change(wrong);
        scene.environment = std::make_shared<scene::Environment>(wrong);
    };
}

auto set_keys(const std::function<void(scene::TranslationTrack&)>& change) {
    return [change](scene::Scene& scene) {
        auto& motion = std::get<scene::Keyframes>(scene.objects.back().motion);
        scene::TranslationTrack wrong = *motion.keys;
        change(wrong);
        motion.keys = std::make_shared<scene::TranslationTrack>(wrong);
    };
}

std::vector<WrongScene> list_wrong_scenes() {
    using scene::Scene;
    return {
        {"objects[6] 'ball1': mesh", "found 99", [](Scene& s) { s.objects.back().mesh = 99; }},
        {"objects[0] 'wall0': material: wanted an index into the 2 materials", "found 2",
         [](Scene& s) { s.objects[0].material = 2; }},
        {"objects[0] 'wall0': world_from_object", "NaN",
         [](Scene& s) { s.objects[0].world_from_object[1][1] = std::nan(""); }},
        {"world_from_object: wanted an affine", "another",
         [](Scene& s) { s.objects[0].world_from_object[1][3] = 1; }},
        {"sphere", "found -1", [](Scene& s) { s.objects.back().sphere->radius = -1; }},
        {"meshes[0] 'wall0': triangle 1: wanted an index below the 4 positions", "found 4",
         [](Scene& s) { s.meshes[0].triangles[1].z = 4; }},
        {"meshes[0] 'wall0': normals: wanted one for each of the 4 positions", "found 0",
         [](Scene& s) { s.meshes[0].normals.clear(); }},
        {"normal 2: wanted unit length", "found 0 0 0",
         [](Scene& s) { s.meshes[0].normals[2] = vec3(0); }},
        {"normal 2", "nan", [](Scene& s) { s.meshes[0].normals[2].x = kNotANumber; }},
        {"position 3", "inf", [](Scene& s) { s.meshes[0].positions[3].y = kInfinity; }},
        {"position 3", "1e+200", [](Scene& s) { s.meshes[0].positions[3].y = 1e200; }},
        {"texture coordinates", "found 1", [](Scene& s) { s.meshes[0].uv[1] = {vec2(0)}; }},
        {"colours", "found 3", [](Scene& s) { s.meshes[0].colours.resize(3); }},
        {"materials[0] 'hot': albedo_texture", "found none",
         [](Scene& s) { s.materials[0].albedo_texture->image = nullptr; }},
        {"albedo_texture", "found 2x1 with 1 texels",
         [](Scene& s) {
             s.materials[0].albedo_texture->image = std::make_shared<scene::Image>(
                 scene::Image{"short", {2, 1}, {0}});
         }},
        {"normal_texture", "found none", [](Scene& s) { s.materials[0].normal_texture.emplace(); }},
        {"albedo_texture: wanted an index into the 2 texture spaces", "found 2",
         [](Scene& s) { s.materials[0].albedo_texture->uv_set = 2; }},
        {"emission", "nan", [](Scene& s) { s.materials[0].emission.y = kNotANumber; }},
        {"emission", "-1", [](Scene& s) { s.materials[0].emission.y = -1; }},
        {"albedo: wanted a number of 0 to 1", "found 2",
         [](Scene& s) { s.materials[0].albedo.z = 2; }},
        {"roughness", "nan", [](Scene& s) { s.materials[0].roughness = kNotANumber; }},
        {"ior", "found 0", [](Scene& s) { s.materials[0].ior = 0; }},
        {"punctual[0] 'bulb': intensity", "nan",
         [](Scene& s) { s.punctual[0].intensity.x = kNotANumber; }},
        {"kind", "found number 77",
         [](Scene& s) { s.punctual[0].kind = scene::PunctualLight::Kind{77}; }},
        {"motion: wanted a value for each of the 2 times", "found 1",
         set_keys([](auto& keys) { keys.values.pop_back(); })},
        {"motion: wanted a value for each", "and 0 and 0 tangents",
         set_keys([](auto& keys) { keys.interpolation = scene::Interpolation::cubic; })},
        {"motion: wanted increasing times", "found 0 at key 1",
         set_keys([](auto& keys) { keys.times[1] = 0; })},
        {"motion: wanted a period above 0", "found 0",
         [](Scene& s) { s.objects[0].motion = scene::HarmonicMotion{.period = 0}; }},
        {"environment[0] 'sky'", "found 2x1 with 1 texels",
         set([](auto& sky) { sky.texels.pop_back(); })},
        {"environment[0] 'sky': texels", "inf",
         set([](auto& sky) { sky.texels[1].x = float(kInfinity); })},
        {"cameras[0]: camera 'inside': wanted a target away from the eye", "45 degrees",
         [](Scene& s) { s.cameras[0] = {.name = "inside", .eye = dvec3(1), .target = dvec3(1)}; }},
        {"light_samples", "found 0", [](Scene& s) { s.light_samples = 0; }},
        {"mirror_max_roughness", "nan", [](Scene& s) { s.mirror_max_roughness = kNotANumber; }},
    };
}

TEST(CheckScene, WrongPartsAreRefusedWithTheirPlace) {
    ASSERT_NO_THROW(scene::check_scene(make_scene_of_all_parts()));
    for (const WrongScene& wrong : list_wrong_scenes()) {
        scene::Scene scene = make_scene_of_all_parts();
        wrong.break_it(scene);
        const std::string message = test::catch_error_text(Failure::bad_data,
                                                           [&] { scene::check_scene(scene); });
        EXPECT_THAT(message, testing::StartsWith("scene 'furnace': ")) << wrong.part;
        EXPECT_THAT(message, testing::HasSubstr(wrong.part));
        EXPECT_THAT(message, testing::HasSubstr(wrong.found)) << wrong.part;
    }
}

TEST(CheckScene, BuiltInAndEmptyScenesPass) {
    EXPECT_NO_THROW(scene::check_scene({}));
    for (const scene::BuiltInScene& built_in : scene::built_in_scenes())
        EXPECT_NO_THROW(scene::check_scene(scene::load(built_in.name))) << built_in.name;
}

TEST(CheckScene, AnEditWithAWrongMaterialIsRefusedAndChangesNothing) {
    scene::Scene scene = make_scene_of_all_parts();
    scene::Material wrong = scene.materials[0];
    wrong.albedo_texture->image = nullptr;
    EXPECT_THAT(test::catch_error_text(Failure::bad_data,
                                       [&] { apply_edit(scene, scene::set_material(0, wrong)); }),
                testing::HasSubstr("materials[0] 'hot': albedo_texture"));
    EXPECT_NO_THROW(scene::check_scene(scene));
    EXPECT_THAT(
        test::catch_error_text(Failure::usage, [&] { apply_edit(scene, scene::remove(7)); }),
        testing::HasSubstr("object 7: wanted one of the scene's 7, from 0"));
    apply_edit(scene, scene::remove(0));
    EXPECT_EQ(scene.objects.front().name, "wall1");
}

} // namespace
