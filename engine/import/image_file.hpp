#pragma once

#include "import/budget.hpp"
#include "scene/material.hpp"

#include <memory>
#include <string>
#include <string_view>

namespace catoptric::scene {

/// Decodes a picture of a scene from the bytes of its file. Returns null for an unsupported format.
/// `file` is the file's name and may be empty. A TARGA file is recognised only by the end of its
/// name. Throws `bad_data`, beginning with `place`, for a picture that cannot be decoded. A side
/// above 65535 texels, or more texels than the budget, is refused before decoding. `is_light`: the
/// texels are sRGB colours. Files of floats hold linear light and are encoded then, clamped to 1.
std::shared_ptr<const Image> decode_image(std::string_view bytes, const std::string& file,
                                          const std::string& place, LoadAccount& account,
                                          bool is_light = true);

std::string encode_png(const Image& image);

} // namespace catoptric::scene
