// Tests of the environment: what each direction shows, how it lights surfaces, and how captures and
// searches show it.
#include "core/shader_math.hpp"
#include "scene/surroundings.hpp"
#include "shared.h"
#include "support/lit.hpp"
#include "support/special_values.hpp"

#include <iostream>
#include <numbers>

namespace {

using namespace catoptric;

/// Returns an environment map in which each texel holds `radiance(direction)` for the direction of
/// its centre.
template <typename Radiance>
std::shared_ptr<scene::Environment> make_environment_map(uvec2 size, Radiance&& radiance) {
    auto map = std::make_shared<scene::Environment>();
    map->size = size;
    for (std::uint32_t row = 0; row < size.y; ++row)
        for (std::uint32_t column = 0; column < size.x; ++column) {
            const double polar = test::kPi * (row + .5) / size.y,
                         azimuth = 2 * test::kPi * ((column + .5) / size.x - .5);
            map->texels.push_back(
                vec3(radiance(dvec3(std::sin(polar) * std::sin(azimuth), std::cos(polar),
                                    -std::sin(polar) * std::cos(azimuth)))));
        }
    return map;
}

/// Returns a small environment map whose texels are all different.
std::shared_ptr<scene::Environment> make_patchwork_environment() {
    auto map = std::make_shared<scene::Environment>();
    map->size = {8, 4};
    for (int i = 0; i < 32; ++i)
        map->texels.push_back(
            {.02f * float(i), .9f - .1f * float(i % 8), .2f + .2f * float(i / 8)});
    return map;
}

/// Returns a scene that is empty except for a tiny quad below, which no camera of these tests sees.
/// The camera is at the origin and looks along `direction`.
scene::Scene
make_empty_scene_with_environment(std::shared_ptr<const scene::Environment> environment,
                                  const dvec3& direction) {
    scene::Scene scene{.name = "void"};
    const std::size_t black = test::add_material(scene, {.name = "black"});
    test::add_quad(scene, "speck", black, {-.1, -3, .1}, {.1, -3, .1}, {.1, -3, -.1},
                   {-.1, -3, -.1});
    scene.environment = std::move(environment);
    scene.cameras.push_back({.eye = {0, 0, 0},
                             .target = direction,
                             .up = std::abs(direction.y) < .9 ? dvec3(0, 1, 0) : dvec3(0, 0, 1),
                             .vertical_fov_degrees = 60});
    return scene;
}

TEST(Environment, RadianceFollowsTheMapAndItsRotation) {
    scene::Environment map = *make_patchwork_environment();
    const auto texel = [&](int column, int row) {
        return dvec3(map.texels[static_cast<std::size_t>(8 * row + column)]);
    };
    const auto expect = [&](const dvec3& direction, const dvec3& wanted) {
        EXPECT_LE(glm::length(scene::environment_radiance(map, direction) - wanted), 1e-6)
            << direction.x << ' ' << direction.y << ' ' << direction.z;
    };
    const auto level = [&](int left, int right) { // mean of two columns at the horizon
        return (texel(left, 1) + texel(right, 1) + texel(left, 2) + texel(right, 2)) / 4.0;
    };
    expect({0, 0, -1}, level(3, 4));
    expect({1, 0, 0}, level(5, 6));
    expect({-1, 0, 0}, level(1, 2));
    expect({0, 0, 1}, level(7, 0)); // across the seam between the last and first column
    expect({0, 1, 0}, (texel(3, 0) + texel(4, 0)) / 2.0);
    expect({0, -1, 0}, (texel(3, 3) + texel(4, 3)) / 2.0);
    // The centre of texel (6, 1): azimuth 112.5 degrees, elevation 22.5.
    const double turn = glm::radians(112.5), up = glm::radians(22.5);
    expect({std::cos(up) * std::sin(turn), std::sin(up), -std::cos(up) * std::cos(turn)},
           texel(6, 1));
    map.rotation_degrees = 90, map.scale = 2;
    expect({1, 0, 0}, 2.0 * level(3, 4)); // the rotation by 90 degrees moves -z to +x
    expect({0, 0, -1}, 2.0 * level(1, 2));
}

TEST(Environment, BackgroundEqualsTheEnvironmentInRasterAndRays) {
    constexpr int kEnvironmentPictureEdge = 24;
    for (const bool studio : {false, true})
        for (const double rotation : {0.0, 70.0}) {
            const auto environment = make_patchwork_environment();
            environment->studio = studio;
            environment->scale = 1.5, environment->rotation_degrees = rotation;
            for (const dvec3& ahead :
                 {dvec3(0, 0, -1), dvec3(1, .2, 0), dvec3(0, 1, 0), dvec3(-.5, .9, .8)}) {
                const scene::Scene scene = make_empty_scene_with_environment(environment, ahead);
                for (const std::string technique : {"raytrace", "naive"}) {
                    const measure::Picture picture =
                        test::render_technique(scene, technique,
                                               {kEnvironmentPictureEdge, kEnvironmentPictureEdge})
                            .hdr;
                    double worst = 0;
                    for (int y = 0; y < kEnvironmentPictureEdge; ++y)
                        for (int x = 0; x < kEnvironmentPictureEdge; ++x)
                            worst = std::max(worst, glm::length(dvec3(picture.at(x, y)) -
                                                                scene::environment_radiance(
                                                                    *environment,
                                                                    test::camera_direction_of_pixel(
                                                                        scene.cameras[0], x, y,
                                                                        kEnvironmentPictureEdge))));
                    EXPECT_LE(worst, 1e-3)
                        << technique << (studio ? ", studio, " : ", map, ") << rotation
                        << " degrees, ahead " << ahead.x << ' ' << ahead.y << ' ' << ahead.z;
                }
            }
        }
}

TEST(Studio, RadianceEqualsItsDescription) {
    const scene::Environment studio{.studio = true};
    const auto grey = [&](const dvec3& direction) {
        const dvec3 light = scene::environment_radiance(studio, glm::normalize(direction));
        EXPECT_EQ(light.x, light.y);
        EXPECT_EQ(light.x, light.z);
        return light.x;
    };
    EXPECT_NEAR(grey({0, 1, 0}), .9, 1e-9);
    EXPECT_NEAR(grey({1, 0, 0}), .6, 1e-9);
    EXPECT_NEAR(grey({0, -1, 0}), .25, 1e-9);
    EXPECT_NEAR(grey({0, -.6, .8}), .6 - .35 * .6, 1e-9);
    // The softbox is at azimuth -150 degrees: behind and to the left of a viewer who looks along
    // -z.
    const double turn = glm::radians(-150.0), up = glm::radians(50.0);
    const dvec3 box(std::cos(up) * std::sin(turn), std::sin(up), -std::cos(up) * std::cos(turn));
    EXPECT_LT(box.x, 0);
    EXPECT_GT(box.z, 0);
    const dvec3 right = glm::normalize(glm::cross(box, dvec3(0, 1, 0))),
                above = glm::cross(right, box);
    const auto beside = [&](double x, double y) {
        return glm::normalize(box + std::tan(glm::radians(x)) * right +
                              std::tan(glm::radians(y)) * above);
    };
    const auto wall = [](const dvec3& d) { return .6 + .3 * d.y; };
    for (const auto& [x, y, light] : {std::tuple{0., 0., 6.},
                                      {17.9, 10.4, 6.},
                                      {20., 0., 3.},
                                      {-20., 0., 3.},
                                      {0., 12.5, 3.},
                                      {0., -12.5, 3.},
                                      {22.1, 0., 0.},
                                      {0., -14.6, 0.},
                                      {19., 11.5, 6 * .84375 * .84375}}) {
        const dvec3 d = beside(x, y);
        EXPECT_NEAR(grey(d), wall(d) + light, 1e-6) << x << ' ' << y;
    }
    EXPECT_NEAR(grey(-box), .6 - .35 * box.y, 1e-9) << "not on the other side";
}

/// Returns the irradiance of a surface with normal `n`.
dvec3 irradiance_by_quadrature(const scene::Environment& environment, const dvec3& n) {
    std::array<dvec3, 9> of = scene::irradiance_coefficients(environment);
    return f64::irradiance_from_harmonics(of.data(), n);
}

TEST(Irradiance, CoefficientsGiveTheIrradianceOfKnownEnvironments) {
    const dvec3 b = glm::normalize(dvec3(.3, .5, -.8));
    const uvec2 size{256, 128};
    const auto uniform = make_environment_map(size, [](const dvec3&) { return dvec3(.5, 1, 2); });
    const auto linear = make_environment_map(size,
                                             [&](const dvec3& d) { return dvec3(1 + dot(d, b)); });
    const auto square = make_environment_map(
        size, [&](const dvec3& d) { return dvec3(dot(d, b) * dot(d, b)); });
    const auto lobe = make_environment_map(
        size, [&](const dvec3& d) { return dvec3(std::max(0., dot(d, b))); });
    for (const dvec3& n :
         {dvec3(0, 1, 0), dvec3(1, 0, 0), dvec3(0, 0, 1), dvec3(0, -.6, -.8), b, -b}) {
        const double c = dot(n, b), p2 = (3 * c * c - 1) / 2;
        EXPECT_NEAR(irradiance_by_quadrature(*uniform, n).x, test::kPi * .5, 5e-4);
        EXPECT_NEAR(irradiance_by_quadrature(*uniform, n).z, test::kPi * 2, 1e-3);
        EXPECT_NEAR(irradiance_by_quadrature(*linear, n).x, test::kPi + 2 * test::kPi / 3 * c,
                    1e-3);
        EXPECT_NEAR(irradiance_by_quadrature(*square, n).x, test::kPi / 3 + test::kPi / 6 * p2,
                    1e-3);
        // Nine coefficients keep the first three bands of a cosine lobe, with the factors 1/4, 1/2
        // and 5/16.
        EXPECT_NEAR(irradiance_by_quadrature(*lobe, n).x,
                    std::max(0., test::kPi / 4 + test::kPi / 3 * c + 5 * test::kPi / 64 * p2),
                    1e-3);
    }
    scene::Environment turned = *linear;
    turned.rotation_degrees = 90, turned.scale = 3;
    const dvec3 moved(-b.z, b.y, b.x); // the lobe's direction, rotated so that -z becomes +x
    const dvec3 n = glm::normalize(dvec3(.2, .4, .6));
    EXPECT_NEAR(irradiance_by_quadrature(turned, n).x,
                3 * (test::kPi + 2 * test::kPi / 3 * dot(n, moved)), 3e-3);
}

TEST(Irradiance, DiffuseSurfacesAreLitAlikeInRasterAndRays) {
    const auto environment = make_environment_map({64, 32}, [](const dvec3& d) {
        return dvec3(1 + .8 * d.x, .7 + .5 * d.y * d.z, std::max(0., d.z));
    });
    environment->rotation_degrees = 35, environment->scale = .7;
    for (const dvec3& n : {dvec3(0, 1, 0), dvec3(1, 0, 0), glm::normalize(dvec3(-1, -.5, .7))}) {
        const dvec3 across = glm::normalize(glm::cross(dvec3(.1, .2, 1), n)),
                    up = glm::cross(n, across);
        scene::Scene scene{.name = "board"};
        const std::size_t grey = test::add_material(scene,
                                                    {.name = "grey", .albedo = {.6f, .5f, .4f}});
        test::add_quad(scene, "board", grey, -across - up, across - up, across + up, -across + up);
        scene.environment = environment;
        scene.cameras.push_back(
            {.eye = 2.0 * n, .target = {0, 0, 0}, .up = up, .vertical_fov_degrees = 40});
        const dvec3 wanted = dvec3(.6, .5, .4) / test::kPi *
                             irradiance_by_quadrature(*environment, n);
        for (const std::string technique : {"raytrace", "naive"}) {
            const measure::Picture picture =
                test::render_without_ambient(scene, technique, {8, 8}).hdr;
            for (const vec3& pixel : picture.pixels)
                EXPECT_LE(glm::length(dvec3(pixel) - wanted), 1e-3 * glm::length(wanted))
                    << technique;
        }
    }
}

/// Returns the share of the mirrors' pixels in which a technique differs from the ray-traced
/// picture by more than .02.
double share_of_mirror_pixels_off(const scene::Scene& scene, const std::string& technique) {
    constexpr uvec2 kEnvironmentPictureSize{96, 96};
    const session::TechniqueResult truth = test::render_technique(scene, "raytrace",
                                                                  kEnvironmentPictureSize),
                                   part = test::render_technique(scene, technique,
                                                                 kEnvironmentPictureSize, 3);
    std::size_t off = 0, all = 0;
    for (std::size_t i = 0; i < truth.hits.size(); ++i) {
        if (!measure::first_mirror(truth.hits[i])) continue;
        ++all;
        off += test::max_channel_difference(part.hdr.pixels[i], truth.hdr.pixels[i]) >
               float(measure::kMaxInvisibleDifference);
    }
    EXPECT_GT(all, 300u);
    return double(off) / double(all);
}

std::shared_ptr<scene::Environment> make_dusk_environment() {
    return make_environment_map({64, 32}, [](const dvec3& d) {
        return dvec3(.4 + .3 * d.x, .5 + .4 * d.y, .5 - .3 * d.z * d.x);
    });
}

/// If a mirror is alone in its environment, every technique must show the environment as ray
/// tracing does.
TEST(Environment, MirrorsShowTheEnvironmentInEveryTechnique) {
    scene::Scene scene{.name = "alone"};
    test::add_ball(scene, "ball", test::add_material(scene, {.name = "mirror", .mirror = true}),
                   {0, 0, 0}, 1);
    scene.environment = make_dusk_environment();
    scene.cameras.push_back({.eye = {0, .5, 3}, .target = {0, 0, 0}, .vertical_fov_degrees = 45});
    for (const session::TechniqueInfo& technique : session::techniques())
        EXPECT_LE(share_of_mirror_pixels_off(scene, technique.name), .002) << technique.name;
}

/// Returns the test scene `make_yard_scene` with an evening environment, a point light and a
/// directional light.
scene::Scene make_yard_at_dusk() {
    scene::Scene scene = test::make_yard_scene();
    scene.environment = make_dusk_environment();
    scene.punctual.push_back(
        {.intensity = vec3(4),
         .world_from_light = test::make_light_transform({1, 2, 2}, {0, 0, -1})});
    scene.punctual.push_back(
        {.kind = scene::PunctualLight::Kind::directional,
         .intensity = vec3(1),
         .world_from_light = test::make_light_transform({0, 0, 0}, {-.5, -1, -.4})});
    return scene;
}

TEST(Environment, RasterisationEqualsRayTracing) {
    const double off = test::share_off_in_raster_picture(make_yard_at_dusk(), {128, 128});
    std::cout << "[ MEASURED ] share off " << off << "\n";
    EXPECT_LE(off, .005);
}

/// A search whose ray leaves the captured surfaces looks up the environment. Techniques without a
/// search read the environment from the capture's texels and are less exact.
TEST(Environment, MirrorsShowObjectsBeforeTheEnvironment) {
    scene::Scene scene = make_yard_at_dusk();
    scene.objects[2].material = test::add_material(scene, {.name = "mirror", .mirror = true});
    for (const auto& [technique, most] : {std::pair{"hybrid", .01},
                                          {"layered", .01},
                                          {"secant", .01},
                                          {"march", .01},
                                          {"pyramid", .01},
                                          {"parallax", .2},
                                          {"reuse", .4},
                                          {"proxy", .05}}) {
        const double off = share_of_mirror_pixels_off(scene, technique);
        std::cout << "[ MEASURED ] " << technique << ": off " << off << "\n";
        EXPECT_LE(off, most) << technique;
    }
}

/// With every cause of error removed, a mirror must show what ray tracing shows, including the
/// environment.
TEST(Environment, RemovedCausesOfErrorLeaveTheEnvironmentRight) {
    scene::Scene scene = make_yard_at_dusk();
    scene.objects[2].material = test::add_material(scene, {.name = "mirror", .mirror = true});
    session::Request asked = test::make_test_request(scene, {"parallax"}, {64, 64});
    const session::TechniqueResult truth = test::render_technique(scene, "raytrace", {64, 64});
    session::Session session(test::get_test_engine(), scene);
    session::FrameSpec spec = asked;
    session.frame(spec);
    const std::uint32_t causes = shared::kAblateDistance | shared::kAblateDirection |
                                 shared::kAblateHiddenPoints | shared::kAblateTexelColour |
                                 shared::kAblateMirrorReflections | shared::kAblateSelfReflection |
                                 shared::kAblateShadows;
    const measure::Picture ablated =
        session::Access::render_frame(session, spec, {.ablated = causes}).read().hdr;
    std::size_t off = 0, all = 0;
    for (std::size_t i = 0; i < truth.hits.size(); ++i) {
        if (!measure::first_mirror(truth.hits[i])) continue;
        ++all, off += test::max_channel_difference(ablated.pixels[i], truth.hdr.pixels[i]) >
                      float(measure::kMaxInvisibleDifference);
    }
    std::cout << "[ MEASURED ] off " << off << " of " << all << "\n";
    EXPECT_LE(double(off), .01 * double(all));
}

} // namespace
