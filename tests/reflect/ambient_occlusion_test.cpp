// Tests of the knob `ao`, which hides the environment from diffuse surfaces: by what the camera's
// view shows (`screen`), or by light probes (`captures`). In a white environment of radiance 1, a
// dark surface shows its albedo times the visible share of the environment.
#include "scene/classify.hpp"
#include "support/lit.hpp"
#include "support/refusal.hpp"
#include "support/rendering.hpp"
#include "support/smooth_environment.hpp"

#include <fmt/format.h>

#include <iostream>
#include <numbers>

namespace {

using namespace catoptric;

/// So dark that light between surfaces does not count.
constexpr float kDarkAlbedo = .02f;

std::shared_ptr<scene::Environment> make_grey_environment(float radiance) {
    auto grey = std::make_shared<scene::Environment>();
    grey->size = {16, 8};
    grey->texels.assign(16 * 8, vec3(radiance));
    return grey;
}

/// Returns a scene of a dark floor of 16 x 16 below a white environment.
scene::Scene make_floor_below_sky() {
    scene::Scene scene{.name = "floor"};
    const std::size_t dark = test::add_material(scene,
                                                {.name = "dark", .albedo = vec3(kDarkAlbedo)});
    test::add_quad(scene, "floor", dark, {-8, 0, 8}, {8, 0, 8}, {8, 0, -8}, {-8, 0, -8});
    scene.environment = make_grey_environment(1);
    return scene;
}

/// Returns the share of the environment that the floor shows without occlusion. It is 1 but for the
/// spherical harmonics of the environment, which are sums over few texels.
double measure_unoccluded_share() {
    scene::Scene scene = make_floor_below_sky();
    scene.cameras = {{.eye = {0, 3, .1}, .target = {0, 0, 0}}};
    const measure::Picture floor = test::render_without_ambient(scene, "reuse", uvec2(8), 1).hdr;
    return floor.pixels.front().y / kDarkAlbedo;
}

measure::Picture render_occluded(scene::Scene scene, const scene::Camera& camera, int edge,
                                 const char* technique = "reuse:ao=screen") {
    scene.cameras = {camera};
    return test::render_without_ambient(scene, technique, uvec2(edge), 1).hdr;
}

/// Calls `visit(place, share)` for each pixel that shows the floor at y = 0, with the point of the
/// floor and the visible share of the environment. The white environment is no floor.
template <typename Visit>
void visit_floor_pixels(const measure::Picture& picture, const scene::Camera& camera, int edge,
                        Visit&& visit) {
    const double whole = measure_unoccluded_share();
    for (int y = 0; y < edge; ++y)
        for (int x = 0; x < edge; ++x) {
            const dvec3 direction = test::camera_direction_of_pixel(camera, x, y, edge);
            const double green = picture.pixels[std::size_t(y) * edge + x].y;
            if (direction.y >= 0 || green > 2 * kDarkAlbedo) continue;
            visit(camera.eye - direction * (camera.eye.y / direction.y),
                  green / (kDarkAlbedo * whole));
        }
}

/// On a plane nothing hides the environment, at any angle of view, up to the edge of the picture.
TEST(AmbientOcclusion, PlaneSeesTheWholeEnvironmentAtAllAngles) {
    const double whole = measure_unoccluded_share();
    EXPECT_NEAR(whole, 1, .01);
    for (const double degrees : {3., 15., 45., 89.})
        for (const bool is_parallel : {false, true}) {
            const double angle = glm::radians(degrees);
            const scene::Camera camera{.eye = 6. * dvec3(std::cos(angle), std::sin(angle), .2),
                                       .target = {0, 0, 0},
                                       .orthographic_height = is_parallel ? 3. : 0.};
            int pixels = 0;
            for (const vec3& pixel : render_occluded(make_floor_below_sky(), camera, 48).pixels) {
                if (pixel.y > 2 * kDarkAlbedo) continue;
                ++pixels;
                EXPECT_NEAR(pixel.y / kDarkAlbedo, whole, 2e-3) << degrees << ' ' << is_parallel;
            }
            EXPECT_GT(pixels, 200) << degrees;
        }
}

/// At distance d from a long wall of height h, the visible share of the environment on the floor is
/// (1 + d / sqrt(d^2 + h^2)) / 2. The result must not depend on the camera or on the picture's
/// size.
TEST(AmbientOcclusion, FloorBesideAWallHasTheShareOfTheFormula) {
    constexpr double kHeight = .5; // surfaces count fully up to 1.4, a sixteenth of the diagonal
    scene::Scene scene = make_floor_below_sky();
    test::add_mesh(scene, scene::box("wall", {-.2, 0, -8}, {0, kHeight, 8}), 0);
    for (const scene::Camera& camera :
         {scene::Camera{.eye = {3, 2.5, 0}, .target = {.4, 0, 0}, .vertical_fov_degrees = 40},
          scene::Camera{.eye = {2.2, 3, 2}, .target = {.4, 0, 0}, .vertical_fov_degrees = 45}})
        for (const auto& [technique, edge, error] :
             {std::tuple{"reuse:ao=screen", 64, .043},
              {"reuse:ao=screen", 128, .043},
              {"reuse:ao=screen,indirect=captures", 64, .021}}) {
            double sum = 0, most = 0;
            int count = 0;
            visit_floor_pixels(
                render_occluded(scene, camera, edge, technique), camera, edge,
                [&](const dvec3& place, double share) {
                    if (place.x < .06 || place.x > 1.5 || std::abs(place.z) > .8) return;
                    const double off = share - .5 * (1 + place.x / std::hypot(place.x, kHeight));
                    sum += off, ++count;
                    most = std::max(most, std::abs(off));
                });
            ASSERT_GT(count, 100);
            std::cout << "[ MEASURED ] " << technique << ", " << edge << " pixels: mean error "
                      << sum / count << ", largest " << most << '\n';
            // Six steps miss the wall's upper edge. With 32 steps the mean is .015, the largest
            // .03. Light probes, 8 units apart, see little of the wall, which hides light twice.
            EXPECT_NEAR(sum / count, error, .01);
            EXPECT_LT(most, .1);
        }
}

/// Light probes see the wall from afar, so only the mean of the share over many places is known.
TEST(AmbientOcclusion, LightProbesGiveAFloorBesideAWallTheShareOfTheFormula) {
    constexpr double kHeight = 4;
    scene::Scene scene = make_floor_below_sky();
    test::add_mesh(scene, scene::box("wall", {-.2, 0, -8}, {0, kHeight, 8}), 0);
    const scene::Camera camera{.eye = {8, 7, 0}, .target = {3, 0, 0}, .vertical_fov_degrees = 40};
    double sum = 0, most = 0;
    int count = 0;
    visit_floor_pixels(render_occluded(scene, camera, 48, "reuse:ao=captures,probes=1000"), camera,
                       48, [&](const dvec3& place, double share) {
                           if (place.x < .3 || place.x > 6 || std::abs(place.z) > 1) return;
                           const double off = share -
                                              .5 * (1 + place.x / std::hypot(place.x, kHeight));
                           sum += off, ++count;
                           most = std::max(most, std::abs(off));
                       });
    ASSERT_GT(count, 100);
    std::cout << "[ MEASURED ] mean error " << sum / count << ", largest " << most << '\n';
    // Nine coefficients of spherical harmonics blur the wall's edge.
    EXPECT_NEAR(sum / count, .034, .01);
    EXPECT_LT(most, .08);
}

/// Without a wall nothing hides the environment, and in a closed box everything does.
TEST(AmbientOcclusion, LightProbesKnowOpenFloorsAndClosedBoxes) {
    scene::Scene scene = make_floor_below_sky();
    const scene::Camera camera{.eye = {1, 3, 1}, .target = {0, 0, 0}};
    const double whole = measure_unoccluded_share();
    for (const vec3& pixel : render_occluded(scene, camera, 12, "reuse:ao=captures").pixels)
        EXPECT_NEAR(pixel.y / kDarkAlbedo, whole, .03);
    test::add_mesh(scene, scene::box("box", {-9, -1, -9}, {9, 9, 9}), 0);
    for (const char* technique : {"reuse:ao=captures", "reuse:ao=captures,probes=27"})
        for (const vec3& pixel : render_occluded(scene, camera, 12, technique).pixels)
            EXPECT_LT(pixel.y / kDarkAlbedo, .01) << technique;
    // Walls without thickness: probes outside stand close behind the edges and corners of the room.
    scene::Scene room = make_floor_below_sky();
    room.objects.clear();
    room.meshes.clear();
    test::add_mesh(room, scene::box("room", {4, 3, 4}, {-4, 0, -4}), 0);
    for (const dvec3 target : {dvec3(-4, 3, 0), dvec3(-4, 3, -4), dvec3(0, 0, -4)})
        for (const char* technique : {"reuse:ao=captures", "reuse:indirect=captures"})
            for (const vec3& pixel :
                 render_occluded(room, {.eye = {1, 1.4, 1.2}, .target = target}, 24, technique)
                     .pixels)
                EXPECT_LT(pixel.y / kDarkAlbedo, .01) << technique << ' ' << target.x;
    scene.environment = nullptr; // ambient light is hidden by near surfaces only
    scene.cameras = {camera};
    session::Request asked = test::make_test_request(scene, {"reuse:ao=captures"}, {12, 12});
    asked.ambient = 1;
    double sum = 0;
    for (const vec3& pixel : session::run(test::get_test_engine(), asked).parts.front().hdr.pixels)
        sum += pixel.y / kDarkAlbedo / 144;
    EXPECT_GT(sum, .5);
    EXPECT_LT(sum, 1.001);
}

/// A dark square lamp with the edge 2 e hangs above a floor. At the distance h below the lamp's
/// middle, the share 1 - 4 / pi x atan x of the environment is visible, with
/// x = e / sqrt(h^2 + e^2). Lamps light as points, and still hide what lies behind them.
TEST(AmbientOcclusion, LampsHideTheEnvironmentFromLightProbes) {
    scene::Scene scene = make_floor_below_sky();
    const std::size_t lamp = test::add_material(
        scene, {.name = "dark lamp", .albedo = vec3(0), .emission = vec3(1e-6f)});
    constexpr double kHeight = 6, kHalfEdge = 8;
    test::add_mesh(
        scene,
        scene::box("lamp", {-kHalfEdge, kHeight, -kHalfEdge}, {kHalfEdge, kHeight + .1, kHalfEdge}),
        lamp);
    // The nearest light probes, of four layers, are .76 above the floor.
    const double x = kHalfEdge / std::hypot(kHeight - .76, kHalfEdge),
                 share = 1 - 4 / std::numbers::pi * x * std::atan(x);
    const scene::Camera camera{.eye = {.2, 2, .2}, .target = {0, 0, 0}, .vertical_fov_degrees = 10};
    for (const char* technique :
         {"reuse:ao=captures,probes=300", "reuse:indirect=captures,probes=300"}) {
        const measure::Picture floor = render_occluded(scene, camera, 4, technique);
        const double found = floor.pixels.front().y / kDarkAlbedo;
        std::cout << "[ MEASURED ] " << technique << ": " << found << " of " << share << '\n';
        EXPECT_NEAR(found, share, .03) << technique;
    }
}

/// A ball far in front of a wall hides no environment from the wall, so no halo lies around it.
TEST(AmbientOcclusion, FarForegroundMakesNoHalo) {
    scene::Scene scene = make_floor_below_sky(); // the floor is the wall behind, seen from above
    test::add_ball(scene, "ball", 0, {0, 5, 0}, .5);
    const scene::Camera camera{.eye = {.1, 9, 0}, .target = {0, 0, 0}, .up = {0, 0, 1}};
    int pixels = 0;
    for (const vec3& pixel : render_occluded(scene, camera, 64).pixels) {
        if (pixel.y > 2 * kDarkAlbedo) continue;
        ++pixels;
        EXPECT_NEAR(pixel.y / kDarkAlbedo, 1, .02);
    }
    EXPECT_EQ(pixels, 64 * 64);
}

/// Ambient light is hidden as the environment is, and the light of lamps is not.
TEST(AmbientOcclusion, HidesAmbientLightAndNoDirectLight) {
    scene::Scene scene = make_floor_below_sky();
    test::add_mesh(scene, scene::box("wall", {-.2, 0, -8}, {0, .5, 8}), 0);
    scene.cameras.push_back({.eye = {3, 2.5, 0}, .target = {.4, 0, 0}});
    const auto render = [&](const char* technique, double ambient) {
        session::Request asked = test::make_test_request(scene, {technique}, {32, 32});
        asked.ambient = ambient;
        return session::run(test::get_test_engine(), asked).parts.front().hdr;
    };
    const measure::Picture below_sky = render("reuse:ao=screen", 0);
    const measure::Picture whole = render("reuse", 0);
    scene.environment = nullptr;
    const measure::Picture in_ambient = render("reuse:ao=screen", 1);
    for (std::size_t i = 0; i < in_ambient.pixels.size(); ++i)
        if (below_sky.pixels[i].y < 2 * kDarkAlbedo) { // a surface
            EXPECT_NEAR(in_ambient.pixels[i].y,
                        below_sky.pixels[i].y * kDarkAlbedo / whole.pixels[i].y,
                        5e-3 * kDarkAlbedo);
        }
    scene.environment = make_grey_environment(0);
    scene::PunctualLight lamp{.name = "lamp", .intensity = vec3(50)};
    lamp.world_from_light[3] = dvec4(2, 3, 0, 1);
    scene.punctual.push_back(lamp);
    const measure::Picture lit = render("reuse", 0), occluded = render("reuse:ao=screen", 0);
    EXPECT_GT(lit.pixels[32 * 16 + 16].y, .01f);
    EXPECT_LT(test::rmse_of_pictures(lit, occluded), 1e-6);
}

/// Without a light that can be hidden, and without the knob, the picture keeps its bytes.
TEST(AmbientOcclusion, DefaultAndScenesWithoutEnvironmentKeepTheirBytes) {
    scene::Scene yard = test::make_yard_scene();
    yard.environment = test::make_smooth_environment();
    const uvec2 size{32, 24};
    const measure::Picture whole = test::render_without_ambient(yard, "secant", size).hdr;
    EXPECT_TRUE(test::have_equal_pixel_bytes(
        whole, test::render_without_ambient(yard, "secant:ao=none", size).hdr));
    EXPECT_FALSE(test::have_equal_pixel_bytes(
        whole, test::render_without_ambient(yard, "secant:ao=screen", size).hdr));
    yard.environment = nullptr;
    for (const char* technique : {"secant:ao=screen", "secant:ao=captures"})
        EXPECT_TRUE(
            test::have_equal_pixel_bytes(test::render_without_ambient(yard, "secant", size).hdr,
                                         test::render_without_ambient(yard, technique, size).hdr))
            << technique;
}

/// Light probes know themselves what hides the environment, and ao=screen adds what is near.
TEST(AmbientOcclusion, CapturesAreRefusedWithLightProbesAndPlansGetNotes) {
    scene::Scene room = test::make_lit_room(2, 1);
    scene::find_mirrors(room);
    test::expect_error(
        [&] {
            test::render_technique(room, "secant:indirect=captures,ao=captures", {8, 8});
        },
        Failure::usage,
        {"wanted ao=none or ao=screen beside indirect=captures", "found ao=captures"});
    for (const auto& [first, second, wanted] :
         {std::tuple{"indirect=captures", "ao=screen", "hide the light of light probes"},
          {"indirect=captures", "ao=captures", "ao=captures has no effect beside indirect"},
          {"ao=captures", "ao=screen", "ao=screen has no effect beside ao=captures"},
          {"ao=captures", "ao=screen,indirect=captures", "hide the light of light probes"}}) {
        const std::string plan = fmt::format("1=secant:{},face=16 *=secant:{},face=16", first,
                                             second);
        const session::TechniqueResult mixed = test::render_technique(room, plan, {8, 8});
        EXPECT_TRUE(std::ranges::any_of(mixed.notes, [&](const std::string& note) {
            return note.find(wanted) != std::string::npos;
        })) << wanted;
    }
}

/// A pixel that rays complete shows the same surface, and the same share of the environment.
TEST(AmbientOcclusion, TracedPixelsAreOccludedToo) {
    scene::Scene scene = make_floor_below_sky();
    const std::size_t glossy = test::add_material(
        scene, {.name = "glossy", .albedo = vec3(.3f), .mirror = true, .reflectance = vec3(.1f)});
    scene.objects.front().material = glossy;
    scene.objects.front().name = "glossy floor";
    test::add_mesh(scene, scene::box("wall", {-.2, 0, -8}, {0, .5, 8}), 0);
    scene::find_mirrors(scene);
    const scene::Camera camera{.eye = {3, 2.5, 0}, .target = {.4, 0, 0}};
    const auto render = [&](const char* technique) {
        return render_occluded(scene, camera, 32, technique);
    };
    const measure::Picture whole = render("hybrid:force=unknown");
    for (const std::string ao : {"ao=screen", "ao=captures", "ao=screen,indirect=captures"}) {
        const measure::Picture searched = render(("secant:" + ao).c_str()),
                               traced = render(("hybrid:force=unknown," + ao).c_str());
        const double near = test::rmse_of_pictures(searched, traced),
                     far = test::rmse_of_pictures(whole, traced);
        std::cout << "[ MEASURED ] " << ao << ": rmse to searched " << near
                  << ", without occlusion " << far << '\n';
        EXPECT_LT(near, .5 * far) << ao;
    }
}

} // namespace
