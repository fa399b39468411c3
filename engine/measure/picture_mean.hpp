#pragma once

#include "measure/picture.hpp"

#include <vector>

namespace catoptric::measure {

/// Mean of independent pictures of one view, with the variance of each channel of each pixel. Sums
/// in double by Welford's method (1962). Takes 48 bytes a pixel.
class PictureMean {
public:
    PictureMean() = default;
    /// Restores a mean of `count` pictures from `mean` and `variance`.
    PictureMean(int count, const Picture& mean, const Picture& variance);
    /// Adds a picture. Throws `bad_data` for another size than that of the first.
    void add(const Picture& picture);
    int count() const { return count_; }
    /// Returns the mean of all pictures; a picture without pixels if there are none.
    Picture mean() const;
    /// Returns an estimate of the variance of the mean, by channel: the sample variance divided by
    /// the number of pictures. NaN for fewer than two pictures.
    Picture variance() const;

private:
    int count_ = 0, width_ = 0, height_ = 0;
    std::vector<dvec3> mean_;
    std::vector<dvec3> squares_; ///< sums of squared deviations from the mean
};

} // namespace catoptric::measure
