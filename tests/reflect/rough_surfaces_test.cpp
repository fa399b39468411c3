// Tests of rough surfaces that are no mirrors: highlights of lights, filtered environments, and
// rays of lobes. Expected values come from quadrature in double precision.
#include "render/sky_levels.hpp"
#include "scene/build.hpp"
#include "scene/surroundings.hpp"
#include "shared.h"
#include "support/lobe_witness.hpp"
#include "support/numbers.hpp"
#include "support/rendering.hpp"
#include "support/special_values.hpp"

#include <iostream>

namespace {

using namespace catoptric;

constexpr int kFloorPictureEdge = 16;
constexpr uvec2 kFloorPictureSize{kFloorPictureEdge, kFloorPictureEdge};

/// Material of a drawn surface.
struct FloorMaterial {
    dvec3 colour;
    double metallic, roughness;
    dvec3 compute_floor_f0() const { return glm::mix(dvec3(.04), colour, metallic); }
};
constexpr double kPlasticMetallic = 0, kMetalMetallic = 1;

/// Returns a floor at y = 0, seen at a slant, without any light.
scene::Scene make_rough_floor_scene(const FloorMaterial& material) {
    scene::Scene scene{.name = "floor"};
    const std::size_t number = test::add_material(
        scene, {.name = "floor",
                .albedo = vec3(material.colour),
                .metallic = static_cast<float>(material.metallic),
                .roughness = static_cast<float>(material.roughness),
                .dielectric_f0 = vec3(.04f),
                .dielectric_f90 = vec3(1)});
    test::add_quad(scene, "floor", number, {-50, 0, 50}, {50, 0, 50}, {50, 0, -50}, {-50, 0, -50});
    scene.cameras.push_back(
        {.eye = {0, 2, 6}, .target = {0, 0, 0}, .up = {0, 1, 0}, .vertical_fov_degrees = 40});
    return scene;
}

void add_point_light(scene::Scene& scene, const dvec3& position, const vec3& intensity) {
    scene::PunctualLight light{.name = "point", .intensity = intensity};
    light.world_from_light[3] = dvec4(position, 1);
    scene.punctual.push_back(light);
}

/// Returns a direction in the floor's tangent space, whose z is up.
dvec3 to_floor_tangent_space(const dvec3& direction) {
    return {direction.x, -direction.z, direction.y};
}

/// Returns the Fresnel reflectance of one channel for a half vector.
double fresnel_reflectance(double f0, const dvec3& o, const dvec3& i) {
    return f0 + (1 - f0) * std::pow(1 - glm::dot(o, glm::normalize(o + i)), 5);
}

/// The share of light from all around that the lobe reflects to a viewer: `head_on` for each unit
/// of F0, and `grazing` for reflectances of 1 at grazing angle.
struct ReferenceLobeAlbedo {
    double head_on, grazing;
    ReferenceLobeAlbedo(double roughness, const dvec3& o) {
        const auto integrate = [&](double f0) {
            return test::integrate_over_half_vectors(roughness, o, [&](const dvec3& i) {
                return fresnel_reflectance(f0, o, i) *
                       test::textbook_lobe_reflectance(roughness, o, i);
            });
        };
        grazing = integrate(0);
        head_on = integrate(1) - grazing;
    }
    double albedo_of_f0(double f0) const { return f0 * head_on + grazing; }
};

/// Returns the radiance of a pixel of the floor below a point light.
dvec3 expected_highlight_radiance(const scene::Scene& scene, const FloorMaterial& material, int x,
                                  int y) {
    const scene::Camera& camera = scene.cameras.front();
    const dvec3 ray = test::camera_direction_of_pixel(camera, x, y, kFloorPictureEdge);
    const dvec3 met = camera.eye - camera.eye.y / ray.y * ray;
    const scene::PunctualLight& light = scene.punctual.front();
    const dvec3 to_light = dvec3(light.world_from_light[3]) - met;
    const double squared = glm::dot(to_light, to_light);
    const dvec3 o = to_floor_tangent_space(-ray),
                i = to_floor_tangent_space(glm::normalize(to_light));
    const ReferenceLobeAlbedo albedo(material.roughness, o);
    dvec3 sum;
    for (int c = 0; c < 3; ++c) {
        const double f0 = material.compute_floor_f0()[c];
        const double diffuse = material.colour[c] * (1 - material.metallic) *
                               (1 - albedo.albedo_of_f0(f0)) / test::kPi * i.z;
        const double lobe = fresnel_reflectance(f0, o, i) *
                            test::textbook_lobe_reflectance(material.roughness, o, i);
        sum[c] = light.intensity[c] / squared * (diffuse + lobe);
    }
    return sum;
}

measure::Picture render_scene_without_ambient(const scene::Scene& scene,
                                              const std::string& technique) {
    session::Request asked = test::make_test_request(scene, {technique}, kFloorPictureSize);
    asked.ambient = 0;
    return session::run(test::get_test_engine(), asked).parts.front().hdr;
}

/// Tests a point light on plastic and metal of each roughness, rasterised and ray traced, on
/// surfaces that are mirrors and on surfaces that are not.
TEST(RoughSurfaces, HighlightsOfPointLightsFollowTheLobe) {
    constexpr std::pair<int, int> kTestedPixels[] = {{8, 15}, {2, 11}, {14, 8}, {9, 5}};
    double largest = 0;
    for (const FloorMaterial& material :
         {FloorMaterial{{.5, .4, .3}, kPlasticMetallic, .15},
          FloorMaterial{{.5, .4, .3}, kPlasticMetallic, .4},
          FloorMaterial{{.8, .2, .1}, kPlasticMetallic, .9},
          FloorMaterial{{.9, .6, .3}, kMetalMetallic, .3},
          FloorMaterial{{.9, .6, .3}, kMetalMetallic, .8}, FloorMaterial{{.7, .7, .2}, .5, .7}}) {
        scene::Scene scene = make_rough_floor_scene(material);
        add_point_light(scene, {1, 3, -2}, vec3(20, 30, 40));
        std::vector<dvec3> wanted;
        for (const auto& [x, y] : kTestedPixels)
            wanted.push_back(expected_highlight_radiance(scene, material, x, y));
        for (const bool is_mirror : {false, true})
            for (const char* world :
                 {"raytrace", "raytrace:rays=2", "raytrace:rays=2,first=raster", "naive:bounces=0",
                  "reuse:face=16", "reuse:face=16,rough=none"}) {
                scene.objects[0].mirror = is_mirror;
                scene.mirror_max_roughness = is_mirror ? 1 : .6f;
                const measure::Picture picture = render_scene_without_ambient(scene, world);
                for (std::size_t k = 0; k < wanted.size(); ++k) {
                    const auto& [x, y] = kTestedPixels[k];
                    for (int c = 0; c < 3; ++c) {
                        const double off = std::abs(picture.at(x, y)[c] - wanted[k][c]) /
                                           (.02 + wanted[k][c]);
                        largest = std::max(largest, off);
                        EXPECT_LT(off, .01)
                            << world << ", roughness " << material.roughness << ", metallic "
                            << material.metallic << ", mirror " << is_mirror << ", pixel " << x
                            << ' ' << y << ": wanted " << wanted[k][c] << ", found "
                            << picture.at(x, y)[c];
                    }
                }
            }
    }
    std::cout << "[ MEASURED ] largest relative difference: " << largest << '\n';
}

/// Returns an environment without edges, also at its poles.
std::shared_ptr<scene::Environment> make_smooth_test_environment(bool is_white) {
    auto map = std::make_shared<scene::Environment>();
    map->size = {64, 32};
    for (std::uint32_t row = 0; row < map->size.y; ++row)
        for (std::uint32_t column = 0; column < map->size.x; ++column) {
            const float azimuth = 6.2832f * (float(column) + .5f) / 64;
            const float polar = 3.1416f * (float(row) + .5f) / 32, flat = std::sin(polar);
            map->texels.push_back(is_white ? vec3(1)
                                           : vec3(1 + .8f * flat * std::sin(azimuth),
                                                  .6f + .5f * std::cos(polar),
                                                  1 + .9f * flat * flat * std::cos(2 * azimuth)));
        }
    return map;
}

/// Diffuse and specular part of a white surface share the light: white plastic of any roughness in
/// a white furnace is white.
TEST(RoughSurfaces, WhitePlasticInAWhiteFurnaceIsWhite) {
    for (const double roughness : {.05, .1, .25, .5, .75, 1.}) {
        scene::Scene scene = make_rough_floor_scene({dvec3(1), kPlasticMetallic, roughness});
        scene.environment = make_smooth_test_environment(true);
        for (const auto& [world, tolerance] :
             {std::pair("raytrace", 1e-3), std::pair("naive:bounces=0", 1e-3),
              std::pair("raytrace:rays=256", 5e-3)}) {
            const measure::Picture picture = render_scene_without_ambient(scene, world);
            double sum = 0;
            for (int y = 6; y < kFloorPictureEdge; ++y)
                for (int x = 0; x < kFloorPictureEdge; ++x) sum += picture.at(x, y)[1];
            EXPECT_NEAR(sum / ((kFloorPictureEdge - 6) * kFloorPictureEdge), 1, tolerance)
                << world << " roughness " << roughness;
        }
    }
}

/// White metal of any roughness in a white furnace is white with multiple scattering, and darker
/// without.
TEST(RoughSurfaces, MultipleScatteringLosesNoLight) {
    constexpr std::pair<int, int> kTestedPixels[] = {{8, 15}, {4, 9}};
    std::array<std::map<std::string, double>, 2> largest_differences;
    for (const double roughness : {.05, .25, .5, .75, 1.}) {
        scene::Scene scene = make_rough_floor_scene({dvec3(1), kMetalMetallic, roughness});
        scene.environment = make_smooth_test_environment(true);
        std::vector<double> single;
        for (const auto& [x, y] : kTestedPixels) {
            const dvec3 ray = test::camera_direction_of_pixel(scene.cameras.front(), x, y,
                                                              kFloorPictureEdge);
            single.push_back(
                ReferenceLobeAlbedo(roughness, to_floor_tangent_space(-ray)).albedo_of_f0(1));
        }
        for (const bool is_multiple : {false, true})
            for (const char* world : {"raytrace", "naive:bounces=0", "raytrace:rays=1024",
                                      "reuse:face=32", "reuse:face=32,rough=rays,rays=1024"}) {
                const bool is_captured = std::string_view(world).starts_with("reuse");
                scene.has_multiple_scattering = is_multiple;
                scene.objects[0].mirror = is_captured;
                scene.mirror_max_roughness = is_captured ? 1 : 0;
                const measure::Picture picture = render_scene_without_ambient(scene, world);
                double& largest = largest_differences[is_multiple][world];
                for (std::size_t k = 0; k < single.size(); ++k) {
                    const double found = picture.at(kTestedPixels[k].first,
                                                    kTestedPixels[k].second)[0],
                                 wanted = is_multiple ? 1 : single[k];
                    largest = std::max(largest, std::abs(found - wanted));
                    EXPECT_NEAR(found, wanted, is_multiple ? .005 : .002)
                        << world << " roughness " << roughness;
                }
            }
    }
    for (const bool is_multiple : {false, true})
        for (const auto& [world, largest] : largest_differences[is_multiple])
            std::cout << "[ MEASURED ] " << world << (is_multiple ? ", multiple" : ", single")
                      << " scattering: largest difference " << largest << '\n';
}

/// Rays from plastic bring the part of the environment that the lobe reflects. All other light of
/// the plastic is diffuse.
TEST(RoughSurfaces, RaysFromPlasticBringTheIntegralOverTheLobe) {
    const FloorMaterial material{{.5, .4, .3}, kPlasticMetallic, .35};
    scene::Scene scene = make_rough_floor_scene(material);
    scene.environment = make_smooth_test_environment(false);
    const measure::Picture picture = render_scene_without_ambient(scene, "raytrace:rays=1024");
    const auto coefficients = scene::irradiance_coefficients(*scene.environment);
    // Irradiance of the upward normal, by the formula of Ramamoorthi and Hanrahan.
    const dvec3 irradiance = coefficients[0] + coefficients[1] - coefficients[6] - coefficients[8];
    for (const auto& [x, y] : {std::pair(8, 15), std::pair(3, 9), std::pair(14, 7)}) {
        const dvec3 ray = test::camera_direction_of_pixel(scene.cameras.front(), x, y,
                                                          kFloorPictureEdge);
        const dvec3 o = to_floor_tangent_space(-ray);
        const ReferenceLobeAlbedo albedo(material.roughness, o);
        for (int c = 0; c < 3; ++c) {
            const double lobe = test::integrate_over_half_vectors(
                material.roughness, o, [&](const dvec3& i) {
                    if (i.z <= 0) return 0.;
                    const dvec3 light = scene::environment_radiance(*scene.environment,
                                                                    {i.x, i.z, -i.y});
                    return fresnel_reflectance(.04, o, i) *
                           test::textbook_lobe_reflectance(material.roughness, o, i) * light[c];
                });
            const double diffuse = material.colour[c] * (1 - albedo.albedo_of_f0(.04)) *
                                   irradiance[c] / test::kPi;
            EXPECT_NEAR(picture.at(x, y)[c], lobe + diffuse, .004) << x << ' ' << y << ' ' << c;
        }
    }
}

/// Returns the environment filtered by a lobe that is seen along its normal, by quadrature.
dvec3 expected_level_radiance(const scene::Environment& environment, double roughness,
                              const dvec3& normal) {
    const dvec3 tangent = glm::normalize(glm::cross(normal, dvec3(.3, .5, .8))),
                bitangent = glm::cross(normal, tangent);
    const double alpha2 = std::pow(roughness, 4);
    dvec3 sum(0);
    double weights = 0;
    constexpr int kPolarStepCount = 800, kAzimuth = 160;
    for (int k = 0; k < kPolarStepCount; ++k) {
        // Half vectors whose squared tangent is alpha^2 s / (1 - s) have equal probability.
        const double s = (k + .5) / kPolarStepCount, tan2 = alpha2 * s / (1 - s);
        const double polar = 2 * std::atan(std::sqrt(tan2)), z = std::cos(polar);
        if (z <= 0) continue;
        for (int j = 0; j < kAzimuth; ++j) {
            const double turn = 2 * test::kPi * (j + .5) / kAzimuth;
            sum += z *
                   scene::environment_radiance(
                       environment, std::sin(polar) * std::cos(turn) * tangent +
                                        std::sin(polar) * std::sin(turn) * bitangent + z * normal);
            weights += z;
        }
    }
    return sum / weights;
}

TEST(RoughSurfaces, LevelsOfTheEnvironmentEqualAQuadrature) {
    auto studio = std::make_shared<scene::Environment>();
    studio->studio = true;
    test::RandomNumbers numbers(11);
    for (const std::shared_ptr<scene::Environment>& environment :
         {make_smooth_test_environment(false), studio}) {
        const std::shared_ptr<const render::SkyLevels> levels = render::find_sky_levels(
            environment);
        auto copy = std::make_shared<scene::Environment>(*environment);
        copy->name = "other", copy->scale = 2, copy->rotation_degrees = 30;
        EXPECT_EQ(levels, render::find_sky_levels(copy)) << "kept for the same texels";
        if (copy->studio) {
            copy->studio = false, copy->size = {2, 1}, copy->texels = {vec3(1), vec3(2)};
        } else {
            copy->texels.back().x += .5f;
        }
        EXPECT_NE(levels, render::find_sky_levels(copy)) << "made again for other texels";
        for (std::size_t k = 0; k < SKY_LEVEL_COUNT; ++k) {
            const std::uint32_t width = levels->width[k], height = width / 2;
            double largest = 0;
            for (int draw = 0; draw < 12; ++draw) {
                const std::uint32_t column = std::uint32_t(
                                        numbers.random_integer_below(int(width))),
                                    row = std::uint32_t(numbers.random_integer_below(int(height)));
                const double azimuth = 2 * test::kPi * (column + .5) / width - test::kPi,
                             polar = test::kPi * (row + .5) / height;
                const dvec3 direction(std::sin(polar) * std::sin(azimuth), std::cos(polar),
                                      -std::sin(polar) * std::cos(azimuth));
                const dvec3 wanted = expected_level_radiance(
                    *environment, double(k + 1) / SKY_LEVEL_COUNT, direction);
                const dvec3 found(levels->texels[levels->first[k] + row * width + column]);
                for (int c = 0; c < 3; ++c)
                    largest = std::max(largest, std::abs(found[c] - wanted[c]) / wanted[c]);
            }
            std::cout << "[ MEASURED ] level " << k + 1 << ": largest relative difference "
                      << largest << '\n';
            EXPECT_LT(largest, .04) << k + 1;
        }
    }
}

/// With `first=raster`, rays from rough surfaces must give the same picture as with traced camera
/// rays.
TEST(RoughSurfaces, RaysFromDrawnSurfacesAreThoseOfTracedOnes) {
    scene::Scene scene = make_rough_floor_scene({{.5, .4, .3}, kPlasticMetallic, .3});
    scene.environment = make_smooth_test_environment(false);
    const std::size_t metal = test::add_material(
        scene, {.name = "metal", .albedo = vec3(.9f), .metallic = 1, .roughness = .25f});
    test::add_ball(scene, "ball", metal, {0, 1, 0}, 1, 4);
    scene.objects.back().mirror = true;
    const measure::Picture traced =
        test::render_technique(scene, "raytrace:rays=8,depth=3", {48, 48}).hdr;
    const measure::Picture drawn =
        test::render_technique(scene, "raytrace:rays=8,depth=3,first=raster", {48, 48}).hdr;
    int apart = 0;
    for (std::size_t i = 0; i < traced.pixels.size(); ++i)
        apart += glm::length(traced.pixels[i] - drawn.pixels[i]) > .02f;
    EXPECT_LE(apart, 25) << "of " << traced.pixels.size(); // pixels at outlines may differ
    EXPECT_GT(test::rmse_of_pictures(
                  traced, test::render_technique(scene, "raytrace:depth=3", {48, 48}).hdr),
              .01);
}

/// The data of a first hit say whether a surface that is no mirror reflects sharply or by a lobe.
TEST(RoughSurfaces, HitsTellRoughFromSmoothSurfaces) {
    for (const auto& [roughness, code] :
         {std::pair(.04, shared::kHitSmoothDielectric), std::pair(.05, shared::kHitRoughNonMirror),
          std::pair(1., shared::kHitRoughNonMirror)}) {
        const scene::Scene scene = make_rough_floor_scene(
            {{.5, .4, .3}, kPlasticMetallic, roughness});
        for (const char* world : {"raytrace", "raytrace:rays=1"}) {
            const std::vector<std::uint32_t> hits =
                test::render_technique(scene, world, kFloorPictureSize).hits;
            EXPECT_EQ(hits.back(), code << 16) << world << ' ' << roughness;
            const measure::Mask rough = measure::mask_rough(hits),
                                smooth = measure::mask_dielectrics(hits);
            EXPECT_EQ(rough.back() != 0, code == shared::kHitRoughNonMirror);
            EXPECT_EQ(smooth.back() != 0, code == shared::kHitSmoothDielectric);
            EXPECT_EQ(rough.front(), 0) << "the sky";
        }
    }
}

/// Rasterised pictures show no reflections of lamps in rough metal that is no mirror. Lamps
/// therefore light such metal as if it were diffuse. Rays of the lobe show the reflections, so
/// ray-traced pictures have no such diffuse light.
TEST(RoughSurfaces, LampsLightARoughMetalWhereNoRaysGo) {
    scene::Scene scene = make_rough_floor_scene({{.9, .6, .3}, kMetalMetallic, .9});
    const std::size_t lamp = test::add_material(scene, {.name = "lamp", .emission = vec3(50)});
    test::add_quad(scene, "lamp", lamp, {-.1, 3, -.1}, {.1, 3, -.1}, {.1, 3, .1}, {-.1, 3, .1});
    scene::Scene diffuse = scene;
    diffuse.materials[0].metallic = 0;
    diffuse.materials[0].dielectric_f0 = diffuse.materials[0].dielectric_f90 = vec3(0);
    for (const char* world : {"raytrace", "naive:bounces=0"}) {
        const measure::Picture metal = render_scene_without_ambient(scene, world),
                               stand_in = render_scene_without_ambient(diffuse, world);
        EXPECT_GT(stand_in.at(8, 12).x, .02f);
        EXPECT_LT(test::rmse_of_pictures(metal, stand_in), 1e-6) << world;
    }
}

} // namespace
