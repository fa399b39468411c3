#pragma once

#include "../core/math.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace catoptric::scene {

/// A decoded picture: 8 bits a channel as the file has them, red in the low byte, then green, blue,
/// alpha; row-major from the top row.
struct Image {
    std::string name;
    uvec2 size{0};
    std::vector<std::uint32_t> texels; ///< size.x * size.y
};

/// How a surface reads an image. The centre of texel (i, j) lies at ((i + .5) / width, (j + .5) /
/// height) of the texture space, v downwards as in glTF.
struct Texture {
    enum class Wrap { repeat, mirrored, clamp };
    std::shared_ptr<const Image> image; ///< never null
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    bool nearest = false;     ///< the nearest texel; else four, bilinear
    bool srgb = false;        ///< red, green and blue are decoded, each texel before it is filtered
    std::uint32_t uv_set = 0; ///< 0 or 1: of Mesh::uv
    /// KHR_texture_transform: texture space from the mesh's (u, v, 1).
    vec3 u_row{1, 0, 0}, v_row{0, 1, 0};
    bool operator==(const Texture&) const = default;
};

} // namespace catoptric::scene
