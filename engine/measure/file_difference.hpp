#pragma once

#include "measure/difference.hpp"

#include <filesystem>

namespace catoptric::measure {

/// How far two pictures in files are apart.
struct FileDifference {
    int width = 0, height = 0;
    Difference difference;
    Mean a_mean, b_mean, a_clamped, b_clamped;
    bool is_of_bytes = false; ///< one file is a PNG: FLIP is of both as rounded to 8 bits
};

/// Compares two pictures and reads them a band of rows at a time. Memory is 9 bytes a pixel, as
/// DifferenceSum says, and about 140 MB for the bands: 740 MB for two PNGs of 8192x8192 on two
/// threads. Time is about 0.12 us a pixel of one core for such PNGs. Each band has as many rows
/// around it as FLIP reaches, so every figure is that of the whole pictures. `mask`: the pixels
/// that count; empty: all. Throws as `read_picture` and `read_mask`, and `bad_data` for pictures of
/// two sizes, before one is decoded.
FileDifference difference_of_files(const std::filesystem::path& a, const std::filesystem::path& b,
                                   const std::filesystem::path& mask, double exposure_stops);

} // namespace catoptric::measure
