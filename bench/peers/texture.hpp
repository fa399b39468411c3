#pragma once

#include "whitted.hpp"

#include <cmath>

namespace peers {

/// The two texels whose centres lie on both sides of a texture coordinate, and the weight of the
/// second texel. The axis has `size` texels and repeats.
struct Between {
    int first, second;
    float share;

    Between(float u, int size) {
        const float place = (u - std::floor(u)) * static_cast<float>(size) - .5F;
        const float below = std::floor(place);
        share = place - below;
        first = (static_cast<int>(below) + size) % size;
        second = (first + 1) % size;
    }
};

inline Vector mix(const Vector& a, const Vector& b, float share) {
    return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), a.z + share * (b.z - a.z)};
}

inline Vector colour_at(const Texture& texture, Place place) {
    const Between across(place.u, texture.width), down(place.v, texture.height);
    const auto row = [&](int y) {
        const Vector* const texels =
            &texture.texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(texture.width)];
        return mix(texels[across.first], texels[across.second], across.share);
    };
    return mix(row(down.first), row(down.second), down.share);
}

} // namespace peers
