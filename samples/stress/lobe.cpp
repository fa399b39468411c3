// Stress properties of the specular lobe of rough surfaces (shaders/lib/math/lobe.glsl): viewer and
// light may change places, and grazing directions keep their precision.
#include "core/shader_math.hpp"
#include "shared.h"
#include "stress/lobe_albedo.hpp"
#include "stress/property.hpp"
#include "stress/rough_floor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace catoptric::stress {

namespace {

constexpr double kMostGrazingDegrees = 89.99;
constexpr float kTestReflectanceF0 = .3f; // f0 of a surface whose reflectance depends on the angle

/// Draws a direction between these angles, in degrees, to the normal. Computed in the type of
/// `Vector`, because GCC 12 may drop a rounding from double to float and back.
template <typename Vector>
Vector random_direction(Bench& bench, double least_degrees, double most_degrees) {
    using Real = typename Vector::value_type;
    const Real angle(Real(bench.random(least_degrees, most_degrees)) * std::numbers::pi_v<Real> /
                     180),
        turn(Real(bench.random(0, 2 * std::numbers::pi)));
    return Vector(std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn),
                  std::cos(angle));
}

/// Returns the difference of two values over the larger of them.
double relative_difference(double a, double b) {
    return a == b ? 0 : std::abs(a - b) / std::max(std::abs(a), std::abs(b));
}

constexpr int kDirectionPairs = 20'000;

/// Returns the largest relative difference of `reflect` with viewer and light exchanged. Half of
/// the pairs have a light less than a degree above the surface. `reflect(alpha, to_eye, to_light)`
/// returns the reflectance of the lobe per steradian.
template <typename Vector, typename Reflect>
double reciprocity_error(Bench& bench, const Reflect& reflect) {
    using Real = typename Vector::value_type;
    double largest = 0;
    for (int k = 0; k < kDirectionPairs; ++k) {
        const Real roughness(Real(bench.random(shared::kMaxSharpRoughness, 1))),
            alpha(roughness * roughness);
        const auto a = random_direction<Vector>(bench, 0, kMostGrazingDegrees),
                   b = random_direction<Vector>(bench, k % 2 == 0 ? 0 : 89, kMostGrazingDegrees);
        largest = std::max(largest, relative_difference(double{reflect(alpha, a, b)},
                                                        double{reflect(alpha, b, a)}));
    }
    return largest;
}

void judge_lobe_reciprocity(Bench& bench) {
    const auto in_doubles = [](double alpha, const dvec3& to_eye, const dvec3& to_light) {
        return f64::evaluate_lobe(alpha, dvec3(kTestReflectanceF0), dvec3(1), to_eye, to_light).x /
               to_light.z;
    };
    const auto in_floats = [](float alpha, const f32::vec3& to_eye, const f32::vec3& to_light) {
        return f32::evaluate_lobe(alpha, f32::vec3(kTestReflectanceF0), f32::vec3(1), to_eye,
                                  to_light)
                   .x /
               to_light.z;
    };
    bench.add_case(fmt::format("{} pairs in doubles: largest relative difference", kDirectionPairs),
                   reciprocity_error<dvec3>(bench, in_doubles), 1e-9);
    bench.add_case(fmt::format("{} pairs in floats: largest relative difference", kDirectionPairs),
                   reciprocity_error<f32::vec3>(bench, in_floats), .001);
}

/// Largest differences, over all directions tried, between the lobe in floats and in doubles.
struct GrazingLobeErrors {
    double values_wrong = 0; // values that are negative or not finite
    double lobe = 0, weight = 0;

    void add_error(double& largest, float found, double wanted) {
        values_wrong += !(found >= 0 && std::isfinite(found));
        largest = std::max(largest, relative_difference(double{found}, wanted));
    }
};

void judge_grazing_lobe(Bench& bench, double roughness, double degrees) {
    constexpr int kRandomDrawCount = 4096;
    const float alpha = f32::roughness_to_alpha(float(roughness));
    const f32::vec3 f0(kTestReflectanceF0), f90(1);
    GrazingLobeErrors errors;
    for (int k = 0; k < kRandomDrawCount; ++k) {
        const auto to_eye = random_direction<f32::vec3>(bench, degrees, degrees);
        // Some light directions lie opposite to the viewer, where a narrow lobe is brightest.
        const auto anywhere = random_direction<f32::vec3>(bench, k % 2 == 0 ? 0 : 89,
                                                          kMostGrazingDegrees);
        const f32::vec3 opposite = normalize(
            f32::vec3(-to_eye.x, -to_eye.y, float(bench.random(1e-4, 4e-3))));
        for (const f32::vec3& to_light : {anywhere, opposite})
            errors.add_error(
                errors.lobe, f32::evaluate_lobe(alpha, f0, f90, to_eye, to_light).x,
                f64::evaluate_lobe(alpha, dvec3(f0), dvec3(f90), dvec3(to_eye), dvec3(to_light)).x);
        const f32::vec3 drawn = f32::sample_lobe(alpha, to_eye, float(bench.random(0, 1)),
                                                 float(bench.random(0, 1)));
        errors.add_error(
            errors.weight, f32::lobe_sample_weight(alpha, f0, f90, to_eye, drawn).x,
            f64::lobe_sample_weight(alpha, dvec3(f0), dvec3(f90), dvec3(to_eye), dvec3(drawn)).x);
    }
    const std::string what = fmt::format("roughness {:.3g}", roughness);
    bench.add_case(what + ": values that are negative or no numbers", errors.values_wrong, 0);
    bench.add_case(what + ": relative error of the lobe in floats", errors.lobe, 1e-5);
    bench.add_case(what + ": relative error of weights in floats", errors.weight, 1e-5);
}

void judge_grazing_reflection(Bench& bench) {
    constexpr double kMaxLobeDegrees = 89.9;
    for (const double roughness : {0., 1e-8, 1e-4, double{shared::kMaxSharpRoughness}})
        judge_grazing_lobe(bench, roughness, kMaxLobeDegrees);
    for (const double roughness : kFloorStripRoughness)
        judge_grazing_lobe(bench, roughness, kMaxLobeDegrees);
    const scene::Scene floor = make_rough_floor(make_white_metal(), kMaxLobeDegrees, true);
    for (const auto& [technique, tolerance] :
         {std::pair("raytrace:rays=16", .005), std::pair("reuse:face=16", .03)}) {
        const auto found = measure_strips(bench, floor, technique);
        for (std::size_t i = 0; i < found.size(); ++i)
            bench.add_case(
                fmt::format("roughness {}, {}: off the albedo by", kFloorStripRoughness[i],
                            technique),
                std::abs(found[i] - lobe_albedo(kFloorStripRoughness[i], kMaxLobeDegrees)),
                tolerance);
    }
}

const RegisteredProperty kReciprocityProperty{
    {"S3", "drawn pairs of directions, half of them less than a degree above the surface",
     "the lobe stays if viewer and light change places", judge_lobe_reciprocity,
     "fresnel_by_viewer"}};
const RegisteredProperty kGrazingProperty{{"S4", "rough surfaces at 89.9 degrees",
                                           "finite, not negative, as in doubles",
                                           judge_grazing_reflection, "density_by_cosine"}};

} // namespace

} // namespace catoptric::stress
