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

/// Reads both pictures a band of rows at a time: memory is 9 bytes a pixel and 130 MB,
/// whatever their size. Each band has as many rows around it as FLIP reaches, so that every figure
/// is that of the whole pictures. `mask`: of pixels that count; empty: all. Throws as
/// `read_picture` and `read_mask`, and `bad_data` for pictures of two sizes, before one is decoded.
FileDifference difference_of_files(const std::filesystem::path& a, const std::filesystem::path& b,
                                   const std::filesystem::path& mask, double exposure_stops);

} // namespace catoptric::measure
