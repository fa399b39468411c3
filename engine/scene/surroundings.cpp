#include "scene/surroundings.hpp"

#include "core/shader_math.hpp"

#include <cmath>
#include <numbers>

namespace catoptric::scene {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr uvec2 kStudioSize{512, 256},
    kMinIntegrationSize{128, 64}; ///< directions by which a small map is integrated

double rotation_angle(const Environment& environment) {
    return glm::radians(environment.rotation_degrees);
}

/// Returns the unscaled radiance in a direction that is given in the environment's own axes.
dvec3 unrotated_radiance(const Environment& environment, const dvec3& own) {
    if (environment.studio) return dvec3(f64::studio_radiance(own));
    const f64::EnvironmentMapPosition at = f64::direction_to_environment_map(
        own, environment.size.x, environment.size.y);
    const auto texel = [&](std::uint32_t column, std::uint32_t row) {
        return dvec3(environment.texels[std::size_t{row} * environment.size.x + column]);
    };
    return glm::mix(glm::mix(texel(at.left, at.above), texel(at.right, at.above), at.across),
                    glm::mix(texel(at.left, at.below), texel(at.right, at.below), at.across),
                    at.down);
}

/// Returns the polynomials of the nine spherical harmonics.
std::array<double, 9> spherical_harmonics(const dvec3& d) {
    return {1,
            d.y,
            d.z,
            d.x,
            d.x * d.y,
            d.y * d.z,
            3 * d.z * d.z - 1,
            d.x * d.z,
            d.x * d.x - d.y * d.y};
}

/// For each harmonic, its squared normalisation factor times the share of its band that a cosine
/// lobe keeps: pi, 2 pi / 3, pi / 4.
constexpr std::array<double, 9> kHarmonicFactors{1. / 4,   1. / 2,  1. / 2,   1. / 2,  15. / 16,
                                                 15. / 16, 5. / 64, 15. / 16, 15. / 64};

} // namespace

dvec3 environment_radiance(const Environment& environment, const dvec3& direction) {
    const double angle = rotation_angle(environment);
    return environment.scale *
           unrotated_radiance(environment, f64::rotate_to_environment_axes(
                                               direction, std::cos(angle), std::sin(angle)));
}

std::array<dvec3, 9> irradiance_coefficients(const Environment& environment) {
    // In a small map, harmonics and the interpolated light change within a texel.
    const uvec2 map = environment.studio ? kStudioSize : environment.size,
                size = map * ((kMinIntegrationSize + map - 1u) / map);
    const double width = 2 * kPi / size.x, height = kPi / size.y;
    std::array<dvec3, 9> sums{};
    for (std::uint32_t row = 0; row < size.y; ++row) {
        const double polar = height * (row + .5);
        const double solid_angle = width * (std::cos(height * row) - std::cos(height * (row + 1)));
        for (std::uint32_t column = 0; column < size.x; ++column) {
            const double azimuth = width * (column + .5) - kPi;
            const auto at = [&](double turned) {
                return dvec3(std::sin(polar) * std::sin(turned), std::cos(polar),
                             -std::sin(polar) * std::cos(turned));
            };
            const bool is_texel = !environment.studio && size == map; // saves the interpolation
            const dvec3 light = is_texel
                                    ? dvec3(environment.texels[std::size_t{row} * size.x + column])
                                    : unrotated_radiance(environment, at(azimuth));
            const std::array<double, 9> of = spherical_harmonics(
                at(azimuth + rotation_angle(environment)));
            for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += solid_angle * of[i] * light;
        }
    }
    for (std::size_t i = 0; i < sums.size(); ++i)
        sums[i] *= environment.scale * kHarmonicFactors[i];
    return sums;
}

} // namespace catoptric::scene
