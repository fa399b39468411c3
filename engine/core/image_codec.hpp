#pragma once

#include "core/byte_source.hpp"
#include "core/math.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// Pictures as files have them. PNG is libpng's (core/png.cpp, core/png_read.cpp), the rest is
// OpenImageIO's, in a module that is loaded when it is first asked for (core/image_module.hpp);
// `internal` where that is missing.
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

    /// Refuses a picture by what its header claims, by throwing.
    using Judge = std::function<void(const ImageShape&)>;

    /// `format` as OpenImageIO calls it; `name` begins every message. `judge` is asked before
    /// a decoder is opened, which may allocate, and once more with what the decoder says. Throws
    /// `bad_data` for what cannot be opened, is not flat, has no side or one above 65536, or claims
    /// more than a file of its size can hold.
    ImageReader(const ByteSource& bytes, const std::string& format, std::string name,
                const Judge& judge = {});
    ~ImageReader();

    const ImageShape& shape() const;
    /// All values; colours as stored, not times alpha. Whole numbers become [0,1]; `bytes` are
    /// rounded to 8 bits. Throws `bad_data` for what cannot be decoded.
    std::vector<float> floats();
    std::vector<std::uint8_t> bytes();
    /// Fills `values` with those of as many rows as it holds, from `first` on. Rows are read in
    /// rising order; what one call takes follows on what the call before took.
    void read_rows(std::uint32_t first, std::span<float> values);

private:
    struct Open;
    std::unique_ptr<Open> open_;
};

/// The bytes of an OpenEXR picture of floats, or a PNG of 8 bits, in sRGB, with 1 to 4 channels.
/// Same values, same bytes. Values are as ImageReader gives them.
std::string openexr_bytes(const ImageShape& shape, std::span<const float> values);
std::string png_bytes(const ImageShape& shape, std::span<const std::uint8_t> values);

} // namespace catoptric
