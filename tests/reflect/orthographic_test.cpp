// Tests of orthographic cameras in rasterisation and ray tracing: positions in the picture, and
// mirrors.
#include "support/lit.hpp"

#include <iostream>

namespace {

using namespace catoptric;

scene::Camera make_orthographic_camera(const dvec3& eye, const dvec3& target, double height) {
    return {.eye = eye, .target = target, .orthographic_height = height};
}

TEST(Orthographic, PositionDoesNotDependOnDepth) {
    scene::Scene scene{.name = "boards"};
    const auto board = [&](vec3 colour, dvec3 lo, dvec3 hi) {
        test::add_quad(
            scene, "board",
            test::add_material(scene, {.name = "lit", .emission = colour, .two_sided = true}), lo,
            {hi.x, lo.y, lo.z}, hi, {lo.x, hi.y, hi.z});
    };
    board({1, 0, 0}, {-1, -.5, 0}, {1, .5, 0});
    board({0, 1, 0}, {-1.5, .5, -40}, {-1, .75, -40}); // far behind, drawn at the same scale
    board({0, 0, 1}, {.5, -.25, 3}, {.75, 0, 3});      // a board in front of the first
    board({1, 1, 1}, {-2, -1, 6}, {2, 1, 6});          // a board behind the camera
    // The camera shows 4 x 2 units in 64 x 32 pixels, which is 16 pixels a unit.
    for (const double z : {4.0, 5.0})
        for (const std::string technique : {"raytrace", "naive"}) {
            scene.cameras = {make_orthographic_camera({0, 0, z}, {0, 0, 0}, 2)};
            const measure::Picture picture = test::render_technique(scene, technique, {64, 32}).hdr;
            const auto is_in = [](int x, int y, int left, int top, int right, int bottom) {
                return x >= left && x < right && y >= top && y < bottom;
            };
            for (int y = 0; y < 32; ++y)
                for (int x = 0; x < 64; ++x) {
                    const vec3 wanted = is_in(x, y, 40, 16, 44, 20)  ? vec3(0, 0, 1)
                                        : is_in(x, y, 16, 8, 48, 24) ? vec3(1, 0, 0)
                                        : is_in(x, y, 8, 4, 16, 8)   ? vec3(0, 1, 0)
                                                                     : vec3(0);
                    ASSERT_EQ(picture.at(x, y), wanted) << technique << ": " << x << ", " << y;
                }
        }
}

/// Tests that the picture does not depend on the distance of the camera, as long as the scene is in
/// front of it.
TEST(Orthographic, RasterisationEqualsRayTracing) {
    scene::Scene scene = test::make_yard_scene();
    scene.punctual.push_back(
        {.kind = scene::PunctualLight::Kind::directional,
         .intensity = vec3(2),
         .world_from_light = test::make_light_transform({0, 0, 0}, {-.4, -1, -.6})});
    for (const double far : {1.0, 200.0}) {
        scene.cameras = {make_orthographic_camera(far * dvec3(1.2, 2, 3), {0, .3, 0}, 4)};
        const double off = test::share_off_in_raster_picture(scene, {128, 96});
        std::cout << "[ MEASURED ] " << far << ": share off " << off << "\n";
        EXPECT_LE(off, .005) << far;
    }
}

/// Mirrors must reflect parallel rays as the ray tracer does, and `face=auto` must find a
/// resolution for them.
TEST(Orthographic, MirrorsReflectParallelViewRays) {
    scene::Scene scene = test::make_lit_room(2, 1);
    scene.cameras = {make_orthographic_camera({.1, .2, -2.9}, {0, -.2, 0}, 3)};
    constexpr uvec2 kOrthographicPictureSize{96, 96};
    const session::TechniqueResult truth = test::render_technique(scene, "raytrace",
                                                                  kOrthographicPictureSize);
    const measure::Mask mirrors = measure::mask_mirrors(truth.hits);
    for (const auto& [technique, most] :
         {std::pair{"hybrid", .02}, {"secant:face=auto", .1}, {"layered", .05}}) {
        const session::TechniqueResult part = test::render_technique(scene, technique,
                                                                     kOrthographicPictureSize, 4);
        std::size_t off = 0, all = 0;
        for (std::size_t i = 0; i < mirrors.size(); ++i) {
            if (mirrors[i] == 0) continue;
            ++all;
            off += test::max_channel_difference(part.hdr.pixels[i], truth.hdr.pixels[i]) >
                   float(measure::kMaxInvisibleDifference);
        }
        ASSERT_GT(all, 500u);
        const double share = double(off) / double(all);
        std::cout << "[ MEASURED ] " << technique << ": off " << share << "\n";
        EXPECT_LE(share, most) << technique;
    }
}

} // namespace
