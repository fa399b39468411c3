// Tests that rasterisation and ray tracing give the same picture where no mirror is seen.
#include "measure/lines.hpp"
#include "scene/built_in.hpp"
#include "support/numbers.hpp"
#include "support/rendering.hpp"

#include <iostream>

namespace {

using namespace catoptric;

struct RasterTracerBothSidesTest {
    const char *name, *raster, *traced;
    double most; ///< largest rmse allowed
    friend void PrintTo(const RasterTracerBothSidesTest& sides, std::ostream* out) {
        *out << sides.name;
    }
};
class RasterTracerAgreementTest : public testing::TestWithParam<RasterTracerBothSidesTest> {};
INSTANTIATE_TEST_SUITE_P(
    Shadows, RasterTracerAgreementTest,
    testing::Values(RasterTracerBothSidesTest{"map_and_ray", "naive:bounces=0", "raytrace:depth=16",
                                              .003},
                    RasterTracerBothSidesTest{"none", "naive:bounces=0,shadow=none",
                                              "raytrace:depth=16,shadow=none", 5e-4},
                    RasterTracerBothSidesTest{"map_on_both", "naive:bounces=0",
                                              "raytrace:depth=16,shadow=map", 5e-4}),
    [](const auto& instance) { return std::string(instance.param.name); });

TEST_P(RasterTracerAgreementTest, RasterisationEqualsRayTracingBesideMirrors) {
    const auto& [name, raster, traced, most] = GetParam();
    for (const scene::Scene& scene : {scene::make_cornell(), test::make_lit_room(2, 2)}) {
        const session::TechniqueResult truth = test::render_technique(scene, traced, {512, 512});
        const double error = test::rmse_of_pictures(
            test::render_technique(scene, raster, {512, 512}).hdr, truth.hdr,
            measure::mask_non_mirrors(truth.hits));
        std::cout << "[ MEASURED ] " << scene.name << ", shadows " << name << ": rmse " << error
                  << " on non-mirror pixels\n";
        EXPECT_LE(error, most) << scene.name;
    }
}

/// Counts the pixels that show a lamp, in mirrors (first) and outside mirrors (second). Nothing
/// else in the scene is as bright.
std::pair<std::size_t, std::size_t> count_lamp_pixels(const scene::Scene& scene,
                                                      const std::string& technique) {
    const session::TechniqueResult truth = test::render_technique(scene, "raytrace:depth=16",
                                                                  {128, 128});
    const session::TechniqueResult part = test::render_technique(scene, technique, {128, 128}, 3);
    std::pair<std::size_t, std::size_t> found{0, 0};
    for (std::size_t i = 0; i < part.hdr.pixels.size(); ++i)
        if (part.hdr.pixels[i].x > 4)
            ++(measure::first_mirror(truth.hits[i]) ? found.first : found.second);
    return found;
}

/// Tests a lamp that shines to one side only. Cameras, reflected rays and captures behind the lamp
/// look through the lamp.
TEST(Lamp, OneSidedLampIsSeenFromItsFrontOnly) {
    for (const bool faces_eye : {true, false}) {
        scene::Scene scene = test::make_lit_room(1, 0);
        scene.objects.back().world_from_object[3] = dvec4(0, -.4, .8, 1);
        scene.objects.back().sphere->centre = {0, -.4, .8};
        const std::size_t lamp = test::add_material(scene, {.name = "lamp", .emission = {9, 8, 6}});
        const double side = faces_eye ? 1 : -1;
        test::add_quad(scene, "lamp", lamp, {.6 - .4 * side, .5, -.6}, {.6 - .4 * side, 1.3, -.6},
                       {.6 + .4 * side, 1.3, -.6}, {.6 + .4 * side, .5, -.6});
        const auto [mirrored, direct] = count_lamp_pixels(scene, "raytrace:depth=16");
        std::cout << "[ MEASURED ] rays meet the lamp in " << mirrored << " pixels of mirrors and "
                  << direct << " beside them\n";
        EXPECT_EQ(mirrored > 0, !faces_eye);
        EXPECT_EQ(direct > 0, faces_eye);
        for (const session::TechniqueInfo& technique : session::techniques()) {
            SCOPED_TRACE(technique.name);
            const auto found = count_lamp_pixels(scene, technique.name);
            EXPECT_NEAR(double(found.second), double(direct), .02 * double(direct));
            EXPECT_EQ(found.first > 0, mirrored > 0);
        }
    }
}

/// Returns a random camera of the given kind: 0 is just above the floor, 1 behind everything, 2
/// wide, 3 next to a ball. Other kinds are anywhere in the scene.
scene::Camera draw_random_camera_of_kind(test::RandomNumbers& random, int kind) {
    const auto within = [&](vec3 lo, vec3 hi) {
        const float x = random.random_number_between(lo.x, hi.x),
                    y = random.random_number_between(lo.y, hi.y);
        return dvec3(x, y, random.random_number_between(lo.z, hi.z));
    };
    scene::Camera camera{.eye = within({20, 20, 20}, {530, 520, 540}),
                         .target = within({100, 20, 150}, {450, 300, 550}),
                         .vertical_fov_degrees = random.random_number_between(35, 80)};
    if (kind == 0) camera.eye = within({20, 1.5f, -300}, {530, 20, 200});
    if (kind == 1) camera.eye = within({20, 20, 500}, {530, 520, 555}), camera.target.z = 0;
    if (kind == 2) camera.vertical_fov_degrees = 130;
    if (kind == 3) camera.eye = dvec3(90, 100, 110) + 80.0 * dvec3(random.random_unit_direction());
    return camera;
}

/// Returns the share of pixels outside mirrors in which the pictures differ by more than .02.
double share_of_differing_pixels_outside_mirrors(const session::TechniqueResult& raster,
                                                 const session::TechniqueResult& traced) {
    std::size_t off = 0;
    for (std::size_t i = 0; i < traced.hits.size(); ++i) {
        if (traced.hits[i] != 0) continue;
        const vec3 apart = abs(clamp(raster.hdr.pixels[i], 0.0f, 1.0f) -
                               clamp(traced.hdr.pixels[i], 0.0f, 1.0f));
        off += !(std::max({apart.x, apart.y, apart.z}) <=
                 static_cast<float>(measure::kMaxInvisibleDifference));
    }
    return static_cast<double>(off) / static_cast<double>(traced.hits.size());
}

/// Both pictures use the same shadow map, so they can differ only in the position of the shaded
/// point. A rasteriser with a larger error than the map's bias would draw bands of false shadow on
/// a floor seen from near the floor.
TEST(ShadowMap, RasterAndRaysShadeTheSamePointsFromAnyCamera) {
    constexpr int kRandomCameraCount = 30;
    test::RandomNumbers random(20);
    double worst = 0, sum = 0;
    for (int i = 0; i < kRandomCameraCount; ++i) {
        session::Request request = test::make_test_request(
            scene::make_cornell(), {"naive:bounces=0", "raytrace:depth=0,shadow=map"}, {256, 256});
        request.camera = i == 0   ? scene::Camera{.eye = {540, 12, -60},
                                                  .target = {300, 60, 400},
                                                  .vertical_fov_degrees = 55}
                         : i == 1 ? scene::Camera{.eye = {100, 5, -100},
                                                  .target = {300, 40, 400},
                                                  .vertical_fov_degrees = 50}
                                  : draw_random_camera_of_kind(random, i % 5);
        request.time = i == 0 ? 1.9 : i == 1 ? 0 : .7 * (i % 6);
        const session::RunResult result = session::run(test::get_test_engine(), request);
        const double off = share_of_differing_pixels_outside_mirrors(result.parts[0],
                                                                     result.parts[1]);
        EXPECT_LE(off, 1e-4) << "eye " << request.camera.eye.x << "," << request.camera.eye.y << ","
                             << request.camera.eye.z;
        worst = std::max(worst, off), sum += off;
    }
    std::cout << "[ MEASURED ] " << kRandomCameraCount << " cameras: share off worst " << worst
              << ", mean " << sum / kRandomCameraCount << "\n";
}

// Surfaces are offset from the shadow map so that they do not shadow themselves. The offset must
// not be larger than needed. A coarse map shows an excess, because the offset grows with the size
// of a texel.
TEST(ShadowMap, OffsetIsNoLargerThanNeeded) {
    const session::TechniqueResult truth = test::render_technique(scene::make_cornell(),
                                                                  "raytrace:depth=16", {256, 256});
    const double error = test::rmse_of_pictures(
        test::render_technique(scene::make_cornell(), "naive:bounces=0,shadow_map=64", {256, 256})
            .hdr,
        truth.hdr, measure::mask_non_mirrors(truth.hits));
    std::cout << "[ MEASURED ] shadow_map=64: rmse " << error << " on non-mirror pixels\n";
    EXPECT_LE(error, .0052); // measured .0049; with twice the offset .0055
}

// Tests nodes whose scale is 0 along one axis. A flat quad must look unchanged, and a ball must
// become a disc.
TEST(Flattened, NodesScaledToZeroKeepTheirNormals) {
    scene::Scene flat{.name = "flat"};
    test::add_quad(flat, "lamp", test::add_material(flat, {.name = "lamp", .emission = vec3(9)}),
                   {-1, 3, -4}, {1, 3, -4}, {1, 3, -2}, {-1, 3, -2});
    test::add_quad(flat, "wall", test::add_material(flat, {.name = "grey", .albedo = vec3(.7f)}),
                   {-2, -2, 0}, {-2, 2, 0}, {2, 2, 0}, {2, -2, 0});
    test::add_ball(flat, "ball", test::add_material(flat, {.name = "mirror", .mirror = true}),
                   {0, 0, -.5}, .5);
    flat.objects.back().sphere.reset();
    flat.objects.back().world_from_object = dmat4(1);
    flat.objects.back().world_from_object[3] = dvec4(0, 0, -.5, 1);
    flat.objects.back().world_from_object[2] = dvec4(0); // the ball becomes a mirror disc
    flat.cameras.push_back({.eye = {0, 1, -6}, .target = {0, 0, 0}, .vertical_fov_degrees = 50});
    scene::Scene scaled = flat;
    // The mesh of the wall has no extent along z, so this scale does not change its shape.
    scaled.objects[1].world_from_object[2] = dvec4(0);
    for (const std::string technique : {"raytrace", "parallax:face=64"}) {
        const measure::Picture wanted = test::render_technique(flat, technique, {128, 128}, 3).hdr,
                               found = test::render_technique(scaled, technique, {128, 128}, 3).hdr;
        EXPECT_EQ(test::count_nonfinite(wanted), 0u) << technique;
        EXPECT_TRUE(test::have_equal_pixel_bytes(found, wanted)) << technique;
        EXPECT_GT(wanted.at(20, 64).x, .1f) << technique << ": the wall is lit";
    }
}

} // namespace
