// Tests of ray-traced glass, against formulas and against a ray tracer in double precision.
#include "core/shader_math.hpp"
#include "scene/surroundings.hpp"
#include "support/lit.hpp"
#include "support/lobe_witness.hpp"
#include "support/rendering.hpp"
#include "support/smooth_environment.hpp"
#include "support/special_values.hpp"

#include <cmath>
#include <iostream>

namespace {

using namespace catoptric;

constexpr int kGlassEdge = 48;

scene::Material make_glass(float ior, bool solid) {
    return {.name = "glass",
            .albedo = vec3(1),
            .roughness = 0,
            .dielectric_f0 = vec3(std::pow((ior - 1) / (ior + 1), 2.f)),
            .dielectric_f90 = vec3(1),
            .transmission = 1,
            .ior = ior,
            .solid = solid};
}

/// Returns the light that a ray brings from a glass ball and from the environment around it. The
/// ball has radius 1 and its centre at the origin. `inside`: whether the ray starts in the ball.
dvec3 trace_ray_through_glass_ball(const scene::Scene& scene, const dvec3& origin,
                                   const dvec3& direction, bool inside, double weight, int depth) {
    const scene::Material& glass = scene.materials[0];
    const double b = glm::dot(origin, direction), c = glm::dot(origin, origin) - 1;
    const double t = inside ? -2 * b : -b - std::sqrt(std::max(b * b - c, 0.));
    if (!inside && (b >= 0 || b * b < c))
        return scene::environment_radiance(*scene.environment, direction);
    if (depth == 0 || weight < 1e-5) return dvec3(0);
    const dvec3 at = glm::normalize(origin + t * direction), normal = inside ? -at : at;
    const double ratio = inside ? 1 / glass.ior : double(glass.ior);
    const double cosine = -glm::dot(direction, normal);
    double behind;
    const double reflected = f64::fresnel_dielectric(cosine, ratio, behind);
    const dvec3 absorbed = inside ? glm::exp(-dvec3(glass.absorption) * t) : dvec3(1);
    dvec3 light = reflected * trace_ray_through_glass_ball(scene, at,
                                                           direction + 2 * cosine * normal, inside,
                                                           weight * reflected, depth - 1);
    if (reflected < 1)
        light += (1 - reflected) * dvec3(glass.albedo) *
                 trace_ray_through_glass_ball(
                     scene, at, f64::refract_direction(direction, normal, cosine, ratio, behind),
                     !inside, weight * (1 - reflected), depth - 1);
    return absorbed * light;
}

scene::Scene make_glass_ball(const scene::Material& glass, int levels = 5) {
    scene::Scene scene{.name = "ball"};
    test::add_ball(scene, "ball", test::add_material(scene, glass), {0, 0, 0}, 1, levels);
    scene.environment = test::make_smooth_environment();
    scene.cameras.push_back({.eye = {.5, .4, 4}, .target = {0, 0, 0}, .vertical_fov_degrees = 32});
    return scene;
}

/// Expects that at most .2 % of the pixels differ by more than .02 from `wanted`, which returns the
/// radiance in a direction from the camera.
template <typename Wanted>
void expect_few_pixels_off(const scene::Scene& scene, const char* technique, Wanted&& wanted) {
    const measure::Picture found =
        test::render_technique(scene, technique, {kGlassEdge, kGlassEdge}).hdr;
    int off = 0;
    double largest = 0;
    for (int y = 0; y < kGlassEdge; ++y)
        for (int x = 0; x < kGlassEdge; ++x) {
            const dvec3 direction = test::camera_direction_of_pixel(scene.cameras.front(), x, y,
                                                                    kGlassEdge);
            const dvec3 difference = glm::abs(dvec3(found.at(x, y)) - wanted(direction));
            const double error = std::max({difference.x, difference.y, difference.z});
            off += error > .02;
            largest = std::max(largest, error);
        }
    std::cout << "[ MEASURED ] " << scene.name << ": " << off << " of " << kGlassEdge * kGlassEdge
              << " pixels off by .02, largest difference " << largest << '\n';
    EXPECT_LE(off, kGlassEdge * kGlassEdge / 500);
}

TEST(GlassBall, EqualsATracerInDoublePrecision) {
    scene::Material tinted = make_glass(1.5f, true);
    tinted.albedo = {.9f, .8f, .7f}, tinted.absorption = {.1f, .3f, .8f};
    for (const scene::Material& glass : {make_glass(1.5f, true), make_glass(1.1f, true), tinted}) {
        const scene::Scene scene = make_glass_ball(glass);
        expect_few_pixels_off(scene, "raytrace:depth=16,sphere=exact", [&](const dvec3& direction) {
            return trace_ray_through_glass_ball(scene, scene.cameras.front().eye, direction, false,
                                                1, 16);
        });
    }
}

/// Returns the indices of refraction by glTF's formula. The indices of red and blue differ from the
/// index of green by (n - 1) / (2 V), where V = 20 / dispersion is the Abbe number.
TEST(GlassBall, DispersionBendsEachColourByItsOwnIndex) {
    scene::Material glass = make_glass(1.5f, true);
    glass.dispersion = 2;
    scene::Scene scene = make_glass_ball(glass);
    const measure::Picture found = test::render_technique(scene, "raytrace:depth=16,sphere=exact",
                                                          {kGlassEdge, kGlassEdge})
                                       .hdr;
    int off = 0, unlike_green = 0;
    for (int y = 0; y < kGlassEdge; ++y)
        for (int x = 0; x < kGlassEdge; ++x)
            for (int channel = 0; channel < 3; ++channel) {
                const double half_spread = .5 * (1.5 - 1) / (20. / 2);
                const dvec3 direction = test::camera_direction_of_pixel(scene.cameras.front(), x, y,
                                                                        kGlassEdge);
                const auto trace_with = [&](double ior) {
                    scene.materials[0].ior = static_cast<float>(ior);
                    return trace_ray_through_glass_ball(scene, scene.cameras.front().eye, direction,
                                                        false, 1, 16)[channel];
                };
                const double wanted = trace_with(1.5 + (channel - 1) * half_spread);
                off += std::abs(found.at(x, y)[channel] - wanted) > .02;
                unlike_green += std::abs(trace_with(1.5) - wanted) > .02;
            }
    std::cout << "[ MEASURED ] values off by .02: " << off << "; without dispersion "
              << unlike_green << '\n';
    EXPECT_LE(off, 3 * kGlassEdge * kGlassEdge / 500);
    EXPECT_GT(unlike_green, 10 * off + 100);
}

/// Single scattering loses light that meets several microfacets. With multiple scattering, rough
/// glass in a white furnace must be as bright as its surroundings.
TEST(GlassBall, RoughGlassInAWhiteFurnace) {
    for (const auto& [roughness, least_single] :
         {std::pair(.1f, .99), std::pair(.3f, .95), std::pair(.6f, .75), std::pair(1.f, .3)}) {
        scene::Material glass = make_glass(1.5f, true);
        glass.roughness = roughness;
        scene::Scene scene = make_glass_ball(glass, 4);
        auto white = std::make_shared<scene::Environment>();
        white->size = {16, 8};
        white->texels.assign(16 * 8, vec3(1));
        scene.environment = white;
        const auto render_mean = [&](bool has_multiple_scattering) {
            scene.has_multiple_scattering = has_multiple_scattering;
            const measure::Picture seen = test::render_technique(
                                              scene, "raytrace:depth=48,sphere=exact,rays=16",
                                              {24, 24})
                                              .hdr;
            double sum = 0;
            for (const vec3& pixel : seen.pixels) sum += pixel.x;
            return sum / double(seen.pixels.size());
        };
        const double single = render_mean(false), multiple = render_mean(true);
        std::cout << "[ MEASURED ] roughness " << roughness << ": mean " << single
                  << ", with multiple scattering " << multiple << '\n';
        EXPECT_GT(single, least_single);
        EXPECT_LT(single, multiple + 1e-3);
        EXPECT_NEAR(multiple, 1, .01);
    }
}

/// Returns the light that a rough pane with normal z shows to a viewer in direction `o`, by
/// quadrature. Light that passes a thin sheet has a mirror's lobe, turned to the other side of the
/// sheet.
dvec3 integrate_rough_pane(const scene::Scene& scene, double roughness, const dvec3& o) {
    dvec3 sum(0);
    const auto light_from = [&](const dvec3& i) {
        return scene::environment_radiance(*scene.environment, i);
    };
    const double alpha = roughness * roughness;
    const auto masking = [&](double z) {
        return 2 / (1 + std::sqrt(1 + alpha * alpha * (1 - z * z) / (z * z)));
    };
    for (int channel = 0; channel < 3; ++channel)
        sum[channel] = test::integrate_over_half_vectors(roughness, o, [&](const dvec3& i) {
            if (i.z <= 0) return 0.0;
            double behind;
            const double fresnel = f64::fresnel_dielectric(glm::dot(o, glm::normalize(o + i)), 1.5,
                                                           behind),
                         lobe = test::textbook_lobe_reflectance(roughness, o, i);
            // The reflecting lobe has height-correlated masking. The transmitting lobe has a
            // separate masking factor for each side.
            const double correlated = 1 / (1 / masking(o.z) + 1 / masking(i.z) - 1);
            return lobe * (fresnel * light_from(i)[channel] +
                           (1 - fresnel) * masking(o.z) * masking(i.z) / correlated *
                               light_from({i.x, i.y, -i.z})[channel]);
        });
    return sum;
}

TEST(GlassPane, RoughSheetSpreadsLightByItsLobe) {
    for (const float roughness : {.2f, .5f}) {
        scene::Material glass = make_glass(1.5f, false);
        glass.roughness = roughness;
        scene::Scene scene{.name = "pane"};
        test::add_quad(scene, "pane", test::add_material(scene, glass), {-9, -9, 0}, {9, -9, 0},
                       {9, 9, 0}, {-9, 9, 0});
        scene.environment = test::make_smooth_environment();
        scene.cameras.push_back({.eye = {2, 1, 3}, .target = {0, 0, 0}, .vertical_fov_degrees = 1});
        const dvec3 found(
            test::render_without_ambient(scene, "raytrace:rays=4096", {1, 1}).hdr.at(0, 0));
        const dvec3 wanted = integrate_rough_pane(scene, roughness,
                                                  glm::normalize(scene.cameras[0].eye));
        for (int channel = 0; channel < 3; ++channel)
            EXPECT_NEAR(found[channel], wanted[channel], .01 * wanted[channel]) << roughness;
    }
}

/// Returns the scene with a directional light along `direction` as its only light.
scene::Scene make_scene_lit_by_sun_alone(scene::Scene scene, const dvec3& direction) {
    scene.environment.reset();
    scene::PunctualLight sun{
        .name = "sun", .kind = scene::PunctualLight::Kind::directional, .intensity = vec3(3)};
    sun.world_from_light = test::make_light_transform({0, 0, 9}, direction);
    scene.punctual.push_back(sun);
    return scene;
}

/// Lights without a surface do not shine through rough glass (gap `rough-glass`). A rough ball in
/// front of a directional light must be black, without a highlight on its inner side.
TEST(GlassBall, RoughBallBeforeTheSunIsBlack) {
    scene::Material glass = make_glass(1.5f, true);
    glass.roughness = .4f;
    scene::Scene scene = make_glass_ball(glass, 4);
    const dvec3 to_eye = scene.cameras.front().eye - scene.cameras.front().target;
    const scene::Scene against = make_scene_lit_by_sun_alone(scene, to_eye),
                       along = make_scene_lit_by_sun_alone(scene, -to_eye);
    for (const bool is_two_sided : {false, true})
        for (const char* technique : {"raytrace", "raytrace:rays=16", "secant:face=16"}) {
            const auto brightest = [&](scene::Scene lit) {
                lit.materials.front().two_sided = is_two_sided;
                scene::find_mirrors(lit);
                const measure::Picture seen =
                    test::render_without_ambient(lit, technique, {24, 24}, 2).hdr;
                float most = 0; // outlines are not tested: they reflect light from behind the ball
                for (int y = 8; y < 16; ++y)
                    for (int x = 8; x < 16; ++x) most = std::max(most, seen.at(x, y).x);
                return most;
            };
            EXPECT_EQ(brightest(against), 0) << technique << ", two-sided " << is_two_sided;
            EXPECT_GT(brightest(along), .01) << technique << ", two-sided " << is_two_sided;
        }
}

/// A thin sheet of rough glass shows the highlight of a light on the viewer's side, to whichever
/// side the normal of the sheet points.
TEST(GlassPane, RoughSheetHasAHighlightOnBothSides) {
    scene::Material glass = make_glass(1.5f, false);
    glass.roughness = .4f;
    std::vector<float> seen;
    for (const bool is_turned : {false, true})
        for (const char* technique : {"raytrace", "raytrace:rays=64", "secant:face=16"}) {
            scene::Scene scene{.name = "pane"};
            const std::size_t pane = test::add_material(scene, glass);
            if (is_turned)
                test::add_quad(scene, "pane", pane, {-9, -9, 0}, {-9, 9, 0}, {9, 9, 0}, {9, -9, 0});
            else
                test::add_quad(scene, "pane", pane, {-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0});
            scene.cameras.push_back(
                {.eye = {0, 1, 3}, .target = {0, 0, 0}, .vertical_fov_degrees = 1});
            scene = make_scene_lit_by_sun_alone(scene, {0, 1, -3});
            scene::find_mirrors(scene);
            seen.push_back(
                test::render_without_ambient(scene, technique, {1, 1}, 2).hdr.at(0, 0).x);
        }
    EXPECT_GT(seen.front(), .1);
    for (const float highlight : seen) EXPECT_NEAR(highlight, seen.front(), .01 * seen.front());
}

/// Paths with a weight below 1/512 are dropped, so a little light is missing. In a mesh with
/// interpolated normals, some paths are also reflected inside the mesh until the largest depth ends
/// them.
TEST(GlassBall, IsInvisibleInAWhiteFurnace) {
    scene::Scene scene = make_glass_ball(make_glass(1.5f, true), 4);
    auto white = std::make_shared<scene::Environment>();
    white->size = {16, 8};
    white->texels.assign(16 * 8, vec3(1));
    scene.environment = white;
    for (const std::string& technique :
         {std::string("raytrace:depth=32,sphere=exact"), std::string("raytrace:depth=32"),
          std::string("raytrace:depth=32,rays=4,indirect=paths")}) {
        double sum = 0, least = 1;
        const measure::Picture seen = test::render_technique(scene, technique, {24, 24}).hdr;
        for (const vec3& pixel : seen.pixels) {
            EXPECT_LE(pixel.x, 1.0001f) << technique;
            sum += pixel.x, least = std::min<double>(least, pixel.x);
        }
        const double mean = sum / double(seen.pixels.size());
        std::cout << "[ MEASURED ] " << technique << ": mean " << mean << ", least " << least
                  << '\n';
        EXPECT_GT(mean, .998) << technique;
        if (technique.ends_with("exact")) {
            EXPECT_GT(least, .996);
        }
    }
}

/// Returns a pane of glass in front of an emitting wall, seen head-on.
scene::Scene make_pane_before_wall(const scene::Material& glass) {
    scene::Scene scene{.name = "pane"};
    const std::size_t pane = test::add_material(scene, glass),
                      wall = test::add_material(scene,
                                                {.name = "wall", .emission = {.8f, .4f, .2f}});
    test::add_quad(scene, "pane", pane, {-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0});
    test::add_quad(scene, "wall", wall, {-9, -9, -3}, {9, -9, -3}, {9, 9, -3}, {-9, 9, -3});
    scene.cameras.push_back({.eye = {0, 0, 4}, .target = {0, 0, 0}, .vertical_fov_degrees = 1});
    return scene;
}

TEST(GlassPane, ThinPaneTintsWhatPassesIt) {
    scene::Material glass = make_glass(1.5f, true); // an open mesh counts as a sheet, not as a
                                                    // solid body
    glass.albedo = {1, .5f, .25f};
    const vec3 seen =
        test::render_without_ambient(make_pane_before_wall(glass), "raytrace", {1, 1}).hdr.at(0, 0);
    const double passing = 1 - 2 * .04 / 1.04; // both surfaces of the sheet reflect again and again
    EXPECT_NEAR(seen.x, passing * .8, 1e-5);
    EXPECT_NEAR(seen.y, passing * .4 * .5, 1e-5);
    EXPECT_NEAR(seen.z, passing * .2 * .25, 1e-5);
}

TEST(GlassPane, SolidSlabAbsorbsByItsThickness) {
    scene::Material glass = make_glass(1.5f, true);
    glass.absorption = {0, .5f, 2};
    scene::Scene scene = make_pane_before_wall(make_glass(1.5f, true));
    scene.materials[0] = glass;
    scene.meshes[0] = scene::box("slab", {-9, -9, -.7}, {9, 9, 0});
    const vec3 seen = test::render_without_ambient(scene, "raytrace", {1, 1}).hdr.at(0, 0);
    // Between both faces of the pane, light is reflected again and again. The share that passes is
    // (1 - r)^2 a (1 + (r a)^2 + ...), for the reflectance r of a face and the share a that is not
    // absorbed.
    const auto passes = [](double absorption) {
        const double r = .04, a = std::exp(-.7 * absorption);
        return (1 - r) * (1 - r) * a / (1 - r * r * a * a);
    };
    EXPECT_NEAR(seen.x, .8 * passes(0), .002); // paths with a weight below 1/512 are dropped
    EXPECT_NEAR(seen.y, .4 * passes(.5), .002);
    EXPECT_NEAR(seen.z, .2 * passes(2), .002);
}

/// A ray leaves a slab in the direction in which it entered, so all light of a pixel comes from two
/// directions of the environment. Between both faces, light is reflected again and again.
TEST(GlassPane, SlabEqualsItsFormulaInDoublePrecision) {
    scene::Material glass = make_glass(1.5f, true);
    glass.absorption = {.1f, .3f, .8f};
    scene::Scene scene{.name = "slab"};
    constexpr double kThickness = .7;
    test::add_mesh(scene, scene::box("slab", {-9, -9, -kThickness}, {9, 9, 0}),
                   test::add_material(scene, glass));
    scene.environment = test::make_smooth_environment();
    scene.cameras.push_back({.eye = {1, .5, 2}, .target = {0, 0, 0}, .vertical_fov_degrees = 70});
    expect_few_pixels_off(scene, "raytrace:depth=16", [&](const dvec3& direction) {
        double behind;
        const double r = f64::fresnel_dielectric(-direction.z, glass.ior, behind);
        const dvec3 a = glm::exp(-dvec3(glass.absorption) * (kThickness / behind)),
                    series = (1 - r) * (1 - r) * a / (1. - r * r * a * a),
                    mirrored = direction * dvec3(1, 1, -1);
        return series * scene::environment_radiance(*scene.environment, direction) +
               (r + r * a * series) * scene::environment_radiance(*scene.environment, mirrored);
    });
}

/// A pane of glass reflects a lamp. The path that passes the pane ends at a diffuse wall, where a
/// ray goes to the lamp. The reflected path must add the light of the lamp in full, because no ray
/// to the lamp belongs to the reflected path.
TEST(GlassPane, ReflectedLampCountsOnce) {
    scene::Scene scene{.name = "pane"};
    const std::size_t glass = test::add_material(scene, make_glass(1.5f, false)),
                      wall = test::add_material(scene, {.name = "wall", .albedo = vec3(.5f)}),
                      lamp = test::add_material(scene, {.name = "lamp", .emission = vec3(8)});
    test::add_quad(scene, "pane", glass, {-1, -1, 1}, {1, -1, 1}, {1, 1, -1}, {-1, 1, -1});
    test::add_quad(scene, "wall", wall, {-9, -9, -3}, {9, -9, -3}, {9, 9, -3}, {-9, 9, -3});
    test::add_quad(scene, "lamp", lamp, {-1, 3, -1}, {1, 3, -1}, {1, 3, 1}, {-1, 3, 1});
    scene.cameras.push_back({.eye = {0, 0, 4}, .target = {0, 0, 0}, .vertical_fov_degrees = 1});
    const auto seen = [&](const std::string& knobs) {
        return test::render_without_ambient(scene, "raytrace:rays=4096,depth=4" + knobs, {1, 1})
            .hdr.at(0, 0)
            .x;
    };
    double behind;
    const double reflected = 8 * f64::fresnel_dielectric(std::sqrt(.5), 1.5, behind);
    const float sampled = seen(",indirect=paths"), met = seen(",indirect=paths,lamps=met");
    EXPECT_GT(sampled, reflected);
    EXPECT_NEAR(sampled, met, .02 * met);
}

TEST(GlassPane, CastsNoShadowInBothWorlds) {
    for (const bool has_pane : {false, true}) {
        static double lit[2];
        int world = 0;
        for (const std::string technique : {"raytrace", "naive:bounces=0"}) {
            scene::Scene scene = test::make_floor_scene();
            const std::size_t glass = test::add_material(scene, make_glass(1.5f, false));
            if (has_pane)
                test::add_quad(scene, "pane", glass, {-1, 1, -1}, {1, 1, -1}, {1, 1, 1},
                               {-1, 1, 1});
            scene::PunctualLight light{.intensity = vec3(5)};
            light.world_from_light[3] = dvec4(0, 2, 0, 1);
            scene.punctual.push_back(light);
            scene.cameras.push_back(
                {.eye = {2, .5, 0}, .target = {0, 0, 0}, .vertical_fov_degrees = 1});
            const double found =
                test::render_without_ambient(scene, technique, {1, 1}).hdr.at(0, 0).x;
            EXPECT_GT(found, .1) << technique;
            if (has_pane)
                EXPECT_NEAR(found, lit[world], 1e-6) << technique;
            else
                lit[world] = found;
            ++world;
        }
    }
}

TEST(GlassPane, RaysFromTheRasterisedSurfaceShowWhatRaysFromTheCameraShow) {
    scene::Scene scene = test::make_lit_room(2, 1);
    const std::size_t glass = test::add_material(scene, make_glass(1.5f, true));
    test::add_ball(scene, "glass", glass, {.2, -.2, -.9}, .4, 4);
    const uvec2 size{64, 48};
    const measure::Picture whole = test::render_technique(scene, "raytrace", size).hdr,
                           listed =
                               test::render_technique(scene, "raytrace:first=raster", size).hdr;
    int off = 0;
    for (std::size_t i = 0; i < whole.pixels.size(); ++i)
        off += test::max_channel_difference(whole.pixels[i], listed.pixels[i]) > .02f;
    EXPECT_LE(off, int(whole.pixels.size()) / 200);
}

} // namespace
