#include "measure/lookup.hpp"

#include "measure/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace catoptric::measure {

LookupError lookup_error(std::span<const LookedUp> pixels) {
    LookupError error;
    error.pixels = pixels.size();
    if (pixels.empty()) return error;
    std::vector<double> angles;
    for (const LookedUp& pixel : pixels) angles.push_back(pixel.angle_degrees);
    const auto count = static_cast<double>(pixels.size());
    const auto share = [&](auto&& is) {
        return static_cast<double>(std::ranges::count_if(pixels, is)) / count;
    };
    error.mean_degrees = std::accumulate(angles.begin(), angles.end(), 0.0) / count;
    error.p95_degrees = percentile(angles, 0.95);
    error.p99_degrees = percentile(angles, 0.99);
    error.wrong_object = share([](const LookedUp& pixel) { return pixel.wrong_object; });
    error.unknown = share([](const LookedUp& pixel) { return pixel.state == 1; });
    error.miss = share([](const LookedUp& pixel) { return pixel.state == 2; });
    std::vector<double> residuals;
    for (const LookedUp& pixel : pixels)
        if (pixel.state == 0) residuals.push_back(pixel.residual);
    if (!residuals.empty()) error.p95_residual = percentile(std::move(residuals), 0.95);
    return error;
}

double angle_degrees(const dvec3& a, const dvec3& b) {
    return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

} // namespace catoptric::measure
