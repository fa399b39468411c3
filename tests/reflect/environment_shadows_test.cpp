// Tests of the environment's light with shadows (`--environment-shadows`) against formulas.
#include "compare.hpp"
#include "core/shader_math.hpp"
#include "measure/halves.hpp"
#include "measure/picture_mean.hpp"
#include "scene/classify.hpp"
#include "support/lit.hpp"
#include "support/special_values.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include <array>
#include <cmath>
#include <iostream>

namespace {

using namespace catoptric;

std::shared_ptr<scene::Environment> make_uniform_environment(float radiance) {
    auto sky = std::make_shared<scene::Environment>();
    sky->size = {16, 8};
    sky->texels.assign(16 * 8, vec3(radiance));
    return sky;
}

/// Returns a grey floor below a sky of radiance 1, with a camera that sees one point of the floor.
scene::Scene make_floor_with_environment_shadows(int rays) {
    scene::Scene scene{.name = "floor"};
    const std::size_t grey = test::add_material(scene, {.name = "grey", .albedo = vec3(.5f)});
    test::add_quad(scene, "floor", grey, {-9, 0, 9}, {9, 0, 9}, {9, 0, -9}, {-9, 0, -9});
    scene.environment = make_uniform_environment(1);
    scene.environment_shadows = rays;
    scene.cameras.push_back(
        {.eye = {1.5, .5, 0}, .target = {0, 0, 0}, .up = {0, 1, 0}, .vertical_fov_degrees = .1});
    return scene;
}

/// Adds a black board at height 1 above the origin, which hides a part of the sky.
void add_black_board(scene::Scene& scene) {
    const std::size_t black = test::add_material(scene, {.name = "black", .albedo = vec3(0)});
    test::add_quad(scene, "board", black, {-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1});
}

/// Mean of all pixels over pictures with different seeds, with its standard error.
struct MeanOverSeeds {
    double mean = 0, error = 0;
};
MeanOverSeeds measure_mean_over_seeds(const scene::Scene& scene, int seeds = 8) {
    double sum = 0, squares = 0;
    for (int seed = 1; seed <= seeds; ++seed) {
        const measure::Picture picture = test::render_without_ambient(
                                             scene, "raytrace:seed=" + std::to_string(seed), {8, 8})
                                             .hdr;
        const double mean = measure::mean_of(picture, measure::ValueRange::unclamped).all;
        sum += mean, squares += mean * mean;
    }
    const double mean = sum / seeds;
    return {mean, std::sqrt(std::max(squares / seeds - mean * mean, 0.) / (seeds - 1))};
}

/// Expects `wanted` within four standard errors, and a relative standard error below `most_error`.
void expect_mean_over_seeds(const scene::Scene& scene, double wanted, double most_error) {
    const MeanOverSeeds found = measure_mean_over_seeds(scene);
    std::cout << "[ MEASURED ] " << scene.environment_shadows << " rays: " << found.mean << " +- "
              << found.error << ", wanted " << wanted << '\n';
    EXPECT_NEAR(found.mean, wanted, 4 * found.error + 1e-4 * wanted);
    EXPECT_LT(found.error, most_error * wanted);
}

TEST(EnvironmentShadows, BlackBoardHidesItsFormFactor) {
    const double a = std::sqrt(2.), quarter = 2 / a * std::atan(1 / a) / (2 * test::kPi);
    for (const auto& [rays, most_error] : {std::pair(1, .08), {5, .03}, {64, .006}}) {
        scene::Scene scene = make_floor_with_environment_shadows(rays);
        add_black_board(scene);
        expect_mean_over_seeds(scene, .5 * (1 - 4 * quarter), most_error);
    }
}

/// Returns a dark sky with a sun of three by two texels, 40 degrees above the horizon.
std::shared_ptr<scene::Environment> make_sky_with_sun() {
    auto sky = std::make_shared<scene::Environment>();
    sky->size = {64, 32};
    sky->texels.assign(64 * 32, vec3(.2f));
    sky->rotation_degrees = 20;
    for (const std::uint32_t row : {8u, 9u})
        for (const std::uint32_t column : {40u, 41u, 42u})
            sky->texels[row * 64 + column] = vec3(500);
    return sky;
}

/// Returns the irradiance of an environment map on a surface that faces up, below nothing or below
/// the board of add_black_board.
double integrate_irradiance_from_above(const scene::Environment& sky, bool has_board) {
    constexpr int kSteps = 512;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i)
        for (int k = 0; k < 2 * kSteps; ++k) {
            const double polar = test::kPi / 2 * (i + .5) / kSteps,
                         azimuth = test::kPi * (k + .5) / kSteps;
            const dvec3 d(std::sin(polar) * std::sin(azimuth), std::cos(polar),
                          -std::sin(polar) * std::cos(azimuth));
            if (has_board && std::max(std::abs(d.x), std::abs(d.z)) <= d.y) continue;
            const f64::EnvironmentMapPosition at = f64::direction_to_environment_map(d, sky.size.x,
                                                                                     sky.size.y);
            const auto texel = [&](std::uint32_t column, std::uint32_t row) {
                return double(sky.texels[row * sky.size.x + column].x);
            };
            const double above = glm::mix(texel(at.left, at.above), texel(at.right, at.above),
                                          at.across),
                         below = glm::mix(texel(at.left, at.below), texel(at.right, at.below),
                                          at.across);
            sum += glm::mix(above, below, at.down) * std::cos(polar) * std::sin(polar);
        }
    return sum * (test::kPi / 2 / kSteps) * (test::kPi / kSteps);
}

/// The sun fills less than a thousandth of the sky and gives most of its light.
TEST(EnvironmentShadows, SmallSunConvergesWithFewRays) {
    scene::Scene scene = make_floor_with_environment_shadows(16);
    const std::shared_ptr<scene::Environment> sky = make_sky_with_sun();
    scene.environment = sky;
    const double irradiance = integrate_irradiance_from_above(*scene.environment, false);
    EXPECT_GT(irradiance, 5 * .2 * test::kPi);
    expect_mean_over_seeds(scene, .5 / test::kPi * irradiance, .03);
    sky->rotation_degrees = 0; // the integral with a board has no rotation
    add_black_board(scene);    // hides most of the sun
    const double left = integrate_irradiance_from_above(*scene.environment, true);
    EXPECT_LT(left, .6 * irradiance);
    expect_mean_over_seeds(scene, .5 / test::kPi * left, .06);
}

/// A floor below a sun hides nothing from the sun, but hides the lower half of the environment.
TEST(EnvironmentShadows, FloorBelowASunHidesTheEnvironmentFromAWall) {
    scene::Scene scene = make_floor_with_environment_shadows(64);
    scene.materials.front().albedo = vec3(0);
    const std::size_t grey = test::add_material(scene, {.name = "wall", .albedo = vec3(.5f)});
    test::add_quad(scene, "wall", grey, {0, 0, 1}, {0, 0, -1}, {0, 1, -1}, {0, 1, 1});
    scene::PunctualLight sun{.name = "sun", .kind = scene::PunctualLight::Kind::directional};
    sun.intensity = vec3(0, 0, 1e-6f);
    sun.world_from_light = glm::rotate(dmat4(1), -test::kPi / 2, dvec3(1, 0, 0)); // shines down
    scene.punctual.push_back(sun);
    scene.cameras.front() = {
        .eye = {1, .004, 0}, .target = {0, .004, 0}, .vertical_fov_degrees = .1};
    expect_mean_over_seeds(scene, .25, .03);
}

TEST(EnvironmentShadows, ConvexObjectAloneIsLitAsWithoutShadows) {
    scene::Scene scene{.name = "ball"};
    const std::size_t white = test::add_material(scene, {.name = "white", .albedo = vec3(1)});
    test::add_ball(scene, "ball", white, {0, 0, 0}, 1);
    scene.environment = make_uniform_environment(1);
    scene.cameras.push_back({.eye = {0, 0, 3}, .target = {0, 0, 0}, .vertical_fov_degrees = 20});
    const auto trace = [&](int rays) {
        scene.environment_shadows = rays;
        return test::render_without_ambient(scene, "raytrace:sphere=exact", {16, 16}).hdr;
    };
    const measure::Picture unshadowed = trace(0), shadowed = trace(8);
    for (std::size_t i = 0; i < shadowed.pixels.size(); ++i) {
        EXPECT_NEAR(shadowed.pixels[i].x, 1, 1e-5) << i;
        // The coefficients of the unshadowed light are sums over the few texels of the map.
        EXPECT_NEAR(shadowed.pixels[i].x, unshadowed.pixels[i].x, 6e-3) << i;
    }
}

/// Returns the root of the mean squared difference of two pictures.
double measure_picture_rms(const measure::Picture& a, const measure::Picture& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const vec3 difference = a.pixels[i] - b.pixels[i];
        sum += glm::dot(difference, difference);
    }
    return std::sqrt(sum / static_cast<double>(3 * a.pixels.size()));
}

TEST(EnvironmentShadows, NoiseFallsWithTheRootOfTheNumberOfSeeds) {
    const auto noise = [](int rays, int seeds) {
        scene::Scene scene = make_floor_with_environment_shadows(rays);
        add_black_board(scene);
        std::array<measure::PictureMean, 2> halves;
        for (int seed = 0; seed < 2 * seeds; ++seed)
            halves[seed % 2].add(test::render_without_ambient(
                                     scene, "raytrace:seed=" + std::to_string(seed), {24, 24})
                                     .hdr);
        return measure_picture_rms(halves[0].mean(), halves[1].mean());
    };
    const double one = noise(4, 1), mean_of_16 = noise(4, 16), more_rays = noise(16, 1);
    std::cout << "[ MEASURED ] noise of 4 rays " << one << ", of a mean of 16 seeds " << mean_of_16
              << ", of 16 rays " << more_rays << '\n';
    EXPECT_NEAR(one / mean_of_16, 4, .5);
    EXPECT_LT(more_rays, .6 * one) << "stratified directions converge at least as fast";
}

TEST(EnvironmentShadows, RasterisedAndPathTracedPicturesDoNotChange) {
    for (const std::string technique :
         {"naive:bounces=0", "raytrace:indirect=paths,depth=2", "raytrace:shadow=none"}) {
        const auto render = [&](int rays) {
            scene::Scene scene = make_floor_with_environment_shadows(rays);
            add_black_board(scene);
            return test::render_without_ambient(scene, technique, {8, 8}).hdr;
        };
        EXPECT_TRUE(test::have_equal_pixel_bytes(render(0), render(16))) << technique;
    }
}

TEST(EnvironmentShadows, ReferenceOfAComparisonHasHalvesAndAFloor) {
    scene::Scene scene = make_floor_with_environment_shadows(16);
    add_black_board(scene);
    const std::size_t mirror = test::add_material(scene, {.name = "mirror", .mirror = true});
    test::add_ball(scene, "ball", mirror, {0, .3, 0}, .3);
    scene.cameras.front() = {.eye = {1.5, .5, 0}, .target = {0, .3, 0}, .vertical_fov_degrees = 40};
    scene::find_mirrors(scene);
    study::CompareRequest request;
    request.base = test::make_test_request(scene, {"naive:face=16"}, {24, 24});
    request.base.ambient = 0;
    request.reference_seconds = 0;
    const measure::Comparison found = study::compare(test::get_test_engine(), request);
    ASSERT_TRUE(found.noise);
    EXPECT_EQ(found.reference_label, study::kReference);
    EXPECT_GT(found.noise->flip_floor, 0);
    EXPECT_EQ(found.noise->frames, 1);
}

} // namespace
