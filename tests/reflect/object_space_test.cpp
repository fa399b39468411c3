// Tests of object spaces with balls a million times smaller than the room and far apart. No single
// origin is precise enough for both, so each ball is stored in its own object space. Each ball must
// look as in a scene without the other ball.
#include "measure/flip.hpp"
#include "scene/shapes.hpp"
#include "stress/double_tracer.hpp"
#include "support/rendering.hpp"

#include <cmath>

namespace {

using namespace catoptric;

constexpr double kSmallBallRadius = 1e-3;
constexpr uvec2 kObjectSpacePictureSize{96, 96};

/// Returns a room of edge 1000 with a lamp and one or two small balls. The camera is next to ball
/// 1.
scene::Scene make_room_with_far_balls(int count, bool mirrors) {
    scene::Scene scene{.name = "far balls"};
    const std::size_t white = test::add_material(scene, {.albedo = {.7f, .7f, .7f}}),
                      red = test::add_material(scene, {.albedo = {.6f, .1f, .1f}}),
                      green = test::add_material(scene, {.albedo = {.1f, .5f, .1f}}),
                      lamp = test::add_material(scene, {.emission = {9, 8, 6}}),
                      mirror = test::add_material(scene, {.name = "mirror", .mirror = true});
    for (int face = 0; face < 6; ++face)
        test::add_mesh(scene, test::make_box_wall(face, dvec3(-500), dvec3(500)),
                       face == 0   ? red
                       : face == 1 ? green
                                   : white);
    test::add_quad(scene, "lamp", lamp, {-80, 499, -90}, {80, 499, -90}, {80, 499, 60},
                   {-80, 499, 60});
    const dvec3 place(203.7, -101.3, -151.9);
    test::add_ball(scene, "ball1", mirrors ? mirror : red, place, kSmallBallRadius, 5);
    if (count > 1)
        test::add_ball(scene, "ball2", mirror, {-222.2, 181.4, 204.4}, kSmallBallRadius, 5);
    scene.cameras.push_back({.name = "near",
                             .eye = place + dvec3(.0017, .0011, -.0053),
                             .target = place + dvec3(.0002, 0, 0),
                             .vertical_fov_degrees = 30});
    return scene;
}

double mean_flip_of_results(const session::TechniqueResult& a, const session::TechniqueResult& b) {
    return measure::flip_mean(measure::flip(a.display, b.display));
}

TEST(ObjectSpace, BallLooksAsItDoesAloneAtTheOrigin) {
    const scene::Scene alone = make_room_with_far_balls(1, true),
                       both = make_room_with_far_balls(2, true);
    for (const std::string technique :
         {"raytrace", "raytrace:sphere=exact", "raytrace:hit=f64", "raytrace:shadow=map",
          "parallax", "pyramid", "hybrid", "layered"}) {
        const session::TechniqueResult wanted = test::render_technique(alone, technique,
                                                                       kObjectSpacePictureSize),
                                       found = test::render_technique(both, technique,
                                                                      kObjectSpacePictureSize);
        EXPECT_EQ(test::count_nonfinite(found.hdr), 0u) << technique;
        EXPECT_LE(mean_flip_of_results(found, wanted), .001) << technique;
    }
}

/// Tests a mirror ball and a diffuse ball. Shadow rays start on the diffuse ball, whose object
/// space is used even without a second ball, because only mirrors determine the scene's origin.
TEST(ObjectSpace, RayTracingEqualsDoublePrecision) {
    for (const bool mirrors : {true, false}) {
        const scene::Scene scene = make_room_with_far_balls(2, mirrors);
        const session::Request request = test::make_test_request(scene, {"raytrace:sphere=exact"},
                                                                 kObjectSpacePictureSize);
        const session::TechniqueResult part = test::render_technique(scene, "raytrace:sphere=exact",
                                                                     kObjectSpacePictureSize);
        const stress::DoubleTracer tracer(scene, request.ambient);
        measure::Picture truth(static_cast<int>(kObjectSpacePictureSize.x),
                               static_cast<int>(kObjectSpacePictureSize.y));
        std::size_t off = 0;
        for (std::uint32_t y = 0; y < kObjectSpacePictureSize.y; ++y)
            for (std::uint32_t x = 0; x < kObjectSpacePictureSize.x; ++x) {
                const dvec3 wanted = tracer.trace_pixel(scene.cameras.front(),
                                                        kObjectSpacePictureSize, x, y, 8),
                            found(part.hdr.pixels[x + kObjectSpacePictureSize.x * y]);
                const dvec3 apart = glm::abs(wanted - found);
                off += !(std::max({apart.x, apart.y, apart.z}) <= .01);
                truth.pixels[x + kObjectSpacePictureSize.x * y] = vec3(wanted);
            }
        EXPECT_LE(off, 20u) << "pixels of " << kObjectSpacePictureSize.x * kObjectSpacePictureSize.y
                            << ", mirrors " << mirrors;
        const double seen = measure::flip_mean(
            measure::flip(measure::to_display(part.hdr), measure::to_display(truth)));
        EXPECT_LE(seen, .001) << "mirrors " << mirrors;
    }
}

/// Returns eighty rotated and stretched balls. `shared`: all balls are copies of one mesh, too many
/// to be stored in scene units. Otherwise each has its own mesh.
scene::Scene make_scene_of_many_balls(bool shared) {
    scene::Scene scene = test::make_lit_room(0, 1);
    const std::size_t mirror = test::add_material(scene, {.name = "mirror", .mirror = true});
    for (int i = 0; i < 80; ++i) {
        const double turn = .3 * i;
        test::add_mesh(scene, scene::ball("ball", 5), i == 40 ? mirror : 1);
        scene::Object& ball = scene.objects.back();
        if (shared) ball.mesh = scene.objects[7].mesh;
        ball.world_from_object = .14 * dmat4(cos(turn), sin(turn), 0, 0, -sin(turn), cos(turn), 0,
                                             0, 0, 0, i % 2 ? .6 : -.6, 0, 0, 0, 0, 1 / .14);
        ball.world_from_object[3] = {i % 9 * .4 - 1.6, i / 9 * .4 - 1.7, .05 * i - 1.5, 1};
    }
    return scene;
}

TEST(ObjectSpace, CopiesOfOneMeshEqualSingleMeshes) {
    for (const std::string technique :
         {"raytrace", "raytrace:hit=f64", "raytrace:shadow=map", "pyramid", "hybrid"})
        EXPECT_LE(mean_flip_of_results(test::render_technique(make_scene_of_many_balls(true),
                                                              technique, kObjectSpacePictureSize),
                                       test::render_technique(make_scene_of_many_balls(false),
                                                              technique, kObjectSpacePictureSize)),
                  .001)
            << technique;
}

} // namespace
