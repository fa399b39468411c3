#pragma once

#include "measure/picture.hpp"

#include <span>
#include <vector>

namespace catoptric::measure {

/// Sums the difference of two pictures row by row, so that neither picture needs to be in memory as
/// a whole. Keeps 9 bytes a pixel. The result does not depend on how many rows each call adds.
class DifferenceSum {
public:
    /// Reserves memory for all pixels at once, because a list that grows step by step would take
    /// twice as much.
    DifferenceSum(int width, std::size_t pixel_count) : width_(width) {
        off_.reserve(pixel_count), largest_.reserve(pixel_count);
    }

    /// Adds the next rows, in linear RGB after exposure, with their FLIP. `mask` has as many
    /// entries as there are pixels; if it is empty, all pixels count.
    void add_rows(std::span<const vec3> a, std::span<const vec3> b,
                  std::span<const std::uint8_t> mask, std::span<const float> flip_map);

    /// Returns the difference over all rows, without the metrics that are computed from pictures.
    /// Resets the sum.
    Difference finish();

private:
    void add_run(std::span<const vec3> a, std::span<const vec3> b,
                 std::span<const std::uint8_t> mask, std::span<const float> flip_map);

    int width_;
    Difference result_;
    /// The largest channel difference of each pixel of the mask whose values are finite.
    std::vector<double> largest_;
    Mask off_;
    std::size_t off_count_ = 0;
    double squares_ = 0, absolutes_ = 0, flips_ = 0;
};

/// Sums the mean of a picture row by row, both of the values as they are and of the values clamped
/// to [0,1].
class MeanSum {
public:
    /// Adds the next rows. `mask` has as many entries as there are pixels; if it is empty, all
    /// pixels count.
    void add_rows(std::span<const vec3> pixels, std::span<const std::uint8_t> mask);
    Mean mean(ValueRange range) const;

private:
    dvec3 sum_{0}, clamped_sum_{0};
    std::size_t count_ = 0;
};

} // namespace catoptric::measure
