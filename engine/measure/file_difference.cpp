#include "measure/file_difference.hpp"

#include "core/error.hpp"
#include "measure/difference_sum.hpp"
#include "measure/display.hpp"
#include "measure/flip.hpp"
#include "measure/metric.hpp"
#include "measure/picture_file.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace catoptric::measure {
namespace {

constexpr int kPixelsPerBand = 1 << 20; // pixels of a band; a band has at least one row

/// A window of rows of a picture: the rows that a band and its surroundings need.
class RowWindow {
public:
    explicit RowWindow(PictureReader reader) : reader_(std::move(reader)) {}

    /// Returns the rows [first, end). Rows that the window already holds are not read again.
    const Picture& read(int first, int end) {
        const auto width = static_cast<std::size_t>(reader_.picture_width());
        std::vector<vec3>& pixels = rows_.pixels;
        const auto gone = static_cast<std::size_t>(first - first_) * width;
        pixels.erase(pixels.begin(), pixels.begin() + static_cast<std::ptrdiff_t>(gone));
        const std::size_t kept = pixels.size();
        pixels.resize(static_cast<std::size_t>(end - first) * width);
        reader_.read_rows(end_, std::span(pixels).subspan(kept));
        first_ = first, end_ = end;
        rows_.width = reader_.picture_width(), rows_.height = end - first;
        return rows_;
    }

private:
    PictureReader reader_;
    int first_ = 0, end_ = 0;
    Picture rows_;
};

/// Computes FLIP of parts of two pictures, one after the other in the same memory.
class FlipBandComputer {
public:
    /// `is_light_of_bytes`: both pictures are linear light that was decoded from 8 bits and gets no
    /// exposure. A screen shows exactly this light, so no conversion is needed.
    FlipBandComputer(double exposure_stops, bool is_of_bytes, bool is_light_of_bytes)
        : exposure_stops_(exposure_stops), is_of_bytes_(is_of_bytes),
          is_light_of_bytes_(is_light_of_bytes) {}

    /// Returns FLIP of the rows [first, end). Equal pictures give 0 without computation.
    std::vector<float> compute(const Picture& a, const Picture& b, int first, int end) {
        if (a.pixels == b.pixels)
            return std::vector<float>(static_cast<std::size_t>(end - first) *
                                      static_cast<std::size_t>(a.width));
        if (is_light_of_bytes_) return flip_rows(a, b, first, end, PixelEncoding::linear);
        convert_to_display(a, exposure_stops_, is_of_bytes_, display_a_);
        convert_to_display(b, exposure_stops_, is_of_bytes_, display_b_);
        return flip_rows(display_a_, display_b_, first, end, PixelEncoding::srgb);
    }

private:
    double exposure_stops_;
    bool is_of_bytes_, is_light_of_bytes_;
    Picture display_a_, display_b_;
};

/// Returns the rows multiplied by 2^exposure. For 0 stops, returns an empty list, and the caller
/// uses the rows as they are.
std::vector<vec3> expose_rows(std::span<const vec3> rows, double exposure_stops) {
    if (exposure_stops == 0) return {};
    std::vector<vec3> result;
    for (const vec3& pixel : rows) result.push_back(apply_exposure(pixel, exposure_stops));
    return result;
}

template <typename Value>
std::span<const Value> row_values(const std::vector<Value>& values, int width, int first, int end) {
    if (values.empty()) return {};
    return std::span(values).subspan(static_cast<std::size_t>(first) * std::size_t(width),
                                     static_cast<std::size_t>(end - first) * std::size_t(width));
}

} // namespace

FileDifference compare_files(const std::filesystem::path& a, const std::filesystem::path& b,
                             const std::filesystem::path& mask_file, double exposure_stops) {
    PictureReader of_a(a);
    const int width = of_a.picture_width(), height = of_a.height();
    PictureReader reader_b(b, [&](int columns, int rows) {
        check(columns == width && rows == height, Failure::bad_data, a.string(), " is ", width, "x",
              height, ", ", b.string(), " is ", columns, "x", rows,
              ": wanted two pictures of one size");
    });
    Mask mask;
    if (!mask_file.empty()) mask = read_mask(mask_file, width, height);

    const bool is_of_bytes = is_png(a) || is_png(b);
    const bool is_light_of_bytes = exposure_stops == 0 && of_a.is_8_bit() && reader_b.is_8_bit();
    RowWindow window_a(std::move(of_a)), window_b(std::move(reader_b));
    DifferenceSum sum(width, static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    MeanSum a_mean, b_mean;
    FlipBandComputer band_flip(exposure_stops, is_of_bytes, is_light_of_bytes);
    const int band = std::max(1, kPixelsPerBand / width), reach = flip_filter_radius();
    for (int first = 0; first < height; first += band) {
        const int end = std::min(first + band, height), above = std::max(0, first - reach),
                  below = std::min(height, end + reach);
        const Picture& part_a = window_a.read(above, below);
        const Picture& part_b = window_b.read(above, below);
        const std::vector<float> map = band_flip.compute(part_a, part_b, first - above,
                                                         end - above);
        const auto counted = row_values(mask, width, first, end);
        const auto rows_a = row_values(part_a.pixels, width, first - above, end - above);
        const auto rows_b = row_values(part_b.pixels, width, first - above, end - above);
        a_mean.add_rows(rows_a, counted);
        b_mean.add_rows(rows_b, counted);
        const std::vector<vec3> exposed_a = expose_rows(rows_a, exposure_stops),
                                exposed_b = expose_rows(rows_b, exposure_stops);
        sum.add_rows(exposed_a.empty() ? rows_a : exposed_a, exposed_b.empty() ? rows_b : exposed_b,
                     counted, map);
    }
    return {width,
            height,
            sum.finish(),
            a_mean.mean(ValueRange::unclamped),
            b_mean.mean(ValueRange::unclamped),
            a_mean.mean(ValueRange::clamped),
            b_mean.mean(ValueRange::clamped),
            is_of_bytes};
}

} // namespace catoptric::measure
