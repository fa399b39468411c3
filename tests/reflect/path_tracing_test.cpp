// Tests of path tracing (`indirect=paths`) against formulas for light between surfaces.
#include "core/error.hpp"
#include "scene/surroundings.hpp"
#include "support/numbers.hpp"
#include "support/rendering.hpp"
#include "support/special_values.hpp"

#include <cmath>
#include <functional>
#include <gmock/gmock.h>
#include <iostream>

namespace {

using namespace catoptric;

constexpr int kPathEdge = 8;
constexpr uvec2 kPathSize{kPathEdge, kPathEdge};

/// Mean of all pixels and channels, over pictures with different seeds, with the standard error of
/// this mean.
struct SeedMean {
    double mean = 0, error = 0;
};
SeedMean mean_of_seeds(const scene::Scene& scene, const std::string& technique, int seeds = 8) {
    double sum = 0, squares = 0;
    for (int seed = 1; seed <= seeds; ++seed) {
        const measure::Picture picture = test::render_technique(
                                             scene, technique + ",seed=" + std::to_string(seed),
                                             kPathSize)
                                             .hdr;
        const double mean = measure::mean_of(picture, measure::ValueRange::unclamped).all;
        sum += mean, squares += mean * mean;
    }
    const double mean = sum / seeds;
    return {mean, std::sqrt(std::max(squares / seeds - mean * mean, 0.) / (seeds - 1))};
}

/// Expects that the mean of pictures equals `wanted` within 4 standard errors plus the relative
/// error `slack`. The standard error must be below 1 % of `wanted`.
void expect_mean_radiance(const scene::Scene& scene, const std::string& technique, double wanted,
                          double slack = 1e-5) {
    const SeedMean found = mean_of_seeds(scene, technique);
    std::cout << "[ MEASURED ] " << technique << ": " << found.mean << " +- " << found.error
              << ", wanted " << wanted << '\n';
    EXPECT_NEAR(found.mean, wanted, 4 * found.error + slack * wanted) << technique;
    EXPECT_LT(found.error, .01 * wanted) << technique;
}

/// Returns a closed box whose walls all emit `emission` and reflect half of the light.
scene::Scene make_half_white_furnace(float emission) {
    scene::Scene scene{.name = "furnace"};
    const std::size_t wall = test::add_material(
        scene, {.name = "wall", .albedo = vec3(.5f), .emission = vec3(emission)});
    for (int face = 0; face < 6; ++face)
        test::add_mesh(scene, test::make_box_wall(face, {-4, -3, -5}, {4, 3, 5}), wall);
    scene.cameras.push_back(
        {.eye = {.2, .1, -4.5}, .target = {0, 0, 1}, .vertical_fov_degrees = 70});
    return scene;
}

TEST(PathTracing, FurnaceShowsTheGeometricSeriesOfItsReflections) {
    const scene::Scene furnace = make_half_white_furnace(.3f);
    for (const int depth : {0, 1, 2, 16}) {
        const double wanted = .3 * (2 - std::pow(.5, depth));
        for (const std::string lamps : {"sampled", "met"})
            expect_mean_radiance(furnace,
                                 "raytrace:indirect=paths,rays=64,lamps=" + lamps +
                                     ",depth=" + std::to_string(depth),
                                 wanted);
    }
}

/// A point light in the middle of a diffuse sphere lights all points of the sphere equally. So does
/// the light that the sphere reflects. The radiance of the sphere is E (1 + a + a^2 ...) a / pi,
/// for the irradiance E and the albedo a.
TEST(PathTracing, SphereAroundAPointLightReflectsEquallyEverywhere) {
    constexpr double kAlbedo = .6, kPunctualLightIntensity = 3, kRadius = 2;
    scene::Scene scene{.name = "sphere"};
    const std::size_t wall = test::add_material(scene,
                                                {.name = "wall", .albedo = vec3(float(kAlbedo))});
    scene::Mesh ball = scene::ball("ball", 5);
    for (dvec3& position : ball.positions) position *= kRadius;
    for (vec3& normal : ball.normals) normal = -normal;
    for (uvec3& triangle : ball.triangles) std::swap(triangle.x, triangle.y);
    test::add_mesh(scene, ball, wall);
    scene.punctual.push_back({.intensity = vec3(float(kPunctualLightIntensity))});
    scene.cameras.push_back({.eye = {.3, .2, -1}, .target = {0, 0, 1}, .vertical_fov_degrees = 60});
    const double direct = kAlbedo / test::kPi * kPunctualLightIntensity / (kRadius * kRadius);
    const SeedMean found = mean_of_seeds(scene, "raytrace:indirect=paths,rays=64,depth=40");
    // The mesh lies up to half a percent inside the sphere.
    EXPECT_NEAR(found.mean, direct / (1 - kAlbedo), .01 * direct / (1 - kAlbedo) + 4 * found.error);
}

/// Returns a floor below an environment of radiance 1 everywhere.
scene::Scene make_floor_below_white_sky(const scene::Material& material) {
    scene::Scene scene{.name = "floor"};
    scene.mirror_max_roughness = 1;
    const std::size_t floor = test::add_material(scene, material);
    test::add_quad(scene, "floor", floor, {-9, 0, 9}, {9, 0, 9}, {9, 0, -9}, {-9, 0, -9});
    auto sky = std::make_shared<scene::Environment>();
    sky->size = {16, 8};
    sky->texels.assign(16 * 8, vec3(1));
    scene.environment = std::move(sky);
    scene.cameras.push_back(
        {.eye = {0, 2, 1}, .target = {0, 0, 0}, .up = {0, 0, -1}, .vertical_fov_degrees = 40});
    return scene;
}

TEST(PathTracing, WhiteSurfacesBelowAWhiteSkyAreWhite) {
    for (const float roughness : {0.f, .2f, .5f, 1.f}) // plastic: a lobe or a mirror, and diffuse
        expect_mean_radiance(make_floor_below_white_sky({.name = "plastic",
                                                         .albedo = vec3(1),
                                                         .roughness = roughness,
                                                         .dielectric_f0 = vec3(.04f),
                                                         .dielectric_f90 = vec3(1)}),
                             "raytrace:indirect=paths,rays=256,depth=4", 1,
                             2e-4); // 2e-4: error of the table of lobe albedos
}

/// The walls of a closed box of white metal emit .3 and reflect all light. A path's weight changes
/// around 1, so a path that its chance to end makes too dark or too bright is noticed.
TEST(PathTracing, RoughWhiteMetalLosesNoLightInManyReflections) {
    constexpr int kDepth = 8;
    scene::Scene furnace = make_half_white_furnace(.3f);
    furnace.has_multiple_scattering = true;
    scene::Material& wall = furnace.materials.front();
    wall.albedo = vec3(1), wall.metallic = 1, wall.roughness = 1;
    expect_mean_radiance(furnace,
                         "raytrace:indirect=paths,rays=256,depth=" + std::to_string(kDepth),
                         .3 * (kDepth + 1), 2e-3); // 2e-3: error of the table of lobe albedos
}

/// Form factor of a square board of side 2 from a point 1 below its middle: the share of the
/// floor's light that would come from where the board is.
const double kShareOfSkyBehindBoard = 4 * std::sqrt(2.) * std::atan(std::sqrt(.5)) /
                                      (2 * test::kPi);

/// A black board above a floor hides a part of the sky. The form factor of the board gives the size
/// of this part.
TEST(PathTracing, ObjectsHideTheEnvironment) {
    scene::Scene scene = make_floor_below_white_sky({.name = "grey", .albedo = vec3(.5f)});
    const std::size_t black = test::add_material(scene, {.name = "black", .albedo = vec3(0)});
    test::add_quad(scene, "board", black, {-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1});
    scene.cameras.front() = {
        .eye = {1.5, .5, 0}, .target = {0, 0, 0}, .up = {0, 1, 0}, .vertical_fov_degrees = .1};
    expect_mean_radiance(scene, "raytrace:indirect=paths,rays=256,depth=3",
                         .5 * (1 - kShareOfSkyBehindBoard));
}

/// A lamp of two boards above a floor: the lower board hides the upper one, so only light from the
/// lower board arrives.
TEST(PathTracing, PartsOfALampHideEachOther) {
    scene::Scene scene = make_floor_below_white_sky({.name = "grey", .albedo = vec3(.5f)});
    scene.environment.reset();
    const std::size_t lamp = test::add_material(
        scene, {.name = "lamp", .albedo = vec3(0), .emission = vec3(1)});
    scene::Mesh boards{.name = "lamp"};
    for (const auto& [height, half] : {std::pair(1., 1.), std::pair(1.2, .5)}) {
        const auto first = static_cast<std::uint32_t>(boards.positions.size());
        for (const auto& [x, z] :
             {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)}) {
            boards.positions.push_back({x * half, height, z * half});
            boards.normals.push_back({0, -1, 0});
        }
        boards.triangles.push_back({first, first + 1, first + 2});
        boards.triangles.push_back({first, first + 2, first + 3});
    }
    test::add_mesh(scene, boards, lamp);
    scene.cameras.front() = {
        .eye = {1.5, .5, 0}, .target = {0, 0, 0}, .up = {0, 1, 0}, .vertical_fov_degrees = .1};
    for (const std::string lamps : {"sampled", "met"})
        expect_mean_radiance(scene, "raytrace:indirect=paths,rays=1024,depth=3,lamps=" + lamps,
                             .5 * kShareOfSkyBehindBoard);
}

/// Returns a room with a small lamp, a rough metal object, a plastic object and a mirror.
scene::Scene make_mixed_room() {
    scene::Scene scene = test::make_lit_room(1, 1);
    scene.mirror_max_roughness = 1;
    const std::size_t metal = test::add_material(scene, {.name = "metal",
                                                         .albedo = {.9f, .6f, .3f},
                                                         .metallic = 1,
                                                         .roughness = .3f}),
                      plastic = test::add_material(scene, {.name = "plastic",
                                                           .albedo = {.2f, .5f, .8f},
                                                           .roughness = .2f,
                                                           .dielectric_f0 = vec3(.04f),
                                                           .dielectric_f90 = vec3(1)});
    test::add_ball(scene, "metal ball", metal, {.4, -.9, .2}, .5);
    test::add_ball(scene, "plastic ball", plastic, {-.6, .2, .4}, .4);
    return scene;
}

TEST(PathTracing, LampsAreMetAsOftenAsTheyAreSampled) {
    const scene::Scene scene = make_mixed_room();
    const SeedMean sampled = mean_of_seeds(scene, "raytrace:indirect=paths,rays=256,depth=6", 12),
                   met = mean_of_seeds(scene, "raytrace:indirect=paths,rays=1024,depth=6,lamps=met",
                                       12);
    std::cout << "[ MEASURED ] sampled " << sampled.mean << " +- " << sampled.error << ", met "
              << met.mean << " +- " << met.error << '\n';
    EXPECT_NEAR(sampled.mean, met.mean, 4 * std::hypot(sampled.error, met.error));
    EXPECT_LT(sampled.error, .5 * met.error);
}

TEST(PathTracing, ErrorFallsWithTheRootOfTheNumberOfPaths) {
    const scene::Scene scene = make_mixed_room();
    const auto noise = [&](int rays) {
        double sum = 0;
        for (int pair = 0; pair < 4; ++pair) {
            std::vector<measure::Picture> pictures;
            for (const int seed : {2 * pair + 1, 2 * pair + 2})
                pictures.push_back(test::render_technique(scene,
                                                          "raytrace:indirect=paths,depth=6,rays=" +
                                                              std::to_string(rays) +
                                                              ",seed=" + std::to_string(seed),
                                                          {32, 24})
                                       .hdr);
            for (std::size_t i = 0; i < pictures[0].pixels.size(); ++i) {
                const vec3 difference = pictures[0].pixels[i] - pictures[1].pixels[i];
                sum += glm::dot(difference, difference);
            }
        }
        return std::sqrt(sum);
    };
    const double factor = noise(16) / noise(64);
    std::cout << "[ MEASURED ] noise falls by " << factor << " for four times the paths\n";
    EXPECT_NEAR(factor, 2, .15);
}

/// Light from coloured walls must reach the floor between them. Without path tracing, pictures lack
/// this light.
TEST(PathTracing, ColouredWallsTintTheFloorBetweenThem) {
    const scene::Scene scene = test::make_lit_room(0, 1);
    const SeedMean direct = mean_of_seeds(scene, "raytrace:indirect=paths,rays=64,depth=1"),
                   whole = mean_of_seeds(scene, "raytrace:indirect=paths,rays=64,depth=8");
    EXPECT_GT(whole.mean, 1.1 * direct.mean);
}

TEST(PathTracing, OnePathIsTracedWithoutANumberOfRays) {
    const scene::Scene scene = test::make_lit_room(1, 1);
    EXPECT_TRUE(test::have_equal_pixel_bytes(
        test::render_technique(scene, "raytrace:indirect=paths", kPathSize).hdr,
        test::render_technique(scene, "raytrace:indirect=paths,rays=1", kPathSize).hdr));
}

TEST(PathTracing, KnobsThatExcludePathsAreNamed) {
    const auto message_of = [](const std::string& technique) -> std::string {
        try {
            test::render_technique(test::make_lit_room(0, 1), technique, {4, 4});
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_THAT(message_of("raytrace:indirect=paths,rays=1,first=raster"),
                testing::HasSubstr("wanted first=ray, found first=raster"));
    EXPECT_THAT(message_of("raytrace:indirect=paths,rays=1,hit=f64"),
                testing::HasSubstr("wanted hit=f32, found hit=f64"));
}

} // namespace
