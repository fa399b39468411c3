// Tests pixels of raytrace:rays=N against an integral in double precision: brute-force quadrature
// over the half vectors of the lobe. Hits of rays with the wall are computed by a formula.
#include "scene/build.hpp"
#include "scene/surroundings.hpp"
#include "support/lobe_witness.hpp"
#include "support/numbers.hpp"
#include "support/rendering.hpp"
#include "support/smooth_environment.hpp"
#include "support/special_values.hpp"

#include <iostream>
#include <set>

namespace {

using namespace catoptric;

constexpr int kIntegralPictureEdge = 10;
constexpr double kGlowingWallZ = -4,
                 kGlowingWallHeight = 5; ///< the wall covers |x| <= kGlowingWallHeight and 0 <= y
                                         ///< <= kGlowingWallHeight

enum class WallPresence { none, glowing, mirror };

/// A scene of a floor at y = 0 below an environment, with or without a wall behind the floor.
struct IntegralScene {
    const char* name;
    dvec3 colour;
    double metallic, roughness;
    WallPresence wall;
    dvec3 compute_scene_f0() const { return glm::mix(dvec3(.04), colour, metallic); }
};
constexpr dvec3 kWallGlowColour{2, 1, .5};
constexpr double kWallReflectance = .8;

scene::Scene make_integral_scene(const IntegralScene& wanted) {
    scene::Scene scene{.name = wanted.name};
    scene.mirror_max_roughness = 1;
    const std::size_t floor = test::add_material(scene,
                                                 {.name = "floor",
                                                  .albedo = vec3(wanted.colour),
                                                  .metallic = static_cast<float>(wanted.metallic),
                                                  .roughness = static_cast<float>(wanted.roughness),
                                                  .dielectric_f0 = vec3(.04f),
                                                  .dielectric_f90 = vec3(1)});
    test::add_quad(scene, "floor", floor, {-50, 0, 50}, {50, 0, 50}, {50, 0, -50}, {-50, 0, -50});
    if (wanted.wall != WallPresence::none) {
        scene::Material material{.name = "wall", .two_sided = true};
        if (wanted.wall == WallPresence::glowing) // the wall is visible, but does not light diffuse
                                                  // surfaces
            material.emission = vec3(kWallGlowColour), material.light = vec3(0);
        else
            material.mirror = true, material.reflectance = vec3(float(kWallReflectance));
        test::add_quad(scene, "wall", test::add_material(scene, material),
                       {-kGlowingWallHeight, 0, kGlowingWallZ},
                       {kGlowingWallHeight, 0, kGlowingWallZ},
                       {kGlowingWallHeight, kGlowingWallHeight, kGlowingWallZ},
                       {-kGlowingWallHeight, kGlowingWallHeight, kGlowingWallZ});
    }
    scene.environment = test::make_smooth_environment();
    scene.cameras.push_back(
        {.eye = {.5, 2, 4}, .target = {0, 0, -1}, .up = {0, 1, 0}, .vertical_fov_degrees = 40});
    return scene;
}

/// Returns the radiance that arrives at a point of the floor from a direction.
dvec3 radiance_arriving_at_floor(const scene::Scene& scene, const IntegralScene& wanted,
                                 const dvec3& from, dvec3 along) {
    double weight = 1;
    if (wanted.wall != WallPresence::none && along.z < 0) {
        const dvec3 met = from + (kGlowingWallZ - from.z) / along.z * along;
        if (std::abs(met.x) <= kGlowingWallHeight && met.y <= kGlowingWallHeight) {
            if (wanted.wall == WallPresence::glowing) return kWallGlowColour;
            along.z = -along.z, weight = kWallReflectance;
        }
    }
    return weight * scene::environment_radiance(*scene.environment, along);
}

/// Returns the expected radiance of a pixel that shows the floor; nothing if the camera ray meets
/// the wall.
std::optional<dvec3> integrate_floor_pixel(const scene::Scene& scene, const IntegralScene& wanted,
                                           int x, int y, const dvec3& irradiance) {
    constexpr int kPolarSteps = 400, kAzimuthSteps = 300;
    const dvec3 eye = scene.cameras.front().eye,
                ray = test::camera_direction_of_pixel(scene.cameras.front(), x, y,
                                                      kIntegralPictureEdge);
    const dvec3 met = eye - eye.y / ray.y * ray;
    if (ray.y >= 0 || met.z < kGlowingWallZ + .1) return {};
    const dvec3 o(-ray.x, ray.z, -ray.y); // direction to the viewer in tangent space, whose axes
                                          // are x, -z and y
    const double alpha = wanted.roughness * wanted.roughness;
    dvec3 lobe(0), albedo(0);
    for (int k = 0; k < kPolarSteps; ++k) {
        // Half vectors whose squared tangent is alpha^2 s / (1 - s) have equal probability.
        const double s = (k + .5) / kPolarSteps, tan2 = alpha * alpha * s / (1 - s);
        const double z = 1 / std::sqrt(1 + tan2), flat = std::sqrt(1 - z * z);
        for (int j = 0; j < kAzimuthSteps; ++j) {
            const double turn = 2 * test::kPi * (j + .5) / kAzimuthSteps;
            const dvec3 h(flat * std::cos(turn), flat * std::sin(turn), z);
            const double cosine = glm::dot(o, h);
            if (cosine <= 0) continue;
            const dvec3 i = 2 * cosine * h - o;
            if (i.z <= 0) continue;
            // The density of half vectors is D h.z. The solid angle of half vectors is that of
            // light directions divided by 4 o.h.
            const double slope = 1 + tan2 / (alpha * alpha);
            const double density = 1 / (test::kPi * alpha * alpha * z * z * z * slope * slope);
            const double weight = test::textbook_lobe_reflectance(wanted.roughness, o, i) * 4 *
                                  cosine / (density * kPolarSteps * kAzimuthSteps);
            const double away = std::pow(1 - cosine, 5);
            const dvec3 fresnel = wanted.compute_scene_f0() +
                                  (1.0 - wanted.compute_scene_f0()) * away;
            albedo += weight * fresnel;
            lobe += weight * fresnel *
                    radiance_arriving_at_floor(scene, wanted, met, {i.x, i.z, -i.y});
        }
    }
    const dvec3 diffuse = wanted.colour * (1 - wanted.metallic) * (1.0 - albedo) * irradiance /
                          test::kPi;
    return lobe + diffuse;
}

/// The share of values that differ by more than 3 standard errors must be as expected by chance.
/// Standard errors come from 12 seeds, so the statistic has Student's distribution with 11 degrees
/// of freedom, and the expected share is 1.2 %.
TEST(LobeIntegral, TwoHundredPixelsAgreeWithAnotherIntegrator) {
    constexpr int kSeedCount = 12, kPixelsPerScene = 50;
    int apart = 0, compared = 0;
    double largest = 0;
    for (const IntegralScene& wanted :
         {IntegralScene{"metal below the sky", {.9, .6, .3}, 1, .25, WallPresence::none},
          IntegralScene{"plastic below the sky", {.6, .5, .2}, 0, .4, WallPresence::none},
          IntegralScene{"metal before a glowing wall", {.9, .8, .7}, 1, .5, WallPresence::glowing},
          IntegralScene{
              "half metal before a mirror", {.7, .6, .9}, .5, .15, WallPresence::mirror}}) {
        const scene::Scene scene = make_integral_scene(wanted);
        const auto c = scene::irradiance_coefficients(*scene.environment);
        // Irradiance of a surface whose normal points up.
        const dvec3 irradiance = c[0] + c[1] - c[6] - c[8];
        std::vector<measure::Picture> pictures;
        for (int seed = 1; seed <= kSeedCount; ++seed) {
            session::Request asked = test::make_test_request(
                scene, {"raytrace:rays=1024,depth=4,seed=" + std::to_string(seed)},
                {kIntegralPictureEdge, kIntegralPictureEdge});
            asked.ambient = 0;
            pictures.push_back(session::run(test::get_test_engine(), asked).parts.front().hdr);
        }
        test::RandomNumbers numbers(17);
        std::set<std::pair<int, int>> drawn;
        for (int tries = 0; int(drawn.size()) < kPixelsPerScene && tries < 4000; ++tries) {
            const std::pair pixel(int(numbers.random_integer_below(kIntegralPictureEdge)),
                                  int(numbers.random_integer_below(kIntegralPictureEdge)));
            if (drawn.contains(pixel)) continue;
            const auto& [x, y] = pixel;
            const std::optional<dvec3> radiance = integrate_floor_pixel(scene, wanted, x, y,
                                                                        irradiance);
            if (!radiance) continue;
            drawn.insert(pixel);
            for (int channel = 0; channel < 3; ++channel) {
                double mean = 0, squares = 0;
                for (const measure::Picture& picture : pictures) {
                    const double value = picture.at(x, y)[channel];
                    mean += value / kSeedCount, squares += value * value / kSeedCount;
                }
                const double error = std::sqrt(std::max(squares - mean * mean, 0.) /
                                               (kSeedCount - 1));
                const double off = std::abs(mean - (*radiance)[channel]);
                ++compared;
                apart += off > 3 * error + 5e-4; // 5e-4: error of the quadrature itself
                largest = std::max(largest, off);
            }
        }
        EXPECT_EQ(drawn.size(), std::size_t(kPixelsPerScene)) << wanted.name;
    }
    std::cout << "[ MEASURED ] " << apart << " of " << compared
              << " values apart by 3 standard errors, largest difference " << largest << '\n';
    EXPECT_LE(apart, compared / 40);
    EXPECT_LT(largest, .02);
}

} // namespace
