#pragma once

#include "../core/export.hpp"
#include "../core/math.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// Pictures, their files and their differences. All errors of files name the file. A missing file
/// is `Failure::missing_input` and a file that is no such picture is `bad_data`.
namespace catoptric::measure {

/// Row-major RGB picture, top row first, linear light, float.
struct Picture {
    int width = 0;
    int height = 0;
    std::vector<vec3> pixels;

    Picture() = default;
    /// Makes a black picture.
    Picture(int columns, int rows)
        : width(columns), height(rows),
          pixels(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), vec3(0)) {}
    vec3& at(int x, int y) { return pixels[index(x, y)]; }
    const vec3& at(int x, int y) const { return pixels[index(x, y)]; }

private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(x);
    }
};

/// Mask with one byte a pixel, row-major; not 0: the pixel counts. Empty: all pixels count.
using Mask = std::vector<std::uint8_t>;

/// Returns the picture as displayed: multiplied by 2^exposure_stops, clamped to [0,1], through the
/// sRGB curve and rounded to 8 bits. Values are in [0,1] (multiples of 1/255). NaN becomes 0.
CATOPTRIC_API Picture to_display(const Picture& picture, double exposure_stops = 0);
/// Returns the same without the rounding to 8 bits. FLIP of two renderings compares these values.
CATOPTRIC_API Picture to_unrounded_display(const Picture& picture, double exposure_stops = 0);

/// Reads a whole picture as linear RGB. Values of an OpenEXR (half or float) are taken as they are,
/// including infinities and NaN. Also reads a Radiance .hdr or a PNG (8 or 16 bit), which is always
/// decoded with the sRGB curve. Grey becomes RGB. Alpha and further channels are left out.
CATOPTRIC_API Picture read_picture(const std::filesystem::path& path);

/// Reads a mask from a PNG. A pixel counts (255) if a colour channel is not zero; alpha is ignored.
/// `width` and `height` are those of the pictures. Throws `bad_data` if the mask has another size.
CATOPTRIC_API Mask read_mask(const std::filesystem::path& path, int width, int height);

/// Returns an OpenEXR file: 32-bit float R, G, B with each value bit-exact. The same picture always
/// gives the same bytes, because the date in the header is fixed. `text`: attribute `comments`.
CATOPTRIC_API std::string encode_exr(const Picture& picture, const std::string& text = {});
/// Returns a PNG file with 8 bits a channel of values as displayed (see `to_display`), clamped to
/// [0,1]; NaN becomes 0. The same picture gives the same bytes.
CATOPTRIC_API std::string encode_png(const Picture& display);

/// A file is replaced as a whole or not at all.
CATOPTRIC_API void write_exr(const Picture& picture, const std::filesystem::path& path,
                             const std::string& text = {});
CATOPTRIC_API void write_png(const Picture& display, const std::filesystem::path& path);

/// Returns the LDR-FLIP map of two pictures as displayed (sRGB-encoded, [0,1], see
/// `to_unrounded_display`). The map is row-major. Each pixel is 0 (no visible difference) to 1 and
/// says how different the pictures look to a viewer who flips between them. The map is symmetric,
/// and equal pictures give exactly 0. Method: Andersson et al., "FLIP: A Difference Evaluator for
/// Alternating Images", HPG 2020, as the authors' program (1.1 and later) implements it. 67 pixels
/// per degree is a 4K screen 0.7 m wide seen from 0.7 m. Throws `bad_data` if the pictures differ
/// in size or have no pixel, and `usage` unless `pixels_per_degree` is 1 to 1000. Works in double
/// on all cores. Costs about 0.07 us (one core) and 4 bytes a pixel at 67 pixels per degree.
CATOPTRIC_API std::vector<float> flip(const Picture& a_display, const Picture& b_display,
                                      double pixels_per_degree = 67);
/// Returns the mean of a FLIP map over the pixels of the mask, or NaN if the mask has none.
CATOPTRIC_API double flip_mean(std::span<const float> flip_map, const Mask& mask = {});

/// Difference of two pictures over the pixels of a mask. All values but `flip` are computed on
/// linear RGB after exposure (`apply_exposure` of measure/display.hpp), with both pictures clamped
/// to [0,1]. If no pixel of the mask is finite, each metric is NaN, and the maximum is at (-1, -1).
struct Difference {
    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

    std::size_t pixels = 0; ///< pixels of the mask, including those that are not finite
    /// Pixels with a NaN or infinity in either picture. The metrics leave these pixels out. If
    /// there are any, the row has failed, whatever its metrics are.
    std::size_t nonfinite = 0;
    double rmse = kNone;   ///< root of the mean square over pixels and channels, 0..1
    double mae = kNone;    ///< mean absolute difference over pixels and channels, 0..1
    double flip = kNone;   ///< mean of the FLIP map, 0..1
    double flip_floor = 0; ///< FLIP of the reference's noise (measure/halves.hpp); 0 without noise
    double square_margin = 0;   ///< the mean square may be larger by this, because of noise
    std::optional<double> psnr; ///< -20 log10 rmse in dB; empty if rmse is 0 or NaN
    double p99 = kNone;         ///< 99th percentile of the pixels' largest channel difference, 0..1
    double max = kNone;         ///< the largest channel difference of all, 0..1
    /// Pixel with the largest difference; the first in reading order if there are several.
    int max_x = -1;
    int max_y = -1;
    double off = kNone; ///< share of the finite pixels of the mask that are off, 0..1
    /// Longest line of pixels that are off, in pixels: `longest_line_length` of measure/lines.hpp.
    double longest_line = kNone;
    /// Values of the metrics that are computed from pictures (Metric::PictureMetricFunction).
    std::vector<double> others;
};

/// Returns the difference of two pictures over the pixels of `mask`; empty: all. `flip_map`: `flip`
/// of the two whole pictures as displayed, computed once for all masks. Symmetric in `a` and `b`.
/// Throws `bad_data` if pictures, mask or map differ in size.
CATOPTRIC_API Difference difference(const Picture& a, const Picture& b, const Mask& mask,
                                    std::span<const float> flip_map);

/// Whether values are averaged as they are or clamped to [0,1] first.
enum class ValueRange { unclamped, clamped };

/// Mean of a picture in linear RGB, by channel and over all three.
struct Mean {
    dvec3 rgb{Difference::kNone};
    double all = Difference::kNone;
};

/// Returns the mean over the pixels of the mask, or NaN if the mask has none. The mean is not
/// finite if a pixel is NaN or, unclamped, infinite.
CATOPTRIC_API Mean mean_of(const Picture& picture, ValueRange range, const Mask& mask = {});

} // namespace catoptric::measure
