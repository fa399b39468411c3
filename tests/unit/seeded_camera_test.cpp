// Tests of cameras drawn from a seed: equal seeds give equal cameras, and each camera sees a
// mirror.
#include "session/seeded_camera.hpp"

#include "core/error.hpp"
#include "scene/built_in.hpp"
#include "scene/shapes.hpp"
#include "stress/double_tracer.hpp"
#include "support/scenes.hpp"

#include <gmock/gmock.h>

#include <set>

namespace {

using namespace catoptric;

constexpr std::uint64_t kSeedCount = 25;

/// Returns the share of pixels that show a mirror. Mirrors are drawn black, and in a closed room
/// with ambient light everything else is lit.
double compute_mirror_pixel_share(const scene::Scene& scene, const scene::Camera& camera) {
    constexpr uvec2 kSeededPictureSize{64, 64};
    const stress::DoubleTracer tracer(scene, 1);
    std::size_t black = 0;
    for (std::uint32_t y = 0; y < kSeededPictureSize.y; ++y)
        for (std::uint32_t x = 0; x < kSeededPictureSize.x; ++x)
            black += tracer.trace_pixel(camera, kSeededPictureSize, x, y, 0) == dvec3(0);
    return static_cast<double>(black) / (kSeededPictureSize.x * kSeededPictureSize.y);
}

/// Returns test::make_lit_room, scaled by `scale` and moved by `by`.
scene::Scene make_moved_lit_room(int mirrors, double scale, dvec3 by) {
    scene::Scene scene = test::make_lit_room(mirrors, 1);
    dmat4 moved(scale);
    moved[3] = dvec4(by, 1);
    for (scene::Object& object : scene.objects) {
        object.world_from_object = moved * object.world_from_object;
        if (object.sphere)
            object.sphere = scene::Sphere{object.sphere->centre * scale + by,
                                          object.sphere->radius * scale};
    }
    return scene;
}

TEST(SeededCamera, SeededCameraSeesTheFrontOfAMirrorAtAnySceneScale) {
    for (const auto& [mirrors, scale, by] : {std::tuple{1, 1.0, dvec3(0)},
                                             {3, 1.0, dvec3(0)},
                                             {2, 1e4, dvec3(3e6, -2e6, 1e6)},
                                             {2, 1e-3, dvec3(1, 2, 3)}}) {
        const scene::Scene scene = make_moved_lit_room(mirrors, scale, by);
        std::set<std::string> drawn;
        for (std::uint64_t seed = 0; seed < kSeedCount; ++seed) {
            const scene::Camera camera = session::make_seeded_camera(scene, 0, seed);
            drawn.insert(camera.name);
            // A seeded camera sees a mirror with at least 11 of its 1024 rays, a share of .011. The
            // grid of rays can overestimate the share, so the bound is lower.
            EXPECT_GE(compute_mirror_pixel_share(scene, camera), .005) << camera.name;
            for (const std::size_t mirror : scene::mirrors(scene)) {
                const scene::Sphere& sphere = *scene.objects[mirror].sphere;
                EXPECT_GT(glm::distance(sphere.centre, camera.eye), sphere.radius) << camera.name;
            }
            EXPECT_GE(camera.vertical_fov_degrees, 25);
            EXPECT_LE(camera.vertical_fov_degrees, 60);
        }
        EXPECT_EQ(drawn.size(), kSeedCount) << "each seed its own";
    }
}

TEST(SeededCamera, EqualSeedsAndInstantsGiveEqualCameras) {
    const scene::Scene scene = scene::make_cornell();
    for (std::uint64_t seed = 0; seed < kSeedCount; ++seed) {
        const scene::Camera a = session::make_seeded_camera(scene, 1.5, seed),
                            b = session::make_seeded_camera(scene, 1.5, seed);
        EXPECT_EQ(a.eye, b.eye);
        EXPECT_EQ(a.target, b.target);
        EXPECT_EQ(a.vertical_fov_degrees, b.vertical_fov_degrees);
    }
}

TEST(SeededCamera, SeededCameraIsInFrontOfAFlatMirror) {
    scene::Scene scene = test::make_lit_room(0, 1);
    const std::size_t mirror = test::add_material(scene, {.name = "mirror", .mirror = true});
    test::add_quad(scene, "pane", mirror, {-.5, -.5, 0}, {.5, -.5, 0}, {.5, .5, 0},
                   {-.5, .5, 0}); // the mirror faces +z
    for (std::uint64_t seed = 0; seed < kSeedCount; ++seed)
        EXPECT_GT(session::make_seeded_camera(scene, 0, seed).eye.z, 0) << seed;
}

TEST(SeededCamera, SceneWithoutMirrorsGetsSeededCameras) {
    EXPECT_NE(session::make_seeded_camera(test::make_lit_room(0, 1), 0, 1).name,
              session::make_seeded_camera(test::make_lit_room(0, 1), 0, 2).name);
}

TEST(SeededCamera, SeedingFailsIfNoMirrorCanBeSeen) {
    scene::Scene hidden{.name = "hidden"};
    const std::size_t mirror = test::add_material(hidden, {.name = "mirror", .mirror = true});
    const std::size_t white = test::add_material(hidden, {.name = "white", .albedo = vec3(.7f)});
    test::add_ball(hidden, "ball", mirror, {0, 0, 0}, 1);
    for (int face = 0; face < 6; ++face)
        test::add_mesh(hidden, test::make_box_wall(face, dvec3(-1.01), dvec3(1.01)), white);
    for (const scene::Scene& scene : {hidden, scene::Scene{.name = "empty"}}) try {
            session::make_seeded_camera(scene, 0, 5);
            ADD_FAILURE() << scene.name;
        } catch (const Error& error) {
            EXPECT_EQ(error.failure, Failure::usage);
            EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("'" + scene.name + "'"),
                                                     testing::HasSubstr("seed 5")));
        }
}

} // namespace
