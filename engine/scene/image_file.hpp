#pragma once

#include "scene/account.hpp"
#include "scene/texture.hpp"

#include <memory>
#include <string>
#include <string_view>

namespace catoptric::scene {

/// A picture of a scene from the bytes of its file, or null for a kind of file that is not read.
/// `file` is the file's name, of which a TARGA, that has no other mark, needs its end; may be
/// empty. Throws `bad_data` beginning with `place` for a picture that cannot be decoded, or, before
/// it is, for a side above 65535 texels or more texels than the budget.
std::shared_ptr<const Image> decode_image(std::string_view bytes, const std::string& file,
                                          const std::string& place, Account& account);

/// The bytes of a PNG of it.
std::string png_of(const Image& image);

} // namespace catoptric::scene
