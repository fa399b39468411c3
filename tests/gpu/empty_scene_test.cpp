// Tests of sessions without objects, which show the environment, and of scenes that a session must
// refuse before any frame.
#include "session/access.hpp"
#include "session/run.hpp"
#include "support/refusal.hpp"
#include "support/rendering.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace {

using namespace catoptric;

constexpr uvec2 kEmptyPictureSize{16, 12};
constexpr vec3 kSkyRadiance{.5f, .25f, 1};

/// Returns a scene without objects, in a sky of one radiance.
scene::Scene make_empty_scene() {
    scene::Scene scene{.name = "empty"};
    scene.environment = std::make_shared<scene::Environment>(
        scene::Environment{.name = "sky", .size = {1, 1}, .texels = {kSkyRadiance}});
    return scene;
}

session::FrameSpec make_empty_scene_spec(const std::string& technique,
                                         session::RenderedWork model) {
    session::FrameSpec spec{.techniques = {technique}, .size = kEmptyPictureSize, .ambient = 0};
    spec.camera = {.eye = {0, 0, -3}, .target = {0, 1, 0}};
    spec.model = model;
    return spec;
}

std::vector<std::string> list_techniques_and_auto() {
    std::vector<std::string> names{"auto"};
    for (const session::TechniqueInfo& technique : session::techniques())
        names.push_back(technique.name);
    return names;
}

void expect_sky(const measure::Picture& picture, const std::string& what) {
    ASSERT_EQ(picture.pixels.size(), std::size_t{kEmptyPictureSize.x * kEmptyPictureSize.y});
    for (const vec3& pixel : picture.pixels) ASSERT_EQ(pixel, kSkyRadiance) << what;
}

TEST(EmptyScene, EveryTechniqueAndModelDrawsTheSky) {
    session::Session session(test::get_test_engine(), make_empty_scene());
    for (const std::string& technique : list_techniques_and_auto())
        for (const session::RenderedWork model :
             {session::RenderedWork::everything, session::RenderedWork::required})
            for (int frame = 1; frame <= 2; ++frame)
                expect_sky(session.frame(make_empty_scene_spec(technique, model)).hdr(),
                           technique + " " + session::work_name(model));
}

TEST(EmptyScene, EveryTechniqueDrawsTheSkyAfterTheLastObjectIsRemoved) {
    scene::Scene scene = make_empty_scene();
    scene::add_ball(scene, "ball", add_material(scene, {.name = "mirror", .mirror = true}),
                    {0, 0, 0}, 1, 1);
    scene::add_ball(scene, "lamp", add_material(scene, {.name = "lamp", .emission = vec3(2)}),
                    {0, 3, 0}, .5, 1);
    for (const std::string& technique : list_techniques_and_auto()) {
        session::Session session(test::get_test_engine(), scene);
        for (const session::RenderedWork model :
             {session::RenderedWork::required, session::RenderedWork::everything}) {
            const session::FrameSpec spec = make_empty_scene_spec(technique, model);
            static_cast<void>(session.frame(spec).hdr());
            if (!session.scene().objects.empty()) {
                session.change(scene::remove(0)); // the lamp moves up, and is no mirror
                scene::Scene rest = session.scene();
                session::Session fresh(test::get_test_engine(), rest);
                EXPECT_TRUE(test::have_equal_pixel_bytes(session.frame(spec).hdr(),
                                                         fresh.frame(spec).hdr()))
                    << technique;
                session.change(scene::remove(0));
            }
            expect_sky(session.frame(spec).hdr(), technique + " after the removal");
        }
    }
}

/// Adds an object whose mesh has no triangle, or only triangles without area, to the empty scene.
scene::Scene make_scene_without_area(const scene::Material& material, std::size_t triangles) {
    scene::Scene scene = make_empty_scene();
    scene::Mesh mesh{.name = "flat"};
    if (triangles > 0) mesh.positions.assign(3, dvec3(.1, 0, 0)), mesh.normals.assign(3, {0, 1, 0});
    mesh.triangles.assign(triangles, uvec3(0, 1, 2));
    add_mesh(scene, std::move(mesh), add_material(scene, material));
    return scene;
}

TEST(EmptyScene, EveryTechniqueDrawsTheSkyAroundObjectsWithoutArea) {
    const scene::Material materials[] = {
        {.name = "grey", .albedo = vec3(.5f)},
        {.name = "mirror", .mirror = true},
        {.name = "lamp", .emission = vec3(2)},
        {.name = "glass", .dielectric_f0 = vec3(.04f), .transmission = 1, .solid = true},
        {.name = "veil", .albedo = vec3(.5f), .alpha = .5f, .blended = true}};
    for (const scene::Material& material : materials)
        for (const std::size_t triangles : {0, 2}) {
            scene::Scene scene = make_scene_without_area(material, triangles);
            scene.objects[0].mirror = material.transmission > 0;
            session::Session session(test::get_test_engine(), scene);
            for (const std::string& technique : list_techniques_and_auto())
                for (const session::RenderedWork model :
                     {session::RenderedWork::everything, session::RenderedWork::required})
                    expect_sky(session.frame(make_empty_scene_spec(technique, model)).hdr(),
                               material.name + " " + technique);
        }
}

TEST(EmptyScene, SessionsRefuseScenesThatAreWrong) {
    scene::Scene scene = test::make_furnace_scene(1);
    scene.meshes[0].normals.clear();
    const std::string text = test::catch_error_text(
        Failure::bad_data, [&] { session::Session session(test::get_test_engine(), scene); });
    EXPECT_THAT(text, testing::HasSubstr("scene 'furnace': meshes[0] 'wall0': normals: wanted"));
}

TEST(EmptyScene, FramesRefuseNumbersThatAreWrong) {
    session::Session session(test::get_test_engine(), make_empty_scene());
    const auto refused = [&](const std::function<void(session::FrameSpec&)>& change) {
        session::FrameSpec spec = make_empty_scene_spec("reuse", session::RenderedWork::everything);
        change(spec);
        return test::catch_error_text(Failure::usage,
                                      [&] { static_cast<void>(session.frame(spec)); });
    };
    EXPECT_THAT(refused([](auto& spec) { spec.ambient = std::nan(""); }),
                testing::HasSubstr("ambient: wanted a finite number of at least 0, found nan"));
    EXPECT_THAT(refused([](auto& spec) { spec.ambient = -1; }), testing::HasSubstr("found -1"));
    EXPECT_THAT(refused([](auto& spec) { spec.exposure = INFINITY; }),
                testing::HasSubstr("exposure: wanted a finite number of stops, found inf"));
    EXPECT_THAT(refused([](auto& spec) { spec.camera.target = spec.camera.eye; }),
                testing::HasSubstr("camera '': wanted a target away from the eye"));
    EXPECT_THAT(refused([](auto& spec) { spec.camera.vertical_fov_degrees = std::nan(""); }),
                testing::HasSubstr("field of view between 0 and 180 degrees"));
    EXPECT_THAT(refused([](auto& spec) { spec.time = INFINITY; }), testing::HasSubstr("time"));
}

} // namespace
