#pragma once

#include "../core/export.hpp"
#include "picture.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>

// Picture files. All errors name the file. A missing file is `Failure::missing_input` and a file
// that is no such picture is `bad_data`. Errors of output are those of core/file.hpp.
namespace catoptric::measure {

/// Largest picture that is read unless the caller says otherwise: 2^29 values, 2 GiB of float.
constexpr std::uint64_t kMostValues = std::uint64_t{1} << 29;

/// Reads a picture row by row as linear RGB. Values of an OpenEXR (half or float) are taken as they
/// are, including infinities and NaN. The reader also takes a Radiance .hdr or a PNG (8 or 16 bit).
/// A PNG is always decoded with the sRGB curve, whatever its gamma chunk says. Grey becomes RGB.
/// Alpha and further channels are left out.
class PictureReader {
public:
    /// Refuses a picture by its width and height: throws if they are not accepted.
    using Judge = std::function<void(int, int)>;

    /// Reads only the header and checks it against `judge`, `kMostValues`, and whether a file of
    /// this size can hold so many values. Memory for the picture is allocated after these checks.
    CATOPTRIC_API explicit PictureReader(const std::filesystem::path& path,
                                         const Judge& judge = {});
    CATOPTRIC_API ~PictureReader();
    CATOPTRIC_API PictureReader(PictureReader&&) noexcept;
    CATOPTRIC_API PictureReader& operator=(PictureReader&&) noexcept;

    CATOPTRIC_API int width() const;
    CATOPTRIC_API int height() const;
    CATOPTRIC_API std::string format() const; ///< "OpenEXR", "Radiance" or "PNG"
    /// Fills `pixels` with as many whole rows as it holds, beginning at row `first`. Each call must
    /// continue where the last one ended.
    CATOPTRIC_API void read_rows(int first, std::span<vec3> pixels);

private:
    struct Open;
    std::unique_ptr<Open> open_;
};

/// Reads a whole picture. `judge` may refuse it by its size.
CATOPTRIC_API Picture read_picture(const std::filesystem::path& path,
                                   const PictureReader::Judge& judge = {});

/// Returns whether a file begins with the signature of a PNG.
CATOPTRIC_API bool is_png(const std::filesystem::path& path);

/// Reads a mask from a PNG. A pixel counts (255) if a colour channel is not zero; alpha is ignored.
/// `width` and `height` are those of the pictures. Throws `bad_data` if the mask has another size.
CATOPTRIC_API Mask read_mask(const std::filesystem::path& path, int width, int height);

/// Returns an OpenEXR file: 32-bit float R, G, B with each value bit-exact. The same picture always
/// gives the same bytes, because the date in the header is fixed.
CATOPTRIC_API std::string exr_bytes(const Picture& picture);
/// Returns a PNG file with 8 bits a channel. Values must already be as displayed (see
/// `to_display`). Others are clamped to [0,1] and NaN becomes 0. The same picture gives the same
/// bytes.
CATOPTRIC_API std::string png_bytes(const Picture& display);

/// Write these files. A file is replaced as a whole or not at all.
CATOPTRIC_API void write_exr(const Picture& picture, const std::filesystem::path& path);
CATOPTRIC_API void write_png(const Picture& display, const std::filesystem::path& path);

} // namespace catoptric::measure
