#include "measure/picture_mean.hpp"

#include "core/error.hpp"

#include <cmath>

namespace catoptric::measure {

PictureMean::PictureMean(int count, const Picture& mean, const Picture& variance)
    : count_(count), width_(mean.width), height_(mean.height) {
    const double pictures = count;
    for (std::size_t i = 0; i < mean.pixels.size(); ++i) {
        mean_.emplace_back(mean.pixels[i]);
        squares_.push_back(count < 2 ? dvec3(0)
                                     : dvec3(variance.pixels[i]) * ((pictures - 1) * pictures));
    }
}

void PictureMean::add(const Picture& picture) {
    if (count_ == 0) {
        width_ = picture.width, height_ = picture.height;
        mean_.assign(picture.pixels.size(), dvec3(0));
        squares_.assign(picture.pixels.size(), dvec3(0));
    }
    check(picture.width == width_ && picture.height == height_, Failure::bad_data,
          "a mean of pictures of ", width_, "x", height_, " wants another of this size, found ",
          picture.width, "x", picture.height);
    ++count_;
    for (std::size_t i = 0; i < mean_.size(); ++i) {
        const dvec3 value(picture.pixels[i]);
        const dvec3 before = value - mean_[i];
        mean_[i] += before / static_cast<double>(count_);
        squares_[i] += before * (value - mean_[i]);
    }
}

Picture PictureMean::mean() const {
    Picture result(width_, height_);
    for (std::size_t i = 0; i < mean_.size(); ++i) result.pixels[i] = vec3(mean_[i]);
    return result;
}

Picture PictureMean::variance() const {
    Picture result(width_, height_);
    const double pictures = count_;
    for (std::size_t i = 0; i < mean_.size(); ++i)
        result.pixels[i] = count_ < 2 ? vec3(NAN) : vec3(squares_[i] / ((pictures - 1) * pictures));
    return result;
}

} // namespace catoptric::measure
