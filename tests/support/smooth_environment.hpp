#pragma once

#include "scene/scene.hpp"

#include <cmath>
#include <memory>

namespace test {

/// Returns an environment of bright coloured light without edges, except at its poles.
inline std::shared_ptr<catoptric::scene::Environment> make_smooth_environment() {
    auto map = std::make_shared<catoptric::scene::Environment>();
    map->size = {64, 32};
    for (std::uint32_t row = 0; row < map->size.y; ++row)
        for (std::uint32_t column = 0; column < map->size.x; ++column) {
            const float azimuth = 6.2832f * (float(column) + .5f) / 64;
            const float height = std::cos(3.1416f * (float(row) + .5f) / 32);
            map->texels.push_back(
                {1 + .8f * std::sin(azimuth), .6f + .5f * height, 1 + .9f * std::cos(2 * azimuth)});
        }
    return map;
}

} // namespace test
