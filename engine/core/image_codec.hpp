#pragma once

#include "core/math.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// Pictures as files have them, in memory. All but the writing of PNG is OpenImageIO's, in a module
// that is loaded when it is first asked for (core/image_module.hpp); `internal` where that is
// missing.
namespace catoptric {

/// What the bytes begin as: "png", "jpeg", "openexr", "hdr", "bmp", "gif", "tiff", "webp", "dds",
/// "psd"; empty for something else. A TARGA has no beginning of its own: see `ImageReader`.
std::string image_format(std::string_view bytes);

/// Of a picture of `channel_count` values a pixel, row-major from the top.
struct ImageShape {
    uvec2 size{0};
    std::size_t channel_count = 0;
    std::vector<std::string> channels; ///< their names: "R", "G", "B", "A", "Y" ...
};

/// A picture whose header has been read, and nothing more. `bytes` must live as long.
class ImageReader {
public:
    static constexpr std::uint32_t kLargestSide = 1 << 16;

    /// `format` as OpenImageIO calls it; `name` begins every message. Throws `bad_data` for what
    /// cannot be opened, is not flat, or has no side or one above 65536.
    ImageReader(std::string_view bytes, const std::string& format, std::string name);
    ~ImageReader();

    const ImageShape& shape() const;
    /// All values; colours as stored, not times alpha. Whole numbers become [0,1]; `bytes` are
    /// rounded to 8 bits. Throws `bad_data` for what cannot be decoded.
    std::vector<float> floats();
    std::vector<std::uint8_t> bytes();

private:
    struct Open;
    std::unique_ptr<Open> open_;
};

/// The bytes of an OpenEXR picture of floats, or a PNG of 8 bits, in sRGB, with 1 to 4 channels.
/// Same values, same bytes. Values are as ImageReader gives them.
std::string openexr_bytes(const ImageShape& shape, std::span<const float> values);
std::string png_bytes(const ImageShape& shape, std::span<const std::uint8_t> values);

} // namespace catoptric
