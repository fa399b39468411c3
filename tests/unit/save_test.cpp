// Tests that a scene which is saved as .glb and loaded again stays the same: textures, colours,
// lights and rigs.
#include "unit/load_fixture.hpp"

#include "scene/build.hpp"
#include "scene/motion.hpp"
#include "scene/pose.hpp"

#include <cmath>

namespace {

using namespace test::loading;

class SaveSceneTest : public Load {
protected:
    Scene save_and_load_scene(const Scene& scene) const {
        save_glb(scene, folder / "x.glb");
        return load((folder / "x.glb").string());
    }
    /// Returns a scene of one square without lights.
    static Scene make_square_scene() {
        Scene scene{.name = "x"};
        scene.materials.push_back({.name = "m", .albedo = vec3(.5f), .front_only = true});
        scene.meshes.push_back(quad("q", {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}));
        scene.objects.push_back({.name = "o"});
        return scene;
    }
};

TEST_F(SaveSceneTest, SavedMaterialsLoadUnchanged) {
    Scene scene = make_square_scene();
    const auto image = std::make_shared<const Image>(
        Image{.name = "p", .size = {2, 2}, .texels = {0xff0000ff, 0x8000ff00, 0, 0x12345678}});
    Material& material = scene.materials[0];
    material.albedo_texture = Texture{.image = image,
                                      .wrap_u = Texture::Wrap::mirrored,
                                      .wrap_v = Texture::Wrap::clamp,
                                      .nearest = true,
                                      .srgb = true,
                                      .uv_set = 1};
    material.roughness_texture = Texture{
        .image = image, .u_row = {0, 2, .5f}, .v_row = {-3, 0, .25f}};
    material.emission_texture = Texture{.image = image, .srgb = true};
    material.normal_texture = Texture{.image = image, .v_row = {0, 2, 0}};
    material.normal_scale = -1.5f;
    material.emission = {4, 2, 1};
    material.metallic = .25f, material.roughness = .5f;
    material.dielectric_f0 = {.08f, .04f, .02f}, material.dielectric_f90 = vec3(.5f);
    material.alpha = .75f, material.alpha_cutoff = .3f;
    scene.materials.push_back(
        {.name = "flat", .albedo = {1, 0, .5f}, .front_only = true, .unlit = true});
    scene.materials.push_back(
        {.name = "veil", .albedo = vec3(1), .alpha = .3f, .alpha_cutoff = .5f, .blended = true});
    scene.materials.push_back({.name = "sides", .albedo = vec3(.25f), .two_sided = true});
    scene.materials.push_back(
        {.name = "constant", .albedo = vec3(.5f), .mirror = true, .reflectance = vec3(.25f)});
    scene.materials.push_back({.name = "fixed", .albedo = vec3(1)});
    const Scene found = save_and_load_scene(scene);
    ASSERT_EQ(found.materials.size(), scene.materials.size());
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        Material wanted = scene.materials[i], its = found.materials[i];
        for (auto texture : {&Material::albedo_texture, &Material::roughness_texture,
                             &Material::emission_texture, &Material::normal_texture}) {
            ASSERT_EQ((wanted.*texture).has_value(), (its.*texture).has_value());
            if (!(wanted.*texture)) continue;
            EXPECT_EQ((wanted.*texture)->image->texels, (its.*texture)->image->texels);
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR((wanted.*texture)->u_row[c], (its.*texture)->u_row[c], 1e-6);
                EXPECT_NEAR((wanted.*texture)->v_row[c], (its.*texture)->v_row[c], 1e-6);
            }
            (its.*texture)->image = (wanted.*texture)->image;
            (its.*texture)->u_row = (wanted.*texture)->u_row;
            (its.*texture)->v_row = (wanted.*texture)->v_row;
        }
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(wanted.dielectric_f0[c], its.dielectric_f0[c], 1e-6);
        its.dielectric_f0 = wanted.dielectric_f0;
        EXPECT_EQ(wanted, its) << wanted.name;
    }
    EXPECT_EQ(found.materials[0].albedo_texture->image, found.materials[0].roughness_texture->image)
        << "written once";
}

TEST_F(SaveSceneTest, SavedTextureCoordinatesAndColoursLoadUnchanged) {
    Scene scene = make_square_scene();
    Mesh& mesh = scene.meshes[0];
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        mesh.uv[0].emplace_back(i, .5f), mesh.uv[1].emplace_back(-1.f, i);
        mesh.colours.emplace_back(1, 0, .25f * static_cast<float>(i), .5f);
    }
    const Scene found = save_and_load_scene(scene);
    EXPECT_EQ(found.meshes[0].uv, mesh.uv);
    EXPECT_EQ(found.meshes[0].colours, mesh.colours);
}

TEST_F(SaveSceneTest, SavedLightsAndCamerasLoadUnchanged) {
    using enum PunctualLight::Kind;
    Scene scene = make_square_scene();
    dmat4 turned(1);
    turned[0] = dvec4(0, 1, 0, 0), turned[1] = dvec4(-1, 0, 0, 0), turned[3] = dvec4(1, 2, 3, 1);
    scene.punctual = {{.name = "p", .kind = point, .intensity = {8, 4, 2}, .range = 5},
                      {.name = "s",
                       .kind = spot,
                       .intensity = vec3(3),
                       .cos_inner = std::cos(.25),
                       .cos_outer = std::cos(.5),
                       .world_from_light = turned},
                      {.name = "d", .kind = directional, .intensity = vec3(2)}};
    scene.punctual[2].motion = HarmonicMotion{{0, 1, 0}, 4};
    scene.cameras = {{.name = "plan",
                      .eye = {0, 5, 0},
                      .target = {0, 0, 0},
                      .up = {0, 0, -1},
                      .orthographic_height = 3}};
    scene.exposure = -.5;
    const Scene found = save_and_load_scene(scene);
    ASSERT_EQ(found.punctual.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        const PunctualLight &a = found.punctual[i], &b = scene.punctual[i];
        EXPECT_EQ(a.name, b.name);
        EXPECT_EQ(a.kind, b.kind);
        EXPECT_EQ(a.intensity, b.intensity);
        EXPECT_EQ(a.range, b.range);
        EXPECT_EQ(a.world_from_light, b.world_from_light);
    }
    EXPECT_NEAR(found.punctual[1].cos_inner, std::cos(.25), 1e-12);
    EXPECT_NEAR(found.punctual[1].cos_outer, std::cos(.5), 1e-12);
    EXPECT_NEAR(scene_at(found, 6).punctual[2].world_from_light[3].y, 2, 1e-5) << "goes on and on";
    EXPECT_EQ(found.cameras.at(0).orthographic_height, 3);
    EXPECT_EQ(found.exposure, -.5);
    EXPECT_FALSE(save_and_load_scene(make_square_scene()).exposure);
}

TEST_F(SaveSceneTest, SavedRigsLoadUnchanged) {
    Scene scene = make_square_scene();
    const auto turns = std::make_shared<const RotationTrack>(
        RotationTrack{.times = {0, 1}, .values = {{0, 0, 0, 1}, {0, 0, 1, 0}}});
    NodeRig rig;
    rig.nodes.push_back({.translation = {1, 0, 0}, .rotations = turns});
    rig.nodes.push_back({.parent = 0, .translation = {0, 2, 0}, .rotations = turns});
    rig.nodes[1].parent_from_space[3] = dvec4(0, 0, 3, 1);
    RigAttachment follows{.rig = std::make_shared<const NodeRig>(rig), .node = 1};
    follows.node_from_object[3] = dvec4(0, 0, 1, 1);
    scene.objects[0].motion = follows;
    scene.cameras = {{.name = "c", .eye = {0, 0, 5}, .target = {0, 0, 4}, .follows = follows}};
    const Scene found = save_and_load_scene(scene);
    for (const double t : {0., .25, .75, 1., 2.}) {
        const Scene now = scene_at(found, t), wanted = scene_at(scene, t);
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row)
                EXPECT_NEAR(now.objects[0].world_from_object[column][row],
                            wanted.objects[0].world_from_object[column][row], 1e-6);
        EXPECT_LT(glm::distance(now.cameras[0].eye, wanted.cameras[0].eye), 1e-6);
        EXPECT_LT(glm::distance(now.cameras[0].target, wanted.cameras[0].target), 1e-6);
    }
}

TEST_F(SaveSceneTest, MotionOfACameraThatEndsDoesNotRepeat) {
    Scene scene = make_square_scene();
    NodeRig rig{.repeats = false};
    rig.nodes.push_back({.rotations = std::make_shared<const RotationTrack>(RotationTrack{
                             .times = {0, 1}, .values = {{0, 0, 0, 1}, {0, 0, 1, 0}}})});
    scene.cameras = {{.name = "c",
                      .eye = {0, 0, 5},
                      .target = {0, 1, 4},
                      .follows = {.rig = std::make_shared<const NodeRig>(rig)}}};
    const Scene found = save_and_load_scene(scene);
    for (const double t : {.25, 1., 1.25})
        EXPECT_LT(glm::distance(camera_at(found.cameras[0], t).target,
                                camera_at(scene.cameras[0], t).target),
                  1e-6)
            << t;
}

TEST_F(SaveSceneTest, ObjKeepsOrthographicCameras) {
    Scene scene = make_square_scene();
    scene.cameras = {{.name = "seen", .eye = {0, 0, 5}, .vertical_fov_degrees = 30},
                     {.name = "plan", .eye = {0, 0, 5}, .orthographic_height = 3}};
    save_obj(scene, folder / "x.obj");
    const Scene found = load((folder / "x.obj").string());
    ASSERT_EQ(found.cameras.size(), 2u);
    EXPECT_EQ(found.cameras[0].orthographic_height, 0);
    EXPECT_EQ(found.cameras[1].orthographic_height, 3);
    EXPECT_EQ(found.cameras[1].eye, scene.cameras[1].eye);
}

} // namespace
