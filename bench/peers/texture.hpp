#pragma once

#include "whitted.hpp"

#include <cmath>

namespace peers {

/// The two texels whose centres lie on both sides of a texture coordinate, and the weight of the
/// second texel. The axis has `size` texels and repeats.
struct BilinearTexelIndexPair {
    int first, second;
    float share;

    BilinearTexelIndexPair(float u, int size) {
        const float place = (u - std::floor(u)) * static_cast<float>(size) - .5F;
        const float below = std::floor(place);
        share = place - below;
        first = (static_cast<int>(below) + size) % size;
        second = (first + 1) % size;
    }
};

inline PeerVector3 interpolate_vectors(const PeerVector3& a, const PeerVector3& b, float share) {
    return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), a.z + share * (b.z - a.z)};
}

inline PeerVector3 sample_texture_bilinear(const PeerAlbedoTexture& texture, UvCoordinates place) {
    const BilinearTexelIndexPair across(place.u, texture.width), down(place.v, texture.height);
    const auto row = [&](int y) {
        const PeerVector3* const texels =
            &texture.texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(texture.width)];
        return interpolate_vectors(texels[across.first], texels[across.second], across.share);
    };
    return interpolate_vectors(row(down.first), row(down.second), down.share);
}

} // namespace peers
