#pragma once

#include "measure/difference.hpp"

#include <span>
#include <vector>

namespace catoptric::measure {

/// Adds a difference up row by row, so that two pictures need not be in memory as a whole: 9 bytes
/// a pixel are kept. What comes out does not depend on how many rows come at once.
class DifferenceSum {
public:
    /// Takes memory for all pixels at once: growing step by step would take twice as much.
    DifferenceSum(int width, std::size_t pixel_count) : width_(width) {
        off_.reserve(pixel_count), largest_.reserve(pixel_count);
    }

    /// The next rows, linear RGB as exposed, with their FLIP. `mask` of as many pixels; empty: all
    /// count.
    void add(std::span<const vec3> a, std::span<const vec3> b, std::span<const std::uint8_t> mask,
             std::span<const float> flip_map);

    /// Of all rows, without the figures that others compute. Leaves nothing behind.
    Difference take();

private:
    void add_run(std::span<const vec3> a, std::span<const vec3> b,
                 std::span<const std::uint8_t> mask, std::span<const float> flip_map);

    int width_;
    Difference result_;
    std::vector<double> largest_; ///< of each judged pixel
    Mask off_;
    std::size_t off_count_ = 0;
    double squares_ = 0, absolutes_ = 0, flips_ = 0;
};

/// Adds the means of a picture up row by row: of values as they are and of values clamped to [0,1].
class MeanSum {
public:
    /// Adds the next rows. `mask` of as many pixels; empty: all count.
    void add(std::span<const vec3> pixels, std::span<const std::uint8_t> mask);
    Mean mean(Range range) const;

private:
    dvec3 sum_{0}, clamped_sum_{0};
    std::size_t count_ = 0;
};

} // namespace catoptric::measure
