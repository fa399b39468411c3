#include "measure/heat.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace catoptric::measure {
namespace {

/// Colours at multiples of one eighth of the map.
constexpr std::size_t kHeatIntervals = 8;
const std::array<vec3, kHeatIntervals + 1> kHeatMapColours = {
    vec3(0.0F, 0.0F, 0.0F),       vec3(0.126F, 0.068F, 0.349F), vec3(0.353F, 0.088F, 0.49F),
    vec3(0.578F, 0.159F, 0.508F), vec3(0.801F, 0.244F, 0.453F), vec3(0.95F, 0.405F, 0.366F),
    vec3(0.986F, 0.617F, 0.418F), vec3(0.984F, 0.815F, 0.556F), vec3(0.99F, 0.99F, 0.78F)};

constexpr vec3 kHeatMapNanColour{0, 1, 1};

} // namespace

vec3 heat_colour(float value) {
    if (std::isnan(value)) return kHeatMapNanColour;
    const float place = glm::clamp(value, 0.0F, 1.0F) * static_cast<float>(kHeatIntervals);
    const std::size_t below = std::min(static_cast<std::size_t>(place), kHeatIntervals - 1);
    return glm::mix(kHeatMapColours[below], kHeatMapColours[below + 1],
                    place - static_cast<float>(below));
}

Picture make_heat_map(std::span<const float> map, int width, int height, float high) {
    Picture picture(width, height);
    check(map.size() == picture.pixels.size(), Failure::internal, "a heat picture of ", width, "x",
          height, " wants as many values, found ", map.size());
    check(high > 0, Failure::internal, "a heat picture wants a top above 0, found ", high);
    for (std::size_t i = 0; i < map.size(); ++i) picture.pixels[i] = heat_colour(map[i] / high);
    return picture;
}

} // namespace catoptric::measure
