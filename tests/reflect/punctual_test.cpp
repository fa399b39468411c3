// Tests of lights without a surface (KHR_lights_punctual) against known answers, and of
// rasterisation against ray tracing.
#include "support/lit.hpp"
#include "support/special_values.hpp"

#include <iostream>
#include <numbers>

namespace {

using namespace catoptric;
using Kind = scene::PunctualLight::Kind;

constexpr uvec2 kPunctualPictureSize{32, 32};

/// Returns the cosine of an angle in degrees.
double cosine_of_degrees(double angle) { return std::cos(glm::radians(angle)); }

/// A light over a floor that the camera sees from straight above.
struct PunctualCase {
    const char* name;
    scene::PunctualLight light;
    dvec3 from, axis;
    friend void PrintTo(const PunctualCase& test_case, std::ostream* out) {
        *out << test_case.name;
    }
};

/// Returns the light that falls on the floor at a place, as KHR_lights_punctual specifies.
double floor_illuminance(const PunctualCase& lit, const dvec3& place) {
    if (lit.light.kind == Kind::directional) return -glm::normalize(lit.axis).y;
    const dvec3 to_light = lit.from - place;
    const double distance = glm::length(to_light), part = distance / lit.light.range;
    const double cosine = -dot(to_light / distance, glm::normalize(lit.axis));
    const double t = std::clamp((cosine - lit.light.cos_outer) /
                                    std::max(.001, lit.light.cos_inner - lit.light.cos_outer),
                                0.0, 1.0);
    const double cone = lit.light.kind == Kind::spot ? t * t : 1;
    return std::clamp(1 - std::pow(part, 4), 0.0, 1.0) * cone * to_light.y / std::pow(distance, 3);
}

/// Returns the floor and the light, moved away from the origin and `scale` times as large.
/// Intensities in candela grow with the square of the scale.
scene::Scene make_floor_under_light(const PunctualCase& lit, double scale) {
    const dvec3 origin(300, -20, 70);
    scene::Scene scene = test::make_floor_scene();
    scene.objects.front().world_from_object = dmat4(scale);
    scene.objects.front().world_from_object[3] = dvec4(origin, 1);
    scene::PunctualLight light = lit.light;
    light.world_from_light = test::make_light_transform(origin + scale * lit.from, lit.axis);
    light.range *= scale;
    if (light.kind != Kind::directional) light.intensity *= float(scale * scale);
    scene.punctual.push_back(light);
    scene.cameras.push_back({.eye = origin + dvec3(0, 4 * scale, 0),
                             .target = origin,
                             .up = {0, 0, -1},
                             .vertical_fov_degrees = 2 * glm::degrees(std::atan(.49))});
    return scene;
}

class PunctualLightTest : public testing::TestWithParam<PunctualCase> {};
const vec3 kPunctualLightIntensity{9, 7, 5};
INSTANTIATE_TEST_SUITE_P(
    Lights, PunctualLightTest,
    testing::Values(
        PunctualCase{"point", {.intensity = kPunctualLightIntensity}, {.5, 2, .3}, {0, 0, -1}},
        PunctualCase{"point_with_range",
                     {.intensity = kPunctualLightIntensity, .range = 2.4},
                     {-.5, 1.2, .3},
                     {0, 0, -1}},
        PunctualCase{"spot",
                     {.kind = Kind::spot,
                      .intensity = kPunctualLightIntensity,
                      .range = 9,
                      .cos_inner = cosine_of_degrees(12),
                      .cos_outer = cosine_of_degrees(30)},
                     {.4, 2.5, -.3},
                     {-.3, -1, .2}},
        PunctualCase{"spot_without_penumbra",
                     {.kind = Kind::spot,
                      .intensity = kPunctualLightIntensity,
                      .cos_inner = cosine_of_degrees(25),
                      .cos_outer = cosine_of_degrees(25)},
                     {.4, 2.5, -.3},
                     {0, -1, 0}},
        PunctualCase{"directional",
                     {.kind = Kind::directional, .intensity = {.9f, .7f, .5f}},
                     {0, 1, 0},
                     {.5, -1, .2}}),
    [](const auto& instance) { return std::string(instance.param.name); });

TEST_P(PunctualLightTest, FloorIsLitAsSpecified) {
    const PunctualCase& lit = GetParam();
    for (const double scale : {1.0, 37.0}) {
        const scene::Scene scene = make_floor_under_light(lit, scale);
        for (const std::string technique : {"raytrace", "naive:bounces=0", "raytrace:shadow=map"}) {
            const measure::Picture picture =
                test::render_without_ambient(scene, technique, kPunctualPictureSize).hdr;
            double worst = 0, brightest = 0, darkest = 1e9;
            for (int y = 0; y < picture.height; ++y)
                for (int x = 0; x < picture.width; ++x) {
                    const dvec3 place(1.96 * ((x + .5) / 16 - 1), 0, 1.96 * ((y + .5) / 16 - 1));
                    const double arrives = floor_illuminance(lit, place);
                    const dvec3 wanted = dvec3(.6, .5, .4) / test::kPi *
                                         dvec3(lit.light.intensity) * arrives;
                    worst = std::max(worst, glm::length(dvec3(picture.at(x, y)) - wanted));
                    brightest = std::max(brightest, wanted.x),
                    darkest = std::min(darkest, wanted.x);
                }
            std::cout << "[ MEASURED ] " << technique << ", " << scale << ": worst " << worst
                      << " of " << darkest << " to " << brightest << "\n";
            // At the edge of a spot without penumbra, light falls to 0 within a hundredth of a
            // pixel, and snapped vertices shift positions by a 512th.
            const bool on_edge = lit.light.cos_inner == lit.light.cos_outer &&
                                 !test::computes_like_cpp();
            EXPECT_LE(worst, (on_edge ? .1 : 1e-3) * brightest) << technique << ", scale " << scale;
        }
    }
}

TEST_P(PunctualLightTest, ShadowsAreTheSameInRasterAndRays) {
    scene::Scene scene = test::make_yard_scene();
    const PunctualCase& lit = GetParam();
    scene::PunctualLight light = lit.light;
    light.world_from_light = test::make_light_transform(lit.from + dvec3(0, .5, 0), lit.axis);
    scene.punctual.push_back(light);
    const double off = test::share_off_in_raster_picture(scene, {128, 128});
    std::cout << "[ MEASURED ] share off " << off << "\n";
    EXPECT_LE(off, .005);
    // The scene must contain shadows.
    const measure::Picture
        shadowed = test::render_without_ambient(scene, "raytrace", {64, 64}).hdr,
        lit_up = test::render_without_ambient(scene, "raytrace:shadow=none", {64, 64}).hdr;
    EXPECT_GT(test::share_of_off_pixels(shadowed, lit_up, measure::Mask(64 * 64, 0)), .01);
}

/// Renders the floor lit by all of these lights.
measure::Picture render_floor_under_lights(const std::vector<PunctualCase>& all,
                                           const std::string& technique) {
    scene::Scene scene = make_floor_under_light(all.front(), 1);
    for (std::size_t i = 1; i < all.size(); ++i)
        scene.punctual.push_back(make_floor_under_light(all[i], 1).punctual.front());
    return test::render_without_ambient(scene, technique, kPunctualPictureSize).hdr;
}

// One light and several lights are drawn by different shader variants.
TEST(Lights, SeveralLightsAddUp) {
    const std::vector<PunctualCase> all{
        {"near", {.intensity = kPunctualLightIntensity}, {.5, 2, .3}, {0, 0, -1}},
        {"sun", {.kind = Kind::directional, .intensity = {.4f, .5f, .6f}}, {0, 1, 0}, {.5, -1, 0}},
        {"far", {.intensity = 2.f * kPunctualLightIntensity}, {-1, 3, -.5}, {0, 0, -1}}};
    for (const std::string technique : {"raytrace", "naive:bounces=0"}) {
        std::vector<measure::Picture> alone;
        for (const PunctualCase& light : all)
            alone.push_back(render_floor_under_lights({light}, technique));
        const measure::Picture together = render_floor_under_lights(all, technique);
        for (int y = 0; y < together.height; ++y)
            for (int x = 0; x < together.width; ++x) {
                dvec3 sum(0);
                for (const measure::Picture& picture : alone) sum += dvec3(picture.at(x, y));
                EXPECT_LE(glm::length(dvec3(together.at(x, y)) - sum), 1e-6 * glm::length(sum))
                    << technique << " at " << x << ", " << y;
            }
    }
}

// Objects far outside the main part of the scene must also cast and receive shadows.
TEST(Directional, LightReachesObjectsFarFromTheSceneCore) {
    scene::Scene scene = test::make_yard_scene();
    const std::size_t grey = scene.objects.front().material;
    for (const double x : {-60.0, 50.0}) {
        test::add_quad(scene, "far", grey, {x - 2, 0, 2}, {x + 2, 0, 2}, {x + 2, 0, -2},
                       {x - 2, 0, -2});
        test::add_quad(scene, "roof", grey, {x - 1, 1, 1}, {x + 1, 1, 1}, {x + 1, 1, -1},
                       {x - 1, 1, -1});
    }
    scene.punctual.push_back(
        {.kind = Kind::directional,
         .intensity = vec3(1.5f),
         .world_from_light = test::make_light_transform({0, 0, 0}, {.4, -1, -.3})});
    for (const double x : {-60.0, 0.0, 50.0}) {
        scene.cameras.front() = {
            .eye = {x + 1, 2.5, 4}, .target = {x, .3, 0}, .vertical_fov_degrees = 50};
        const double off = test::share_off_in_raster_picture(scene, {96, 96});
        std::cout << "[ MEASURED ] at " << x << ": share off " << off << "\n";
        EXPECT_LE(off, .005) << "at " << x;
    }
}

} // namespace
