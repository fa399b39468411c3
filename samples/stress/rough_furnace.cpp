// Property of rough surfaces in a white environment: they reflect the albedo of their lobe.
#include "stress/lobe_albedo.hpp"
#include "stress/property.hpp"
#include "stress/rough_floor.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace catoptric::stress {

namespace {

constexpr double kViewAnglesDegrees[] = {30, 80};

void judge_metal_furnace(Bench& bench, double degrees) {
    std::array<double, kFloorStripRoughness.size()> albedo{};
    for (std::size_t i = 0; i < albedo.size(); ++i)
        albedo[i] = lobe_albedo(kFloorStripRoughness[i], degrees);
    const scene::Scene metal = make_rough_floor(make_white_metal(), degrees, true);
    for (const char* technique :
         {"raytrace:rays=16", "reuse:face=16", "pyramid:face=16,rough=rays,rays=16"}) {
        const auto found = measure_strips(bench, metal, technique);
        for (std::size_t i = 0; i < found.size(); ++i)
            bench.add_case(fmt::format("metal of roughness {} at {} degrees, {}: off {:.4f} by",
                                       kFloorStripRoughness[i], degrees, technique, albedo[i]),
                           std::abs(found[i] - albedo[i]), .005);
    }
}

/// A technique, whether the rough surfaces are mirrors, and the largest allowed difference from
/// white.
struct PlasticFurnaceRow {
    const char* technique;
    bool is_mirror;
    double tolerance;
};

void judge_plastic_furnace(Bench& bench, double degrees) {
    for (const auto& [technique, is_mirror, tolerance] :
         {PlasticFurnaceRow{"raytrace:rays=16", false, .005},
          PlasticFurnaceRow{"naive:bounces=0", false, .001},
          PlasticFurnaceRow{"reuse:face=16", true, .001}}) {
        const auto found = measure_strips(
            bench, make_rough_floor(make_white_plastic(), degrees, is_mirror), technique);
        for (std::size_t i = 0; i < found.size(); ++i)
            bench.add_case(fmt::format("plastic of roughness {} at {} degrees, {}: off 1 by",
                                       kFloorStripRoughness[i], degrees, technique),
                           std::abs(found[i] - 1), tolerance);
    }
}

void judge_rough_furnace(Bench& bench) {
    for (const double degrees : kViewAnglesDegrees) {
        judge_metal_furnace(bench, degrees);
        judge_plastic_furnace(bench, degrees);
    }
}

const RegisteredProperty kRoughFurnaceProperty{
    {"S1", "metal and white plastic of roughness .05 to 1, all around is white",
     "metal shows the albedo of its lobe, by quadrature; plastic is white", judge_rough_furnace,
     "alpha_squared_twice"}};

} // namespace

} // namespace catoptric::stress
