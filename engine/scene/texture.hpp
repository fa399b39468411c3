#pragma once

#include "../core/math.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace catoptric::scene {

/// Decoded picture: 8 bits a channel, encoded as in the file. Red is in the low byte, then green,
/// blue, alpha. Row-major from the top row.
struct Image {
    std::string name;
    uvec2 size{0};
    std::vector<std::uint32_t> texels; ///< size.x * size.y
};

/// Image with the way in which a surface reads it. The centre of texel (i, j) lies at ((i + .5) /
/// width, (j + .5) / height) of texture space, v downwards as in glTF.
struct Texture {
    enum class Wrap { repeat, mirrored, clamp };
    std::shared_ptr<const Image> image; ///< never null
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    bool nearest = false; ///< true: nearest texel; false: bilinear over four texels
    bool srgb = false;    ///< red, green and blue are sRGB; each texel is decoded, then filtered
    std::uint32_t uv_set = 0; ///< index into Mesh::uv, 0 or 1
    /// Rows of KHR_texture_transform, which maps the mesh's (u, v, 1) to texture space.
    vec3 u_row{1, 0, 0}, v_row{0, 1, 0};
    bool operator==(const Texture&) const = default;
};

} // namespace catoptric::scene
