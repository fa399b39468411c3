#pragma once

#include "core/byte_source.hpp"
#include "core/math.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// Pictures in files. PNG is read and written by libpng (core/png.cpp, core/png_read.cpp), the
// colours of OpenEXR files by OpenEXR (core/exr.cpp, core/exr_colours.cpp), everything else by
// OpenImageIO. OpenImageIO is in a module that is loaded at first use (core/image_module.hpp). If
// the module is missing, functions throw `internal`.
namespace catoptric {

/// Returns the format that the first bytes belong to: "png", "jpeg", "openexr", "hdr", "bmp",
/// "gif", "tiff", "webp", "dds" or "psd"; empty if unknown. TARGA files cannot be recognised by
/// their first bytes: see `ImageReader`.
std::string detect_format(std::string_view bytes);

/// The shape of a picture: its size in pixels and `channel_count` values per pixel, row-major from
/// the top.
struct ImageShape {
    uvec2 size{0};
    std::size_t channel_count = 0;
    std::vector<std::string> channels; ///< channel names: "R", "G", "B", "A", "Y" ...
    std::string description;           ///< text in the header of an OpenEXR file; may be empty
    bool is_8_bit = false;             ///< PNG: whether each value is stored in 8 bits or fewer
};

/// Where a picture's values have its colours. `alpha` is `channel_count` if it has none.
struct ColourChannels {
    std::array<std::size_t, 3> rgb; ///< the same three times for grey
    std::size_t alpha;
};
/// Returns the channels named R, G and B, or the grey channel Y. Throws `bad_data`, beginning with
/// `name` and with the names found, for a picture without them, or with two of a name.
ColourChannels find_colour_channels(const ImageShape& shape, const std::string& name);

/// The colours of a picture that a reader takes: of all others in an OpenEXR file, by their layer
/// (core/exr_colours.hpp). `layer`: empty for the file's own choice.
struct ImageColours {
    std::string layer;
};

/// Reads a picture. At first only the header is read. `bytes` must outlive the reader.
class ImageReader {
public:
    static constexpr std::uint32_t kMaxSide = 1 << 16;

    /// Throws if the size or channels that a header claims are not acceptable.
    using ShapeCheck = std::function<void(const ImageShape&)>;

    /// Opens a picture. `format` is OpenImageIO's name of it, and `name` begins every message.
    /// `judge` is called before a decoder, which may allocate memory, is opened, and again with the
    /// decoder's shape. Throws `bad_data` if the picture cannot be opened, is not flat, or has a
    /// side of 0 or more than 65536 pixels. Also throws `bad_data` if the header claims more than a
    /// file of its size can hold. `colours`: take only these, in the picture's display window; else
    /// all channels of the first part of a file.
    ImageReader(const ByteSource& bytes, const std::string& format, std::string name,
                const ShapeCheck& judge = {}, const std::optional<ImageColours>& colours = {});
    ~ImageReader();

    const ImageShape& shape() const;
    /// Returns all values. Colours are as stored, not multiplied by alpha. `floats` maps integers
    /// to [0,1]; `bytes` rounds to 8 bits. Throws `bad_data` if the picture cannot be decoded.
    std::vector<float> floats();
    std::vector<std::uint8_t> bytes();
    /// Fills `values` with as many rows as it holds, from row `first` on. Rows must be read in
    /// rising order: each call continues where the last one ended.
    void read_rows(std::uint32_t first, std::span<float> values);

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Returns the bytes of an OpenEXR file of floats, or of a PNG file of 8 bits in sRGB. A PNG has 1
/// to 4 channels. Without names, an OpenEXR file has 1 to 4 channels as well. Equal values give
/// equal bytes. Values are as ImageReader returns them.
std::string encode_openexr(const ImageShape& shape, std::span<const float> values);
std::string encode_png(const ImageShape& shape, std::span<const std::uint8_t> values);

} // namespace catoptric
