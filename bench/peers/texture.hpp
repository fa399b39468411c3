#pragma once

#include "whitted.hpp"

#include <cmath>

namespace peers {

/// The two texels whose centres lie on both sides of a texture coordinate, and the weight of the
/// second texel. The axis has `size` texels and repeats.
struct BilinearTexelPair {
    int first, second;
    float share;

    BilinearTexelPair(float u, int size) {
        const float place = (u - std::floor(u)) * static_cast<float>(size) - .5F;
        const float below = std::floor(place);
        share = place - below;
        first = (static_cast<int>(below) + size) % size;
        second = (first + 1) % size;
    }
};

inline PeerVector interpolate_vectors(const PeerVector& a, const PeerVector& b, float share) {
    return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), a.z + share * (b.z - a.z)};
}

inline PeerVector sample_texture_bilinear(const PeerTexture& texture, TextureCoordinates place) {
    const BilinearTexelPair across(place.u, texture.width), down(place.v, texture.height);
    const auto row = [&](int y) {
        const PeerVector* const texels =
            &texture.texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(texture.width)];
        return interpolate_vectors(texels[across.first], texels[across.second], across.share);
    };
    return interpolate_vectors(row(down.first), row(down.second), down.share);
}

} // namespace peers
