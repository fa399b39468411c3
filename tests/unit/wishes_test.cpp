// Tests of scene overrides, of lights that are left out, of cameras given as text, and of automatic
// exposure.
#include "import/load.hpp"
#include "scene/build.hpp"
#include "scene/camera_named.hpp"
#include "scene/light.hpp"
#include "scene/material_facts.hpp"
#include "scene/motion.hpp"
#include "scene/pose.hpp"
#include "scene/scene_overrides.hpp"
#include "session/candidates.hpp"
#include "session/exposure.hpp"
#include "support/numbers.hpp"
#include "support/refusal.hpp"

#include <gmock/gmock.h>

namespace {

using namespace catoptric;
using namespace catoptric::scene;
using testing::ElementsAre;
using testing::HasSubstr;

/// Returns a scene of three objects, two of which share a material, and a lamp.
Scene make_override_test_scene() {
    Scene scene{.name = "room"};
    const std::size_t wood = add_material(
        scene, {.name = "wood", .albedo = vec3(.5f), .emission = vec3(.25f), .roughness = .5f});
    const std::size_t glass = add_material(scene, {.name = "glass", .roughness = 0});
    add_ball(scene, "table top", wood, {0, 0, 0}, 1);
    add_ball(scene, "table leg", wood, {0, 0, -5}, 1);
    add_ball(scene, "frame/glass", glass, {5, 0, 0}, 1);
    add_ball(scene, "lamp", add_material(scene, {.name = "lamp", .emission = vec3(3)}), {0, 9, 0},
             .1);
    return scene;
}

const Material& material_of_object(const Scene& scene, std::size_t object) {
    return scene.materials[scene.objects[object].material];
}

TEST(MirrorOverride, MirrorOverrideIsReadAsPatternAndReflectance) {
    const auto read = [](const std::string& text) {
        return parse_mirror_override("--mirror", text);
    };
    EXPECT_EQ(read("a"), (MirrorOverride{"a", vec3(1)}));
    EXPECT_EQ(read("a=.5"), (MirrorOverride{"a", vec3(.5f)}));
    EXPECT_EQ(read("a b=1,0.5,0"), (MirrorOverride{"a b", {1, .5f, 0}}));
    EXPECT_EQ(read("x=wood"), (MirrorOverride{"x=wood", vec3(1)}));
    EXPECT_EQ(read("x=3=1"), (MirrorOverride{"x=3", vec3(1)}));
    for (const char* text : {"a=2", "a=-1", "a=.5,.5", "a=1,1,1,1"})
        EXPECT_THAT(test::catch_error_text(Failure::usage, [&] { read(text); }),
                    HasSubstr("--mirror: wanted PATTERN or PATTERN=REFLECTANCE[,roughness=NUMBER], "
                              "REFLECTANCE a number or r,g,b, all from 0 to 1, found '" +
                              std::string(text) + "'"));
    EXPECT_EQ(read("a=.5,roughness=.25"), (MirrorOverride{"a", vec3(.5f), .25f}));
    EXPECT_EQ(read("a,roughness=.25"), (MirrorOverride{"a", vec3(1), .25f}));
    EXPECT_EQ(read("a=1,.5,0,roughness=1"), (MirrorOverride{"a", {1, .5f, 0}, 1}));
    for (const char* text : {"a,roughness=2", "a,roughness=", "a=1,roughness=-.1"})
        EXPECT_THAT(test::catch_error_text(Failure::usage, [&] { read(text); }),
                    HasSubstr("--mirror: wanted a number from 0 to 1 after ',roughness=', found '" +
                              std::string(text) + "'"));
    EXPECT_THAT(test::catch_error_text(Failure::usage, [&] { read("=1"); }),
                HasSubstr("wanted a name"));
}

TEST(MirrorOverride, RoughMirrorIsAMetal) {
    Scene scene = make_override_test_scene();
    apply_overrides(
        scene, {.mirrors = {{"table top", vec3(.9f, .8f, .7f), .3f}}, .mirror_max_roughness = .6});
    EXPECT_THAT(mirrors(scene), ElementsAre(0u));
    const Material& material = scene.materials[scene.objects[0].material];
    EXPECT_FALSE(material.mirror);
    EXPECT_EQ(material.metallic, 1);
    EXPECT_EQ(material.roughness, .3f);
    EXPECT_EQ(material.albedo, vec3(.9f, .8f, .7f));
    Scene other = make_override_test_scene();
    EXPECT_THAT(test::catch_error_text(Failure::usage,
                                       [&] {
                                           apply_overrides(
                                               other, {.mirrors = {{"table top", vec3(1), .7f}},
                                                       .mirror_max_roughness = .6});
                                       }),
                HasSubstr("--mirror 'table top': wanted a roughness of at most 0.6, above which no "
                          "surface is a mirror, found 0.7; raise --mirror-max-roughness"));
}

TEST(MirrorOverride, MirrorOverrideChangesOnlyTheNamedObject) {
    Scene scene = make_override_test_scene();
    apply_overrides(scene, {.mirrors = {{"table top", {1, .5f, .25f}}}});
    EXPECT_THAT(mirrors(scene), ElementsAre(0u));
    const Material mirror{.name = "wood", .mirror = true, .reflectance = {1, .5f, .25f}};
    EXPECT_EQ(material_of_object(scene, 0), mirror) << "the rest of the surface is dropped";
    EXPECT_EQ(material_of_object(scene, 1), make_override_test_scene().materials[0])
        << "who shares the material keeps it";
}

TEST(MirrorOverride, MirrorOverrideMatchesObjectsNodesAndMaterials) {
    const auto made = [](const std::string& pattern) {
        Scene scene = make_override_test_scene();
        apply_overrides(scene, {.mirrors = {{pattern, vec3(1)}}});
        return mirrors(scene);
    };
    EXPECT_THAT(made("table*"), ElementsAre(0u, 1u));
    EXPECT_THAT(made("wood"), ElementsAre(0u, 1u));
    EXPECT_THAT(made("frame"), ElementsAre(2u)) << "the node of several materials";
    EXPECT_THAT(made("frame/glass"), ElementsAre(2u));
    EXPECT_THAT(made("[tf]*"), ElementsAre(0u, 1u, 2u));
    EXPECT_THAT(made("table ???"), ElementsAre(0u, 1u));
    for (const char* pattern : {"Table top", "table", "woo", "top"})
        EXPECT_THAT(test::catch_error_text(Failure::usage, [&] { made(pattern); }),
                    HasSubstr("--mirror '" + std::string(pattern) +
                              "': matches no object or material of scene 'room'; it has: "
                              "'frame', 'frame/glass', 'glass', 'lamp', 'table leg', 'table top', "
                              "'wood'"));
    EXPECT_THAT(test::catch_error_text(Failure::usage, [&] { made("tabel top"); }),
                HasSubstr("(did you mean 'table top'?)"));
}

TEST(MirrorOverride, LaterMirrorOverrideWins) {
    Scene scene = make_override_test_scene();
    apply_overrides(
        scene, combine({.mirrors = {{"wood", vec3(.5f)}}}, {.mirrors = {{"table*", vec3(.1f)}}}));
    EXPECT_EQ(material_of_object(scene, 0).reflectance, vec3(.5f));
}

TEST(Over, CombinedOverridesHoldEachPatternOnce) {
    const SceneOverrides both = combine(
        {.mirrors = {{"a", vec3(1)}}, .lights = {"l"}},
        {.mirrors = {{"a", vec3(.5f)}, {"b", vec3(1)}}, .lights = {"l", "k"}});
    EXPECT_EQ(both.mirrors, (std::vector<MirrorOverride>{{"b", vec3(1)}, {"a", vec3(1)}}));
    EXPECT_THAT(both.lights, ElementsAre("k", "l"));
}

TEST(MirrorOptions, MirrorOptionsCanBePastedAndMatchTheirObject) {
    Scene scene = make_override_test_scene();
    scene.objects[1].name = "it's a * [1]=2";
    const std::vector<std::string> options = session::suggest_mirror_options(scene);
    EXPECT_THAT(options, ElementsAre("--mirror 'frame/glass'"))
        << "what emits light is no candidate";
    scene.materials[0].emission_texture.emplace();
    EXPECT_EQ(session::suggest_mirror_options(scene).size(), 3u)
        << "what glows here and there is one";
    scene.materials[0].emission_texture.reset(), scene.materials[0].emission = vec3(0);
    EXPECT_THAT(session::suggest_mirror_options(scene),
                ElementsAre("--mirror 'frame/glass'", "--mirror 'table top'",
                            "--mirror 'it'\\''s a \\* \\[1]=2=1'"));
    const MirrorOverride wish = parse_mirror_override("--mirror",
                                                      mirror_pattern(scene.objects[1].name));
    apply_overrides(scene, {.mirrors = {wish}});
    EXPECT_THAT(mirrors(scene), ElementsAre(1u));
    // Names that hold the texts of options.
    for (const std::string name : {"a,roughness=.5", "a=.5,roughness=.5", "a=1,1,1"}) {
        const MirrorOverride read = parse_mirror_override("--mirror", mirror_pattern(name));
        EXPECT_TRUE(matches(read.pattern, name)) << read.pattern;
        EXPECT_EQ(read.roughness, MirrorOverride().roughness) << name;
    }
    EXPECT_TRUE(matches(mirror_pattern("\x1b[2J\xff"), "\x1b[2J\xff"));
    EXPECT_EQ(mirror_pattern("\x1b\xff"), "??");
    const std::string longest(100, 'n'), wide = std::string(59, 'n') + "\xc3\xa4 and more";
    EXPECT_EQ(mirror_pattern(longest), std::string(60, 'n') + "*");
    EXPECT_EQ(mirror_pattern(wide), std::string(59, 'n') + "*");
}

TEST(LightWish, LightOverrideEmitsFactorTimesMeanTexel) {
    Scene scene = make_override_test_scene();
    Texture half;
    half.image = std::make_shared<Image>(Image{"i", {2, 1}, {0xff0000ffu, 0xff000000u}});
    scene.materials[0].emission_texture = half;
    EXPECT_EQ(list_lights(scene).size(), 1u);
    apply_overrides(scene, {.lights = {"table top"}});
    EXPECT_EQ(material_of_object(scene, 0).light, vec3(.125f, 0, 0));
    EXPECT_EQ(material_of_object(scene, 1).light, std::nullopt);
    EXPECT_EQ(list_lights(scene).size(), 2u);
    EXPECT_THAT(test::catch_error_text(Failure::usage,
                                       [&] { apply_overrides(scene, {.lights = {"frame"}}); }),
                HasSubstr("--light 'frame': wanted something that emits light"));
    EXPECT_THAT(test::catch_error_text(Failure::usage,
                                       [&] { apply_overrides(scene, {.lights = {"lmap"}}); }),
                HasSubstr("did you mean 'lamp'"));
}

TEST(TurnZUp, TurnZUpMapsZToYExactly) {
    Scene scene = make_override_test_scene();
    scene.cameras.push_back({.name = "c", .eye = {1, 2, 3}, .target = {4, 5, 6}, .up = {0, 0, 1}});
    scene.punctual.push_back({.kind = PunctualLight::Kind::spot});
    scene.objects[3].motion = HarmonicMotion{.amplitude = {1, 2, 3}};
    const dvec3 centre = bounds(scene, scene.objects[1]).centre();
    const dvec3 before = scene_at(scene, .25).objects[3].sphere->centre;
    apply_overrides(scene, {.up = UpAxis::z});
    EXPECT_EQ(scene.cameras[0].eye, dvec3(1, 3, -2));
    EXPECT_EQ(scene.cameras[0].up, dvec3(0, 1, 0));
    EXPECT_EQ(bounds(scene, scene.objects[1]).centre(), dvec3(centre.x, centre.z, -centre.y));
    EXPECT_EQ(scene.objects[1].sphere->centre, dvec3(0, -5, 0));
    EXPECT_EQ(scene_at(scene, .25).objects[3].sphere->centre, dvec3(before.x, before.z, -before.y));
    EXPECT_EQ(list_lights(scene).back().axis, dvec3(0, -1, 0)) << "along -z of the file";
    EXPECT_GT(glm::determinant(dmat3(scene.objects[0].world_from_object)), 0);
}

/// Turning the scene from z up to y up also turns the objects and cameras that follow a rig, at
/// every instant.
TEST(TurnZUp, TurnZUpTurnsObjectsAndCamerasOnRigs) {
    NodeRig rig;
    rig.nodes.push_back({.translations = std::make_shared<const TranslationTrack>(
                             TranslationTrack{.times = {0, 1}, .values = {{0, 0, 0}, {1, 2, 3}}})});
    const RigAttachment follows{.rig = std::make_shared<const NodeRig>(std::move(rig))};
    Scene scene = make_override_test_scene();
    scene.objects[0].motion = follows;
    scene.cameras = {{.eye = {1, 2, 3}, .target = {4, 5, 6}, .up = {0, 0, 1}, .follows = follows}};
    const Scene turned = [&] {
        Scene copy = scene;
        apply_overrides(copy, {.up = UpAxis::z});
        return copy;
    }();
    for (const double seconds : {0.0, .5, 1.0}) {
        const dvec3 eye = camera_at(scene.cameras[0], seconds).eye;
        EXPECT_LT(
            glm::length(camera_at(turned.cameras[0], seconds).eye - dvec3(eye.x, eye.z, -eye.y)),
            1e-12);
        const Scene before = scene_at(scene, seconds), after = scene_at(turned, seconds);
        const dvec3 centre = bounds(before, before.objects[0]).centre();
        EXPECT_LT(glm::length(bounds(after, after.objects[0]).centre() -
                              dvec3(centre.x, centre.z, -centre.y)),
                  1e-12);
    }
}

TEST(LeaveOutLights, LeaveOutLightsKeepsTheStrongestAtTheCentre) {
    Scene scene = make_override_test_scene();
    scene.materials[0].emission = vec3(0), scene.materials[2].emission = vec3(1e-6f);
    for (int i = 0; i < 6; ++i) { // equal lights, so the nearest is the strongest
        PunctualLight light{.name = "p" + std::to_string(i), .intensity = vec3(100)};
        light.world_from_light[3] = dvec4(100.0 * (6 - i), 0, 0, 1);
        scene.punctual.push_back(light);
    }
    PunctualLight away{.name = "away", .kind = PunctualLight::Kind::spot, .intensity = vec3(1e6)};
    away.cos_outer = .9; // shines along -z, away from the centre
    away.world_from_light[3] = dvec4(2, 4, -50, 1);
    scene.punctual.push_back(away);
    drop_weakest_lights(scene, 7);
    EXPECT_EQ(scene.unsupported.size(), 1u);
    EXPECT_EQ(scene.unsupported[0].id, "lights-left-out");
    EXPECT_EQ(scene.unsupported[0].count, 1u);
    EXPECT_EQ(scene.unsupported[0].first, "light 'away'");
    scene.unsupported.clear();
    drop_weakest_lights(scene, 3);
    std::vector<std::string> kept;
    for (const PunctualLight& light : scene.punctual) kept.push_back(light.name);
    EXPECT_EQ(list_lights(scene).size(), 3u);
    EXPECT_THAT(kept, ElementsAre("p3", "p4", "p5"));
    EXPECT_EQ(material_of_object(scene, 3).light, vec3(0))
        << "the far small lamp glows, and lights nothing";
    EXPECT_EQ(material_of_object(scene, 3).emission, vec3(1e-6f));
    EXPECT_EQ(scene.unsupported[0].first, "object 'lamp'");
}

/// The lamp is one mesh of twenty separate triangles, with growing distances between them.
TEST(LeaveOutLights, LeaveOutLightsKeepsTheStrongestPartsOfAMesh) {
    Scene scene{.name = "chandelier", .materials = {{.name = "glass", .emission = vec3(1)}}};
    Mesh boards{.name = "boards"};
    for (std::uint32_t i = 0; i < 20; ++i) {
        const double z = .1 + i * i;
        for (const dvec3& corner : {dvec3(0, 0, z), dvec3(1, 0, z), dvec3(0, 1, z)})
            boards.positions.push_back(corner), boards.normals.emplace_back(0, 0, 1);
        boards.triangles.push_back(uvec3(0, 1, 2) + 3 * i);
    }
    scene.materials[0].two_sided = true;
    scene.meshes = {boards};
    scene.objects = {{.name = "lamp"}};
    const std::vector<PointLight> all = list_lights(scene);
    const double centre = bounds(scene).centre().z;
    drop_weakest_lights(scene, 16);
    const std::vector<PointLight> kept = list_lights(scene);
    ASSERT_EQ(kept.size(), 16u);
    double farthest = 0;
    for (const PointLight& light : kept)
        farthest = std::max(farthest, std::abs(light.position.z - centre));
    EXPECT_EQ(std::ranges::count_if(all,
                                    [&](const PointLight& light) {
                                        return std::abs(light.position.z - centre) <= farthest;
                                    }),
              16)
        << "the nearest ones";
    ASSERT_EQ(scene.objects.size(), 2u);
    EXPECT_EQ(scene.meshes[scene.objects[0].mesh].triangles.size(), 16u);
    EXPECT_EQ(scene.meshes[scene.objects[1].mesh].triangles.size(), 4u) << "seen, and dark";
    EXPECT_EQ(material_of_object(scene, 1).emission, vec3(1));
    EXPECT_EQ(scene.unsupported.at(0).first, "object 'lamp', 4 of its 20 parts");
}

TEST(CameraNamed, OrthographicCameraIsReadFromNumbers) {
    const Camera camera = find_camera("1,2,3:4,5,6:h=2.5", Scene());
    EXPECT_EQ(camera.eye, dvec3(1, 2, 3));
    EXPECT_EQ(camera.target, dvec3(4, 5, 6));
    EXPECT_EQ(camera.orthographic_height, 2.5);
    EXPECT_EQ(format_camera(camera), "1,2,3:4,5,6:h=2.5");
    EXPECT_EQ(format_camera(find_camera("0.5,0,0:0,0,1:40", Scene())), "0.5,0,0:0,0,1:40");
    EXPECT_THAT(
        test::catch_error_text(Failure::usage, [] { find_camera("0,0,0:0,0,1:h=0", Scene()); }),
        HasSubstr("--camera: wanted a finite number from 1e-09 to 1e+18, found '0'"));
}

TEST(ExposureFor, ExposureBringsThe95thPercentileTo80Percent) {
    measure::Picture picture(10, 10);
    for (std::size_t i = 0; i < 100; ++i) picture.pixels[i] = vec3(i < 90 ? .01f : .1f);
    EXPECT_EQ(session::choose_exposure(picture), 3) << "log2(.8 / .1)";
    for (vec3& pixel : picture.pixels) pixel *= 1.25f; // log2(.8 / .125) = 2.68, nearest to 8/3
    EXPECT_DOUBLE_EQ(session::choose_exposure(picture), 8.0 / 3);
    picture.pixels.assign(100, vec3(0, 1, 0)); // luminance .7152 (Rec. 709)
    EXPECT_EQ(session::choose_exposure(picture), 0);
    picture.pixels.assign(100, vec3(0, 0, 1)); // luminance .0722 (Rec. 709): 3.47 stops
    EXPECT_DOUBLE_EQ(session::choose_exposure(picture), 10.0 / 3);
    picture.pixels.assign(100, vec3(NAN));
    EXPECT_EQ(session::choose_exposure(picture), 0);
    picture.pixels.assign(100, vec3(0));
    EXPECT_EQ(session::choose_exposure(picture), 0);
}

} // namespace
