// Property of rough surfaces: they never reflect more light than arrives.
#include "core/shader_math.hpp"
#include "measure/picture.hpp"
#include "stress/property.hpp"
#include "stress/rough_floor.hpp"
#include "stress/scenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

namespace catoptric::stress {

namespace {

/// Judges the lobe itself, for surfaces with a reflectance of 1.
void judge_lobe_energy(Bench& bench) {
    constexpr double kViewAnglesDegrees[] = {0, 30, 60, 75, 85, 89, 89.9, 89.999};
    constexpr double kTestRoughnesses[] = {0, 1e-8, 1e-4, .01, .041, .1, .2, .3, .5, .7, .9, 1};
    constexpr int kRandomDrawCount = 4096, kEdge = 64;
    double largest_weight = 0, largest_albedo = 0;
    for (const double roughness : kTestRoughnesses)
        for (const double degrees : kViewAnglesDegrees) {
            const float alpha = f32::roughness_to_alpha(float(roughness));
            const double angle = degrees * std::numbers::pi / 180;
            const f32::vec3 to_eye(float(std::sin(angle)), 0, float(std::cos(angle)));
            double head_on, grazing;
            f64::lobe_albedo_terms(alpha, to_eye.z, kEdge, head_on, grazing);
            largest_albedo = std::max(largest_albedo, head_on + grazing);
            for (int k = 0; k < kRandomDrawCount; ++k) {
                const f32::vec3 to_light = f32::sample_lobe(
                    alpha, to_eye, float(bench.random(0, 1)), float(bench.random(0, 1)));
                const float weight =
                    f32::lobe_sample_weight(alpha, f32::vec3(1), f32::vec3(1), to_eye, to_light).x;
                largest_weight = std::max(largest_weight, double{weight});
            }
        }
    bench.add_case("largest share of light that a lobe reflects", largest_albedo, 1 + 1e-5);
    bench.add_case("largest share of light that a drawn ray brings", largest_weight, 1 + 1e-5);
}

/// Returns the furnace without its glowing walls, below an environment of the same light.
scene::Scene make_sky_furnace() {
    scene::Scene scene = make_white_furnace({});
    scene.objects.clear();
    auto sky = std::make_shared<scene::Environment>();
    sky->name = "white", sky->size = {2, 1}, sky->texels = {vec3(1), vec3(1)};
    scene.environment = std::move(sky);
    return scene;
}

/// Adds metal balls of different roughness that reflect each other to a furnace.
scene::Scene add_rough_balls(scene::Scene scene) {
    scene.mirror_max_roughness = 1;
    for (std::size_t i = 0; i < kFloorStripRoughness.size(); ++i) {
        scene::Material metal = make_white_metal();
        metal.roughness = float(kFloorStripRoughness[i]);
        add_ball(scene, add_material(scene, metal),
                 {{1.1 * double(i % 4) - 1.65, i < 4 ? -.55 : .55, 1}, .53}, 3);
        scene.objects.back().mirror = true;
    }
    return scene;
}

double picture_mean(const measure::Picture& picture) {
    return measure::mean_of(picture, measure::ValueRange::unclamped).all;
}

void judge_rough_energy(Bench& bench) {
    judge_lobe_energy(bench);
    const auto render = [&](const scene::Scene& scene, const char* technique) {
        session::Request request = bench.make_request(scene, technique, 3);
        request.size = {96, 96};
        request.ambient = 0;
        return bench.render_technique(request).hdr;
    };
    const scene::Scene walls = add_rough_balls(make_white_furnace({})),
                       sky = add_rough_balls(make_sky_furnace());
    for (const char* technique :
         {"raytrace", "raytrace:rays=4,lamps=met", "raytrace:rays=4,lamps=met,first=raster",
          "reuse:face=32", "parallax:face=32,rough=mips", "pyramid:face=32,rough=rays,rays=4"})
        bench.add_case(fmt::format("{}: brightest of 1", technique),
                       brightest_channel(render(walls, technique)), 1.0001);
    for (const char* technique : {"raytrace:rays=4", "hybrid:face=32"})
        bench.add_case(fmt::format("{}, light of a sky: brightest of 1", technique),
                       brightest_channel(render(sky, technique)), 1.0001);
    // With rays to lamps, pixels have noise above and below the mean. Only the mean must stay below
    // the bound.
    bench.add_case("raytrace:rays=4: difference of the means with lamps sampled and met",
                   std::abs(picture_mean(render(walls, "raytrace:rays=4")) -
                            picture_mean(render(walls, "raytrace:rays=4,lamps=met"))),
                   .005);
}

const RegisteredProperty kRoughEnergyProperty{
    {"S2", "roughness 0 to 1, seen at 0 to 89.999 degrees; metal balls in a furnace",
     "no lobe, drawn ray or pixel is brighter than what arrives", judge_rough_energy,
     "masking_left_out"}};

} // namespace

} // namespace catoptric::stress
