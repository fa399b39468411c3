// Tests of rays from rough surfaces (`raytrace:rays=N`). The expected value is an integral over the
// lobe in double precision (support/lobe_witness.hpp).
#include "scene/build.hpp"
#include "scene/classify.hpp"
#include "scene/surroundings.hpp"
#include "support/drawn_hall.hpp"
#include "support/lobe_witness.hpp"
#include "support/numbers.hpp"
#include "support/refusal.hpp"
#include "support/rendering.hpp"
#include "support/smooth_environment.hpp"

#include <gmock/gmock.h>

#include <array>
#include <iostream>

namespace {

using namespace catoptric;

constexpr int kRoughPictureEdge = 16;
constexpr uvec2 kRoughPictureSize{kRoughPictureEdge, kRoughPictureEdge};

/// Returns a metal floor of this roughness below an environment, seen at a slant.
scene::Scene make_rough_floor(float roughness, std::shared_ptr<const scene::Environment> sky) {
    scene::Scene scene{.name = "floor"};
    scene.mirror_max_roughness = 1;
    const std::size_t metal = test::add_material(
        scene,
        {.name = "metal", .albedo = vec3(.9f, .6f, .3f), .metallic = 1, .roughness = roughness});
    test::add_quad(scene, "floor", metal, {-50, 0, 50}, {50, 0, 50}, {50, 0, -50}, {-50, 0, -50});
    scene.environment = std::move(sky);
    scene.cameras.push_back(
        {.eye = {0, 2, 6}, .target = {0, 0, 0}, .up = {0, 1, 0}, .vertical_fov_degrees = 40});
    return scene;
}

/// Returns the expected radiance of a pixel of the floor, by quadrature over the lobe. In tangent
/// space of the floor, z points up.
dvec3 expected_floor_radiance(const scene::Scene& scene, double roughness, int x, int y) {
    const dvec3 direction = test::camera_direction_of_pixel(scene.cameras.front(), x, y,
                                                            kRoughPictureEdge);
    const dvec3 to_eye(-direction.x, direction.z, -direction.y), f0(.9, .6, .3);
    dvec3 sum(0);
    for (int channel = 0; channel < 3; ++channel)
        sum[channel] = test::integrate_over_half_vectors(roughness, to_eye, [&](const dvec3& i) {
            if (i.z <= 0) return 0.0;
            const double away = 1 - glm::dot(to_eye, glm::normalize(to_eye + i));
            const double fresnel = f0[channel] + (1 - f0[channel]) * std::pow(away, 5);
            const dvec3 light = scene::environment_radiance(*scene.environment, {i.x, i.z, -i.y});
            return fresnel * light[channel] * test::textbook_lobe_reflectance(roughness, to_eye, i);
        });
    return sum;
}

measure::Picture trace_rough_rays_with_seed(const scene::Scene& scene, const std::string& technique,
                                            std::uint64_t seed) {
    session::Request asked = test::make_test_request(scene, {technique}, kRoughPictureSize);
    asked.seed = seed;
    return session::run(test::get_test_engine(), asked).parts.front().hdr;
}

/// Pixels differ from the integral by more than their own error bars only as often as chance
/// allows.
TEST(RoughRays, RadianceIsTheIntegralOverTheLobe) {
    constexpr int kSeedCount = 8;
    for (const float roughness : {.1f, .3f, .6f}) {
        const scene::Scene scene = make_rough_floor(roughness, test::make_smooth_environment());
        std::vector<measure::Picture> pictures;
        for (int seed = 1; seed <= kSeedCount; ++seed)
            pictures.push_back(trace_rough_rays_with_seed(scene, "raytrace:rays=128,depth=2",
                                                          static_cast<std::uint64_t>(seed)));
        int compared = 0, apart = 0;
        double largest = 0;
        test::RandomNumbers numbers(5);
        for (int k = 0; k < 12; ++k) {
            const int x = int(numbers.random_integer_below(kRoughPictureEdge)),
                      y = 6 + int(numbers.random_integer_below(10));
            const dvec3 wanted = expected_floor_radiance(scene, roughness, x, y);
            for (int channel = 0; channel < 3; ++channel) {
                double mean = 0, squares = 0;
                for (const measure::Picture& picture : pictures) {
                    const double value = picture.at(x, y)[channel];
                    mean += value / kSeedCount, squares += value * value / kSeedCount;
                }
                const double error = std::sqrt(std::max(squares - mean * mean, 0.) /
                                               (kSeedCount - 1));
                ++compared;
                apart += std::abs(mean - wanted[channel]) > 4 * error + 1e-3;
                largest = std::max(largest, std::abs(mean - wanted[channel]));
            }
        }
        std::cout << "[ MEASURED ] roughness " << roughness << ": " << apart << " of " << compared
                  << " apart, largest difference " << largest << '\n';
        EXPECT_LE(apart, 1) << roughness;
        EXPECT_LT(largest, .02) << roughness;
    }
}

TEST(RoughRays, ErrorFallsWithTheNumberOfRays) {
    const scene::Scene scene = make_rough_floor(.4f, test::make_smooth_environment());
    const auto error = [&](const std::string& rays) {
        return test::rmse_of_pictures(
            trace_rough_rays_with_seed(scene, "raytrace:rays=" + rays, 1),
            trace_rough_rays_with_seed(scene, "raytrace:rays=" + rays, 2));
    };
    const double few = error("4"), many = error("64");
    std::cout << "[ MEASURED ] difference of two seeds: " << few << " with 4 rays, " << many
              << " with 64\n";
    EXPECT_LT(many, few / 3); // 16 times as many independent rays reduce the error by 4
    EXPECT_GT(few, 0);
}

TEST(RoughRays, SmoothSurfacesAreAsWithoutRays) {
    for (const char* name : {"cornell-mirrors", "gallery"}) {
        const scene::Scene scene = scene::load(name);
        EXPECT_EQ(test::render_technique(scene, "raytrace:rays=1", {48, 48}).hdr.pixels,
                  test::render_technique(scene, "raytrace", {48, 48}).hdr.pixels)
            << name;
    }
    // Up to the sharp limit, a surface is a perfect mirror.
    const scene::Scene polished = make_rough_floor(.04f, test::make_smooth_environment()),
                       rough = make_rough_floor(.06f, test::make_smooth_environment());
    EXPECT_EQ(trace_rough_rays_with_seed(polished, "raytrace:rays=1", 1).pixels,
              trace_rough_rays_with_seed(polished, "raytrace", 1).pixels);
    EXPECT_NE(trace_rough_rays_with_seed(rough, "raytrace:rays=1", 1).pixels,
              trace_rough_rays_with_seed(rough, "raytrace", 1).pixels);
}

TEST(RoughRays, PictureIsAFunctionOfItsSeed) {
    const scene::Scene scene = make_rough_floor(.5f, test::make_smooth_environment());
    EXPECT_EQ(trace_rough_rays_with_seed(scene, "raytrace:rays=3", 7).pixels,
              trace_rough_rays_with_seed(scene, "raytrace:rays=3", 7).pixels);
    EXPECT_NE(trace_rough_rays_with_seed(scene, "raytrace:rays=3", 7).pixels,
              trace_rough_rays_with_seed(scene, "raytrace:rays=3", 8).pixels);
}

/// In a closed white furnace, rough balls must not be brighter than perfect mirrors. They are
/// darker, because a lobe with single scattering loses light.
TEST(RoughRays, RoughMirrorsInAFurnaceGainNoLight) {
    scene::Scene furnace = test::make_furnace_scene(2);
    for (scene::Material& material : furnace.materials)
        if (material.mirror) {
            material.mirror = false;
            material.albedo = vec3(1), material.metallic = 1, material.roughness = .5f;
        }
    scene::find_mirrors(furnace); // the metal balls; the walls are Lambertian
    const measure::Picture sharp =
        test::render_technique(furnace, "raytrace:depth=16", {32, 32}).hdr;
    const measure::Picture rough =
        test::render_technique(furnace, "raytrace:depth=16,rays=64", {32, 32}).hdr;
    double most = 0, sharp_sum = 0, rough_sum = 0;
    for (std::size_t i = 0; i < sharp.pixels.size(); ++i) {
        most = std::max(most, double(rough.pixels[i].x));
        sharp_sum += sharp.pixels[i].x, rough_sum += rough.pixels[i].x;
    }
    std::cout << "[ MEASURED ] furnace: brightest " << most << ", mean "
              << rough_sum / double(rough.pixels.size()) << " instead of "
              << sharp_sum / double(sharp.pixels.size()) << '\n';
    EXPECT_NEAR(sharp_sum / double(sharp.pixels.size()), test::kFurnaceWallRadiance.x, 1e-6);
    EXPECT_LE(most,
              test::kFurnaceWallRadiance.x * 1.001); // a lobe that gained light would be brighter
    EXPECT_LT(rough_sum, sharp_sum);
    EXPECT_GT(rough_sum, .8 * sharp_sum);
}

/// Returns a hall of rough metal with two lamps that rays of a lobe seldom hit: a small quad, and a
/// distant large ball of another colour. A board hides the small lamp from a part of the floor.
scene::Scene make_hall_with_small_lamps() {
    scene::Scene scene{.name = "hall"};
    scene.mirror_max_roughness = 1;
    const auto metal = [&](const char* name, float roughness, vec3 colour) {
        return test::add_material(
            scene, {.name = name, .albedo = colour, .metallic = 1, .roughness = roughness});
    };
    const auto lamp = [&](const char* name, vec3 emission) {
        return test::add_material(scene, {.name = name, .emission = emission, .two_sided = true});
    };
    test::add_quad(scene, "floor", metal("floor metal", .4f, {.9f, .6f, .3f}), {-5, 0, 5},
                   {5, 0, 5}, {5, 0, -5}, {-5, 0, -5});
    test::add_quad(scene, "wall", metal("wall metal", .25f, {.5f, .7f, .9f}), {-5, 0, -5},
                   {5, 0, -5}, {5, 4, -5}, {-5, 4, -5});
    test::add_quad(scene, "small lamp", lamp("small", {40, 30, 20}), {.2, 2, -.9}, {.6, 2, -.9},
                   {.6, 2, -1.3}, {.2, 2, -1.3});
    test::add_ball(scene, "ball lamp", lamp("ball", {1, 2, 3}), {-2, 1, -3}, .4);
    test::add_quad(scene, "board", metal("board metal", .5f, vec3(.8f)), {.4, 1.2, -1},
                   {.8, 1.2, -1}, {.8, 1.2, -1.4}, {.4, 1.2, -1.4});
    scene::find_mirrors(scene);
    scene.cameras.push_back(
        {.eye = {0, 2, 5}, .target = {0, .5, -2}, .up = {0, 1, 0}, .vertical_fov_degrees = 50});
    return scene;
}

/// Rays that aim at lamps must not change the mean of each block of pixels, and must reduce the
/// noise.
TEST(RoughRays, SampledLampsKeepTheMeanAndLowerTheNoise) {
    const scene::Scene scene = make_hall_with_small_lamps();
    constexpr int kSeedCount = 12, kBlock = 4, kBlocks = kRoughPictureEdge / kBlock;
    /// Sums of a block's red value, and of its square, over all seeds.
    struct PixelBlockSums {
        double values = 0, squares = 0;
        double mean_of_pixel_block() const { return values / kSeedCount; }
        double variance_of_pixel_block() const {
            return std::max(squares / kSeedCount - mean_of_pixel_block() * mean_of_pixel_block(),
                            0.) /
                   (kSeedCount - 1);
        }
    };
    const auto trace = [&](const std::string& technique) {
        std::array<PixelBlockSums, kBlocks * kBlocks> blocks;
        for (int seed = 1; seed <= kSeedCount; ++seed) {
            const measure::Picture picture = trace_rough_rays_with_seed(
                scene, technique, static_cast<std::uint64_t>(seed));
            for (int block = 0; block < kBlocks * kBlocks; ++block) {
                double red = 0;
                for (int i = 0; i < kBlock * kBlock; ++i)
                    red += picture
                               .at(block % kBlocks * kBlock + i % kBlock,
                                   block / kBlocks * kBlock + i / kBlock)
                               .x;
                blocks[std::size_t(block)].values += red;
                blocks[std::size_t(block)].squares += red * red;
            }
        }
        return blocks;
    };
    const auto sampled = trace("raytrace:rays=64,depth=3"),
               met = trace("raytrace:rays=512,depth=3,lamps=met");
    double most = 0, sampled_variance = 0, met_variance = 0;
    for (std::size_t i = 0; i < sampled.size(); ++i) {
        const double apart = std::abs(sampled[i].mean_of_pixel_block() -
                                      met[i].mean_of_pixel_block());
        most = std::max(most, apart / std::sqrt(sampled[i].variance_of_pixel_block() +
                                                met[i].variance_of_pixel_block() + 1e-12));
        sampled_variance += sampled[i].variance_of_pixel_block(),
            met_variance += met[i].variance_of_pixel_block();
        EXPECT_GT(met[i].mean_of_pixel_block(), 0) << i;
    }
    std::cout << "[ MEASURED ] blocks at most " << most << " standard errors apart; variance "
              << sampled_variance << " with 64 sampled rays, " << met_variance
              << " with 512 that meet lamps by chance\n";
    EXPECT_LE(most, 5); // 16 blocks of Student's distribution with few seeds
    EXPECT_LT(sampled_variance, met_variance);
}

TEST(RoughRays, TooManyRaysAreRefused) {
    EXPECT_THAT(test::catch_error_text(Failure::usage,
                                       [] {
                                           test::render_technique(scene::load("flat"),
                                                                  "raytrace:rays=1000,samples=100",
                                                                  kRoughPictureSize);
                                       }),
                testing::HasSubstr("rays=1000 for each of samples=100: wanted at most 65536 in "
                                   "all"));
}

} // namespace
