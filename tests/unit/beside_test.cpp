// Tests of scene overrides in SCENE.catoptric.json, and of the light and camera that are added to
// scene files without them.
#include "core/file.hpp"
#include "import/scene_file.hpp"
#include "measure/picture_file.hpp"
#include "scene/built_in.hpp"
#include "scene/camera_named.hpp"
#include "scene/default_camera.hpp"
#include "scene/hash.hpp"
#include "session/resolved_scene.hpp"
#include "support/folder.hpp"
#include "support/refusal.hpp"

#include <cmath>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <numbers>

namespace {

using namespace catoptric;
using namespace catoptric::scene;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string kUnlitTriangleObjText = "o thing\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const std::string kCamera = "# catoptric camera c 0 0 5 0 0 0 0 1 0 40\n";

class Beside : public test::InFolder {
protected:
    std::string write_file_beside_scene(const std::string& name, const std::string& text) const {
        write_file(folder / name, text);
        return (folder / name).string();
    }
    /// Loads a small scene whose override file x.obj.catoptric.json contains the text `beside`.
    session::ResolvedScene load_with_override_file(const std::string& beside,
                                                   const SceneOverrides& overrides = {}) const {
        const std::string scene = write_file_beside_scene("x.obj", kUnlitTriangleObjText + kCamera);
        write_file_beside_scene("x.obj.catoptric.json", beside);
        return session::resolve_scene(scene, {.overrides = overrides});
    }
    std::string override_file_error_text(const std::string& beside) const {
        return test::catch_error_text(Failure::bad_data, [&] { load_with_override_file(beside); });
    }
};

TEST_F(Beside, EveryKeyOfTheOverrideFileIsRead) {
    measure::write_exr(measure::Picture(4, 2), folder / "sky.exr");
    const session::ResolvedScene found = load_with_override_file(
        R"({"mirrors": ["thing=0.5"], "mirror_max_roughness": 0.25, "dielectric_mirrors": true, "multiple_scattering": "turquin", "glass_shadow": "tint", "light_samples": 4,
            "environment_shadows": 16, "environment": "sky.exr", "environment_scale": 2, "environment_rotate": -90,
            "ambient": 0.125, "exposure": -1.5, "camera": "1,2,3:0,0,0:30", "up": "y",
            "animation": "none"})");
    const Scene& scene = found.scene;
    EXPECT_EQ(scene.materials.back().reflectance, vec3(.5f));
    EXPECT_EQ(scene.mirror_max_roughness, .25f);
    EXPECT_EQ(found.overrides.dielectric_mirrors, true);
    EXPECT_TRUE(scene.has_multiple_scattering);
    EXPECT_TRUE(scene.tints_glass_shadows);
    EXPECT_EQ(scene.light_samples, 4);
    EXPECT_EQ(scene.environment_shadows, 16);
    ASSERT_NE(scene.environment, nullptr);
    EXPECT_EQ(scene.environment->name, "sky.exr");
    EXPECT_EQ(scene.environment->size, uvec2(4, 2));
    EXPECT_EQ(scene.environment->scale, 2);
    EXPECT_EQ(scene.environment->rotation_degrees, -90);
    EXPECT_EQ(session::choose_ambient(found), .125);
    EXPECT_EQ(session::find_exposure(found), -1.5);
    EXPECT_EQ(scene.cameras.front().eye, dvec3(1, 2, 3)) << "first, so that it is hashed";
    EXPECT_EQ(scene.cameras.size(), 2u);
    EXPECT_EQ(found.overrides.animation, "none");
    EXPECT_THAT(found.said,
                ElementsAre(HasSubstr("x.obj.catoptric.json (--no-scene-file"),
                            HasSubstr("x.obj.catoptric.json: surfaces rougher than 0.25 are no "
                                      "mirrors (mirror_max_roughness; --mirror-max-roughness sets "
                                      "another limit, 0.6 by default)")));
    EXPECT_EQ(scene.files.size(), 3u) << "nothing may be written over what was read";
}

TEST_F(Beside, OverrideFileChangesTheSceneHashAndCanBeIgnored) {
    const session::ResolvedScene plain = load_with_override_file("{}");
    const std::string path = (folder / "x.obj").string();
    for (const char* text : {R"({"mirrors": ["thing"]})", R"({"environment": "none"})",
                             R"({"camera": "1,2,3:0,0,0:30"})", R"({"exposure": 1})"}) {
        EXPECT_NE(hash_scene(load_with_override_file(text).scene), hash_scene(plain.scene)) << text;
        EXPECT_EQ(hash_scene(session::resolve_scene(path, {.use_scene_file = false}).scene),
                  hash_scene(plain.scene));
    }
}

TEST_F(Beside, CameraIndexCountsInTheOrderOfTheScene) {
    const std::string scene = write_file_beside_scene(
        "x.obj", kUnlitTriangleObjText + kCamera + "# catoptric camera d 0 0 6 0 0 0 0 1 0 40\n" +
                     "# catoptric camera e 0 0 7 0 0 0 0 1 0 40\n");
    for (const auto& [index, name] : {std::pair("0", "c"), {"1", "d"}, {"2", "e"}}) {
        write_file_beside_scene("x.obj.catoptric.json",
                                std::string("{\"camera\": \"") + index + "\"}");
        session::ResolvedScene found = session::resolve_scene(scene, {});
        EXPECT_EQ(session::choose_camera(found, 1).name, name);
        EXPECT_EQ(found.scene.cameras.front().name, name);
        SceneOverrides overrides;
        overrides.camera = "1";
        session::ResolvedScene other = session::resolve_scene(scene, {.overrides = overrides});
        EXPECT_EQ(session::choose_camera(other, 1).name, "d");
    }
}

TEST_F(Beside, CommandLineWinsOverTheOverrideFile) {
    SceneOverrides overrides;
    overrides.exposure = ExposureOverride{2};
    overrides.environment = "none";
    overrides.ambient = .5;
    overrides.camera = "c";
    overrides.mirrors = {{"thing", vec3(1)}};
    session::ResolvedScene found = load_with_override_file(
        R"({"mirrors": ["thing=0.5"], "environment": "studio", "ambient": 0, "exposure": "auto",
            "camera": "1,2,3:0,0,0:30"})",
        overrides);
    EXPECT_EQ(found.scene.materials[found.scene.objects[0].material].reflectance, vec3(1));
    EXPECT_EQ(found.scene.environment, nullptr);
    EXPECT_EQ(session::choose_ambient(found), .5);
    EXPECT_EQ(session::find_exposure(found), 2);
    EXPECT_EQ(session::choose_camera(found, 1).name, "c");
}

TEST_F(Beside, InvalidValueErrorsNameFileAndKey) {
    EXPECT_THAT(override_file_error_text(R"({"camra": "c"})"),
                HasSubstr("x.obj.catoptric.json: 'camra': wanted one of mirrors, lights, "));
    EXPECT_THAT(override_file_error_text(R"({"camra": "c"})"),
                HasSubstr("(did you mean 'camera'?)"));
    EXPECT_THAT(override_file_error_text("[]"), HasSubstr("wanted an object, found an array"));
    EXPECT_THAT(override_file_error_text("{"), HasSubstr("x.obj.catoptric.json: JSON: "));
    EXPECT_THAT(override_file_error_text(R"({"exposure": 99})"),
                HasSubstr("exposure: wanted a number from -64 to 64, found 99"));
    EXPECT_THAT(override_file_error_text(R"({"exposure": "bright"})"),
                HasSubstr("found \"bright\""));
    EXPECT_THAT(override_file_error_text(R"({"mirrors": "thing"})"),
                HasSubstr("mirrors: wanted a list of texts"));
    EXPECT_THAT(override_file_error_text(R"({"mirrors": ["thing=7"]})"),
                HasSubstr("from 0 to 1, found 'thing=7'"));
    EXPECT_THAT(override_file_error_text(R"({"dielectric_mirrors": 1})"),
                HasSubstr("wanted true or false"));
    EXPECT_THAT(override_file_error_text(R"({"multiple_scattering": "full"})"),
                HasSubstr("wanted \"none\" or \"turquin\", found 'full'"));
    EXPECT_THAT(override_file_error_text(R"({"glass_shadow": "black"})"),
                HasSubstr("glass_shadow: wanted \"none\" or \"tint\", found 'black'"));
    EXPECT_THAT(override_file_error_text(R"({"light_samples": 0})"),
                HasSubstr("light_samples: wanted a number from 1 to 128, found 0"));
    EXPECT_THAT(override_file_error_text(R"({"light_samples": 2.5})"),
                HasSubstr("light_samples: wanted a whole number, found 2.5"));
    EXPECT_THAT(override_file_error_text(R"({"environment_shadows": 2000})"),
                HasSubstr("environment_shadows: wanted a number from 0 to 1024, found 2000"));
    EXPECT_THAT(override_file_error_text(R"({"up": "x"})"),
                HasSubstr("up: wanted \"y\" or \"z\", found \"x\""));
    EXPECT_THAT(override_file_error_text(R"({"environment": "../sky.exr"})"), HasSubstr("--root"));
    EXPECT_THAT(
        test::catch_error_text(Failure::missing_input,
                               [&] { load_with_override_file(R"({"environment": "gone.exr"})"); }),
        HasSubstr("x.obj.catoptric.json: environment: 'gone.exr' is not there"));
}

/// Errors of an override file that appear only once the scene is known, such as names of missing
/// objects.
TEST_F(Beside, MissingSceneItemErrorsNameFileAndKey) {
    const struct {
        const char *text, *wanted;
    } cases[] = {{R"({"mirrors": ["thing", "nope"]})", "mirrors 'nope': matches no object"},
                 {R"({"lights": ["nope"]})", "lights 'nope': matches no object"},
                 {R"({"lights": ["thing"]})", "lights 'thing': wanted something that emits light"},
                 {R"({"camera": "d"})", "camera: scene 'x' has no camera 'd'"},
                 {R"({"camera": ""})", "camera: scene 'x' has no camera ''"},
                 {R"({"camera": "1,2:0,0,0:30"})", "camera: wanted a point X,Y,Z, found '1,2'"},
                 {R"({"animation": "walk"})", "x.obj has no animation 'walk': wanted none"},
                 {R"({"environment": "none", "environment_scale": 2})",
                  "environment_scale: wanted an environment, found none; say \"environment\""}};
    for (const auto& [text, wanted] : cases) {
        const std::string said = override_file_error_text(text);
        EXPECT_THAT(said, HasSubstr("x.obj.catoptric.json: ")) << text;
        EXPECT_THAT(said, HasSubstr(wanted)) << text;
        EXPECT_EQ(said.find("--"), said.npos) << said;
    }
    SceneOverrides none;
    none.environment = "none";
    EXPECT_EQ(load_with_override_file(R"({"environment": "studio", "environment_scale": 2})", none)
                  .scene.environment,
              nullptr);
}

TEST_F(Beside, AnimationNameIsRefusedForAFileWithoutAnimations) {
    SceneOverrides walk;
    walk.animation = "walk";
    const std::string path = write_file_beside_scene("x.obj", kUnlitTriangleObjText);
    for (const std::string& scene : {path, std::string("cornell-mirrors")})
        EXPECT_THAT(
            test::catch_error_text(Failure::usage,
                                   [&] { session::resolve_scene(scene, {.overrides = walk}); }),
            HasSubstr("--animation: " + scene + " has no animation 'walk': wanted none"));
    walk.animation = "none";
    EXPECT_NO_THROW(session::resolve_scene(path, {.overrides = walk}));
}

TEST_F(Beside, WrittenOverridesAreReadBackUnchanged) {
    measure::write_exr(measure::Picture(4, 2), folder / "sky.exr");
    SceneOverrides overrides;
    overrides.mirrors = {{"a=b", vec3(1)}, {"c", {.1f, .5f, 0}}};
    overrides.lights = {"l*"};
    overrides.mirror_max_roughness = .3, overrides.dielectric_mirrors = false;
    overrides.multiple_scattering = true, overrides.light_samples = 9;
    overrides.environment_shadows = 5;
    overrides.tints_glass_shadows = true;
    overrides.environment = (folder / "sky.exr").string(), overrides.environment_rotation = 12.5;
    overrides.exposure = ExposureOverride{}, overrides.up = UpAxis::z, overrides.camera = "c";
    const std::string scene = write_file_beside_scene("x.obj", kUnlitTriangleObjText);
    const std::string text = scene_file_text(overrides, scene);
    EXPECT_THAT(text, HasSubstr("\"environment\": \"sky.exr\""));
    write_file_beside_scene("x.obj.catoptric.json", text);
    const std::optional<SceneFile> found = read_scene_file(scene, {});
    ASSERT_TRUE(found);
    overrides.environment = real_path(folder / "sky.exr").string();
    EXPECT_EQ(found->overrides, overrides);
    overrides.environment = "/dev/null";
    EXPECT_THAT(test::catch_error_text(Failure::usage, [&] { scene_file_text(overrides, scene); }),
                HasSubstr("wanted a picture below"));
}

/// Returns OBJ text of a closed box. The walls face inwards or outwards, and a mirror may hang at
/// one wall.
std::string make_closed_room_obj(bool turns_in, bool has_mirror) {
    std::string text = "mtllib m.mtl\n";
    for (int i = 0; i < 8; ++i)
        text += "v " + std::string(i & 1 ? "2" : "-2") + (i & 2 ? " 3" : " 0") +
                (i & 4 ? " 3\n" : " -3\n");
    text += "v -1 1 -2.9\nv 1 1 -2.9\nv 1 2 -2.9\nv -1 2 -2.9\n";
    text += "o walls\n";
    const std::array<std::array<int, 4>, 6> out{
        {{1, 3, 4, 2}, {5, 6, 8, 7}, {1, 2, 6, 5}, {3, 7, 8, 4}, {1, 5, 7, 3}, {2, 4, 8, 6}}};
    for (const std::array<int, 4>& face : out) {
        text += "f";
        for (std::size_t i = 0; i < 4; ++i)
            text += " " + std::to_string(face[turns_in ? 3 - i : i]);
        text += "\n";
    }
    return has_mirror ? text + "o mirror\nusemtl tin\nf 9 10 11 12\n" : text;
}

/// Returns OBJ text of a closed box around that room, whose faces point outwards.
std::string make_box_around() {
    std::string text = "o shell\nusemtl wall\n";
    for (int i = 0; i < 8; ++i)
        text += "v " + std::string(i & 1 ? "2.2" : "-2.2") + (i & 2 ? " 3.2" : " -.2") +
                (i & 4 ? " 3.2\n" : " -3.2\n");
    for (const char* face :
         {"-8 -6 -5 -7", "-4 -3 -1 -2", "-8 -7 -3 -4", "-6 -2 -1 -5", "-8 -4 -2 -6", "-7 -5 -1 -3"})
        text += std::string("f ") + face + "\n";
    return text;
}

/// Returns OBJ text of a closed drum of twelve sides around the origin, whose faces point inwards
/// or outwards.
std::string make_drum_obj(double radius, double half_height, bool turns_in) {
    std::string text = "usemtl wall\n";
    for (int i = 0; i < 24; ++i)
        text += fmt::format("v {} {} {}\n", radius * std::cos(i % 12 * std::numbers::pi / 6),
                            i < 12 ? -half_height : half_height,
                            radius * std::sin(i % 12 * std::numbers::pi / 6));
    const auto add = [&](std::vector<int> face) {
        if (turns_in) std::ranges::reverse(face);
        text += "f";
        for (const int corner : face) text += fmt::format(" {}", corner - 24);
        text += "\n";
    };
    std::vector<int> low(12), high(12);
    for (int i = 0; i < 12; ++i) {
        low[std::size_t(i)] = i, high[std::size_t(i)] = 23 - i;
        add({i, i + 12, (i + 1) % 12 + 12, (i + 1) % 12});
    }
    add(low), add(high);
    return text;
}

TEST_F(Beside, DefaultCameraOfAClosedRoomIsInside) {
    write_file_beside_scene("m.mtl", "newmtl tin\nKs 1 1 1\nillum 3\nnewmtl wall\nKd .5 .5 .5\n"
                                     "newmtl glass\nTf 1 1 1\nNi 1.5\nillum 6\nd .1\n");
    bool names_inside = false; // whether the note names the camera that looks from inside
    const auto camera_of = [&](const std::string& text) {
        session::ResolvedScene found = session::resolve_scene(
            write_file_beside_scene("x.obj", text), {});
        const Camera camera = session::choose_camera(found, 1);
        const Bounds<double> box = bounds(found.scene);
        const bool is_inside = box.lo.x < camera.eye.x && camera.eye.x < box.hi.x &&
                               box.lo.y < camera.eye.y && camera.eye.y < box.hi.y &&
                               box.lo.z < camera.eye.z && camera.eye.z < box.hi.z;
        EXPECT_EQ(is_inside, found.said.back().starts_with("no camera, a closed room: using "
                                                           "--camera "))
            << found.said.back();
        EXPECT_THAT(found.said.back(), HasSubstr(format_camera(camera)));
        EXPECT_EQ(found.scene.unsupported.back().id, "added-camera");
        names_inside = found.said.back().ends_with(" looks from inside");
        return is_inside;
    };
    EXPECT_TRUE(camera_of(make_closed_room_obj(true, false))) << "outside it shows its backs alone";
    EXPECT_FALSE(camera_of(make_closed_room_obj(false, true))) << "its walls face out";
    EXPECT_TRUE(names_inside) << "outside it hides its mirror";
    EXPECT_FALSE(camera_of(make_closed_room_obj(false, false))) << "a crate";
    EXPECT_FALSE(names_inside);
    const std::string inner = make_closed_room_obj(true, true);
    EXPECT_TRUE(camera_of(inner + make_box_around())) << "a room with thick walls hides its mirror";
    const std::string round = "mtllib m.mtl\nusemtl tin\nv -1 0 0\nv 1 0 0\nv 1 1 0\nv -1 1 0\n"
                              "f 1 2 3 4\n";
    EXPECT_TRUE(camera_of(round + make_drum_obj(2, 2, true) + make_drum_obj(2.3, 2.3, false)))
        << "a round room with thick walls hides its mirror";
    const std::string glass = "usemtl glass\n" + make_closed_room_obj(true, false);
    EXPECT_FALSE(camera_of(glass)) << "a drinking glass";
    EXPECT_TRUE(names_inside);
    EXPECT_FALSE(camera_of(kUnlitTriangleObjText)) << "not closed";
    std::string open = make_closed_room_obj(true, true);
    open.erase(open.find("f 7 8 6 5")); // removes this wall and the text after it
    EXPECT_FALSE(camera_of(open)) << "walls are missing";
}

TEST_F(Beside, FileWithoutLightAndCameraGetsBoth) {
    const std::string path = write_file_beside_scene("x.obj", kUnlitTriangleObjText);
    session::ResolvedScene found = session::resolve_scene(path, {});
    const Camera camera = session::choose_camera(found, 2);
    ASSERT_NE(found.scene.environment, nullptr);
    EXPECT_TRUE(found.scene.environment->studio);
    EXPECT_EQ(session::choose_ambient(found), 0);
    EXPECT_EQ(session::find_exposure(found), std::nullopt) << "auto";
    EXPECT_EQ(camera, default_camera(found.scene, 2));
    std::vector<std::string> ids;
    for (const UnsupportedFeature& gap : found.scene.unsupported) ids.push_back(gap.id);
    EXPECT_THAT(ids, ElementsAre("indirect-left-out", "environment-unshadowed", "added-studio",
                                 "added-camera"));
    EXPECT_THAT(found.said, ElementsAre(HasSubstr("lit by the environment studio"),
                                        HasSubstr("using --camera " + format_camera(camera))));
    // The camera numbers in the message, given back as an option, make the same camera.
    const Camera typed = find_camera(format_camera(camera), found.scene);
    EXPECT_EQ(typed.eye, camera.eye);
    EXPECT_EQ(typed.target, camera.target);
}

TEST_F(Beside, NoEnvironmentIsAddedToALitSceneOrIfTheUserChoseNone) {
    SceneOverrides none;
    none.environment = "none";
    const std::string dark = write_file_beside_scene("x.obj", kUnlitTriangleObjText + kCamera);
    const session::ResolvedScene black = session::resolve_scene(dark, {.overrides = none});
    EXPECT_EQ(black.scene.environment, nullptr);
    EXPECT_EQ(session::choose_ambient(black), .05);
    EXPECT_THAT(black.scene.unsupported, IsEmpty());
    EXPECT_THAT(black.said, IsEmpty());
    write_file_beside_scene("l.mtl", "newmtl l\nKe 1 1 1\n");
    const std::string lit = write_file_beside_scene("y.obj", "mtllib l.mtl\nusemtl l\n" +
                                                                 kUnlitTriangleObjText + kCamera);
    EXPECT_EQ(session::resolve_scene(lit, {}).scene.environment, nullptr);
    SceneOverrides turned;
    turned.environment_rotation = 3;
    EXPECT_THAT(test::catch_error_text(Failure::usage,
                                       [&] { session::resolve_scene(lit, {.overrides = turned}); }),
                HasSubstr("--environment-rotate: wanted an environment, found none"));
}

TEST_F(Beside, NegativeOrMissingEnvironmentsAreRefused) {
    measure::Picture picture(3, 2);
    picture.at(1, 1) = vec3(0, -1, 0);
    measure::write_exr(picture, folder / "sky.exr");
    SceneOverrides overrides;
    overrides.environment = (folder / "sky.exr").string();
    const std::string path = write_file_beside_scene("x.obj", kUnlitTriangleObjText);
    EXPECT_THAT(
        test::catch_error_text(Failure::bad_data,
                               [&] { session::resolve_scene(path, {.overrides = overrides}); }),
        HasSubstr("sky.exr: texel 1,1: wanted finite light of at least 0, found 0,-1,0"));
    picture.at(1, 1) = vec3(0, -.004f, 0), picture.at(0, 0) = vec3(1);
    measure::write_exr(picture, folder / "sky.exr");
    EXPECT_EQ(session::resolve_scene(path, {.overrides = overrides}).scene.environment->texels[4],
              vec3(0))
        << "what a filter or lossy compression leaves below 0";
    overrides.environment = "gone.hdr";
    EXPECT_THAT(
        test::catch_error_text(Failure::missing_input,
                               [&] { session::resolve_scene(path, {.overrides = overrides}); }),
        HasSubstr("gone.hdr"));
}

/// The Radiance file is not run-length encoded. Each texel has a shared exponent, and rows run from
/// the top.
TEST_F(Beside, RadianceEnvironmentFilesAreRead) {
    std::string file = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n";
    for (const int byte : {128, 64, 32, 129, 255, 128, 0, 133}) file += static_cast<char>(byte);
    SceneOverrides overrides;
    overrides.environment = write_file_beside_scene("sky.hdr", file);
    const session::ResolvedScene found = session::resolve_scene(
        write_file_beside_scene("x.obj", kUnlitTriangleObjText), {.overrides = overrides});
    ASSERT_EQ(found.scene.environment->size, uvec2(2, 1));
    const std::vector<vec3>& texels = found.scene.environment->texels;
    const vec3 first(1, .5f, .25f),
        second(31.875f, 16, 0); // RGBE: mantissa / 256 * 2^(exponent - 128)
    // The reader may add half a quantisation step.
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(texels[0][c], first[c], 1.0 / 256);
        EXPECT_NEAR(texels[1][c], second[c], 1.0 / 8);
    }
}

TEST_F(Beside, BuiltInScenesGetNoAddedLightOrCamera) {
    session::ResolvedScene found = session::resolve_scene("cornell-mirrors", {});
    EXPECT_EQ(hash_scene(found.scene), hash_scene(make_cornell()));
    EXPECT_EQ(session::choose_ambient(found), .05);
    EXPECT_EQ(session::find_exposure(found), 0);
    ASSERT_EQ(found.scene.unsupported.size(), 1u) << "as in any scene that is lit";
    EXPECT_EQ(found.scene.unsupported[0].id, "indirect-left-out");
    EXPECT_EQ(session::choose_camera(found, 1).name, "contract");
    EXPECT_THAT(found.said, IsEmpty());
}

} // namespace
