#pragma once

#include "../core/export.hpp"
#include "picture.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>

// Every error names the file: missing input is
// `Failure::missing_input`, input that is no such picture `bad_data`; output as in core/file.hpp.
namespace catoptric::measure {

/// The largest picture that is read unless the caller says otherwise: 2^29 values, 2 GiB of float.
constexpr std::uint64_t kMostValues = std::uint64_t{1} << 29;

/// Reads a picture row by row: linear light from an OpenEXR (half or float, taken as it is,
/// infinities and NaN included), a Radiance .hdr or a PNG (8 or 16 bit, always decoded with the
/// sRGB curve, whatever its gamma chunk says). Grey becomes RGB; alpha and further channels are
/// left out.
class PictureReader {
public:
    /// Refuses a picture by its width and height, by throwing.
    using Judge = std::function<void(int, int)>;

    /// Reads the header alone, and judges by it: `judge`, `kMostValues`, and whether a file of this
    /// size can hold so many values. Memory for the picture is allocated after that.
    CATOPTRIC_API explicit PictureReader(const std::filesystem::path& path,
                                         const Judge& judge = {});
    CATOPTRIC_API ~PictureReader();
    CATOPTRIC_API PictureReader(PictureReader&&) noexcept;
    CATOPTRIC_API PictureReader& operator=(PictureReader&&) noexcept;

    CATOPTRIC_API int width() const;
    CATOPTRIC_API int height() const;
    CATOPTRIC_API std::string format() const; ///< "OpenEXR", "Radiance" or "PNG"
    /// Fills `pixels` with as many rows as it holds, from the row `first` on. Each call continues
    /// where the one before ended.
    CATOPTRIC_API void read_rows(int first, std::span<vec3> pixels);

private:
    struct Open;
    std::unique_ptr<Open> open_;
};

/// The whole of it.
CATOPTRIC_API Picture read_picture(const std::filesystem::path& path,
                                   const PictureReader::Judge& judge = {});

/// Whether a picture file begins as a PNG does.
CATOPTRIC_API bool is_png(const std::filesystem::path& path);

/// A mask from a PNG: a pixel counts (255) if a colour channel is not zero; alpha does not matter.
/// `width` and `height` are those of the pictures it is for; another size is `bad_data`.
CATOPTRIC_API Mask read_mask(const std::filesystem::path& path, int width, int height);

/// OpenEXR: 32-bit float R, G, B, every value bit-exact. The same picture gives the same bytes at
/// all times (the date in the header is fixed).
CATOPTRIC_API std::string exr_bytes(const Picture& picture);
/// PNG: 8 bits a channel, of values already as the screen shows them (see `to_display`); others are
/// clamped to [0,1], NaN to 0. The same picture gives the same bytes.
CATOPTRIC_API std::string png_bytes(const Picture& display);

/// The bytes above, put into place whole or not at all.
CATOPTRIC_API void write_exr(const Picture& picture, const std::filesystem::path& path);
CATOPTRIC_API void write_png(const Picture& display, const std::filesystem::path& path);

} // namespace catoptric::measure
