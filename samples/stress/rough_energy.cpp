// Property of rough surfaces: they never reflect more light than arrives.
#include "core/shader_math.hpp"
#include "stress/property.hpp"
#include "stress/rough_floor.hpp"
#include "stress/scenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace catoptric::stress {

namespace {

/// Judges the lobe itself, for surfaces with a reflectance of 1.
void judge_lobe_energy(StressBench& bench) {
    constexpr double kAngles[] = {0, 30, 60, 75, 85, 89, 89.9, 89.999};
    constexpr double kRoughnesses[] = {0, 1e-8, 1e-4, .01, .041, .1, .2, .3, .5, .7, .9, 1};
    constexpr int kDraws = 4096, kEdge = 64;
    double largest_weight = 0, largest_albedo = 0;
    for (const double roughness : kRoughnesses)
        for (const double degrees : kAngles) {
            const float alpha = f32::roughness_to_alpha(float(roughness));
            const double angle = degrees * std::numbers::pi / 180;
            const f32::vec3 to_eye(float(std::sin(angle)), 0, float(std::cos(angle)));
            double head_on, grazing;
            f64::lobe_albedo_terms(alpha, to_eye.z, kEdge, head_on, grazing);
            largest_albedo = std::max(largest_albedo, head_on + grazing);
            for (int k = 0; k < kDraws; ++k) {
                const f32::vec3 to_light = f32::sample_lobe(alpha, to_eye,
                                                            float(bench.random_between(0, 1)),
                                                            float(bench.random_between(0, 1)));
                const float weight =
                    f32::lobe_sample_weight(alpha, f32::vec3(1), f32::vec3(1), to_eye, to_light).x;
                largest_weight = std::max(largest_weight, double{weight});
            }
        }
    bench.add_case("largest share of light that a lobe reflects", largest_albedo, 1 + 1e-5);
    bench.add_case("largest share of light that a drawn ray brings", largest_weight, 1 + 1e-5);
}

/// Returns metal balls of different roughness that reflect each other, in a furnace.
scene::Scene make_rough_balls() {
    scene::Scene scene = make_furnace({});
    scene.mirror_max_roughness = 1;
    for (std::size_t i = 0; i < kStripRoughness.size(); ++i) {
        scene::Material metal = make_white_metal();
        metal.roughness = float(kStripRoughness[i]);
        add_stress_ball(scene, add_material(scene, metal),
                        {{1.1 * double(i % 4) - 1.65, i < 4 ? -.55 : .55, 1}, .53}, 3);
        scene.objects.back().mirror = true;
    }
    return scene;
}

void judge_rough_energy(StressBench& bench) {
    judge_lobe_energy(bench);
    const scene::Scene scene = make_rough_balls();
    for (const char* technique :
         {"raytrace", "raytrace:rays=4", "raytrace:rays=4,first=raster", "reuse:face=32",
          "parallax:face=32,rough=mips", "pyramid:face=32,rough=rays,rays=4", "hybrid:face=32"}) {
        app::Request request = bench.make_request(scene, technique, 3);
        request.size = {96, 96};
        request.ambient = 0;
        bench.add_case(fmt::format("{}: brightest of 1", technique),
                       brightest_channel(bench.render(request).hdr), 1.0001);
    }
}

const RegisteredProperty kRoughEnergyProperty{
    {"S2", "roughness 0 to 1, seen at 0 to 89.999 degrees; metal balls in a furnace",
     "no lobe, drawn ray or pixel is brighter than what arrives", judge_rough_energy,
     "masking_left_out"}};

} // namespace

} // namespace catoptric::stress
