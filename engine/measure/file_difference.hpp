#pragma once

#include "measure/picture.hpp"

#include <filesystem>

namespace catoptric::measure {

struct FileDifference {
    int width = 0, height = 0;
    Difference difference;
    Mean a_mean, b_mean, a_clamped, b_clamped;
    /// Whether one of the two files is a PNG, so that FLIP compares both pictures rounded to 8
    /// bits.
    bool is_of_bytes = false;
};

/// Compares two picture files and reads them a band of rows at a time. Around each band are as many
/// rows as FLIP reaches, so the metrics equal those of the whole pictures. `mask` is a PNG of the
/// pixels that count; if the path is empty, all pixels count. Memory is 9 bytes a pixel (see
/// DifferenceSum) and about 140 MB for the bands: 740 MB for two PNGs of 8192x8192 on two
/// threads. Time is about 0.12 us a pixel of one core for such PNGs. Throws as `read_picture` and
/// `read_mask` do, and `bad_data` if the pictures differ in size, before either is decoded.
FileDifference compare_files(const std::filesystem::path& a, const std::filesystem::path& b,
                             const std::filesystem::path& mask, double exposure_stops);

} // namespace catoptric::measure
