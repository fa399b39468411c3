#include "measure/picture.hpp"

#include "core/error.hpp"
#include "measure/difference_sum.hpp"
#include "measure/lines.hpp"
#include "measure/metric.hpp"
#include "measure/pixel_error.hpp"
#include "measure/statistics.hpp"
#include "measure/wide.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace catoptric::measure {
namespace {

void check_sizes(const Picture& a, const Picture& b, const Mask& mask, std::size_t flip_size) {
    check(a.width == b.width && a.height == b.height, Failure::bad_data,
          "a difference wants two "
          "pictures of the same size, found ",
          a.width, "x", a.height, " and ", b.width, "x", b.height);
    check(mask.empty() || mask.size() == a.pixels.size(), Failure::bad_data, "a difference of ",
          a.pixels.size(), " pixels wants a mask of as many, found ", mask.size());
    check(flip_size == a.pixels.size(), Failure::bad_data, "a difference of ", a.pixels.size(),
          " pixels wants a FLIP map of as many, found ", flip_size);
}

const Registered kPixels{
    {.name = "pixels",
     .unit = "pixels",
     .help = "number of pixels of the mask, including pixels that are not finite",
     .order = 100,
     .get = [](const Difference& error) -> Value { return static_cast<double>(error.pixels); }}};
const Registered kFlip{
    {.name = "flip",
     .help = "mean LDR-FLIP at 67 pixels per degree, of the pictures as displayed",
     .better = Better::less,
     .order = 101,
     .each_mask_in_table = true,
     .columns = {{"FLIP"}},
     .get = [](const Difference& error) -> Value { return error.flip; }}};
const Registered kShareOff{
    {.name = "off",
     .help = "share of the pixels whose largest channel difference exceeds .02",
     .better = Better::less,
     .order = 102,
     .columns = {{"off, %", Style::percent, 2}},
     .get = [](const Difference& error) -> Value { return error.off; }}};
const Registered kMae{
    {.name = "mae",
     .help = "mean absolute difference, linear RGB times 2^exposure, clamped to [0,1]",
     .better = Better::less,
     .order = 103,
     .columns = {{"MAE"}},
     .get = [](const Difference& error) -> Value { return error.mae; }}};
const Registered kRmse{{.name = "rmse",
                        .help = "root of the mean square difference, linear RGB times 2^exposure, "
                                "clamped to [0,1]",
                        .better = Better::less,
                        .order = 104,
                        .each_mask_in_table = true,
                        .columns = {{"rmse"}},
                        .get = [](const Difference& error) -> Value { return error.rmse; }}};
const Registered kPsnr{{.name = "psnr",
                        .unit = "dB",
                        .help = "-20 log10 rmse; none for equal pictures",
                        .better = Better::more,
                        .order = 106,
                        .columns = {{"PSNR dB", Style::fixed, 1}},
                        .get = [](const Difference& error) -> Value {
                            return error.psnr.value_or(Difference::kNone);
                        }}};
const Registered kP99{{.name = "p99",
                       .help = "99th percentile of the pixels' largest channel difference",
                       .better = Better::less,
                       .order = 107,
                       .columns = {{"p99"}},
                       .get = [](const Difference& error) -> Value { return error.p99; }}};
const Registered kNonfinite{
    {.name = "nonfinite",
     .unit = "pixels",
     .help = "number of pixels that are NaN or infinite; any such pixel makes a row fail",
     .better = Better::less,
     .order = 108,
     .get = [](const Difference& error) -> Value { return static_cast<double>(error.nonfinite); }}};
const Registered kMax{{.name = "max",
                       .help = "largest channel difference of all pixels",
                       .better = Better::less,
                       .order = 109,
                       .get = [](const Difference& error) -> Value { return error.max; }}};
const Registered kMaxAt{{.name = "max_at",
                         .help = "pixel with the largest channel difference",
                         .order = 110,
                         .get = [](const Difference& error) -> Value {
                             return PixelPosition{error.max_x, error.max_y};
                         }}};

const Registered kMean{{.name = "mean",
                        .help = "mean of the whole picture by channel, linear",
                        .mask = "all",
                        .order = 280,
                        .get = [](const Row& row) -> Value { return row.mean.rgb; }}};
const Registered kMeanClamped{
    {.name = "mean_clamped",
     .help = "mean of the whole picture by channel, linear, clamped to [0,1]",
     .mask = "all",
     .order = 281,
     .get = [](const Row& row) -> Value { return row.mean_clamped.rgb; }}};

/// Differences of the pixels of a short run. `largest` is NaN where a pixel is not finite.
struct PixelRun {
    static constexpr std::size_t kPixels = 256;
    std::array<double, kPixels> largest, square, absolute;
};

/// Fills `run` with the differences of `count` pixels of three values each.
CATOPTRIC_WIDE void take_apart(const float* __restrict a, const float* __restrict b,
                               std::size_t count, PixelRun& run) {
    double* __restrict const largest = run.largest.data();
    double* __restrict const square = run.square.data();
    double* __restrict const absolute = run.absolute.data();
    const auto one = [](float value) {
        const auto wide = static_cast<double>(value);
        const double least = wide < 0.0 ? 0.0 : wide;
        return least > 1.0 ? 1.0 : least;
    };
    for (std::size_t i = 0; i < count; ++i) {
        const float *const p = a + 3 * i, *const q = b + 3 * i;
        const double x = std::abs(one(p[0]) - one(q[0])), y = std::abs(one(p[1]) - one(q[1])),
                     z = std::abs(one(p[2]) - one(q[2]));
        const double two = x < y ? y : x;
        // 0 times a value that is not finite is NaN, so the sum marks such pixels.
        const float finite = 0 * p[0] + 0 * p[1] + 0 * p[2] + 0 * q[0] + 0 * q[1] + 0 * q[2];
        largest[i] = (two < z ? z : two) + static_cast<double>(finite);
        square[i] = x * x + y * y + z * z;
        absolute[i] = x + y + z;
    }
}

} // namespace

void DifferenceSum::add(std::span<const vec3> a, std::span<const vec3> b,
                        std::span<const std::uint8_t> mask, std::span<const float> flip_map) {
    for (std::size_t first = 0; first < a.size(); first += PixelRun::kPixels) {
        const std::size_t count = std::min(PixelRun::kPixels, a.size() - first);
        const auto part = [&](auto values) {
            return values.empty() ? values : values.subspan(first, count);
        };
        add_run(part(a), part(b), part(mask), part(flip_map));
    }
}

void DifferenceSum::add_run(std::span<const vec3> a, std::span<const vec3> b,
                            std::span<const std::uint8_t> mask, std::span<const float> flip_map) {
    PixelRun run;
    take_apart(&a[0].x, &b[0].x, a.size(), run);
    const std::size_t first = off_.size();
    off_.resize(first + a.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (!mask.empty() && mask[i] == 0) continue;
        ++result_.pixels;
        const double largest = run.largest[i];
        if (std::isnan(largest)) {
            ++result_.nonfinite;
            continue;
        }
        squares_ += run.square[i];
        absolutes_ += run.absolute[i];
        flips_ += static_cast<double>(flip_map[i]);
        largest_.push_back(largest);
        off_[first + i] = largest > kOff;
        off_count_ += off_[first + i];
        if (largest_.size() == 1 || largest > result_.max) {
            const auto width = static_cast<std::size_t>(width_);
            result_.max = largest;
            result_.max_x = static_cast<int>((first + i) % width);
            result_.max_y = static_cast<int>((first + i) / width);
        }
    }
}

Difference DifferenceSum::take() {
    Difference result = std::exchange(result_, {});
    const Mask off = std::exchange(off_, {});
    std::vector<double> largest = std::exchange(largest_, {});
    if (largest.empty()) return result;
    const auto judged = static_cast<double>(largest.size());
    result.rmse = std::sqrt(squares_ / (3 * judged));
    result.mae = absolutes_ / (3 * judged);
    result.flip = flips_ / judged;
    if (result.rmse > 0) result.psnr = -20 * std::log10(result.rmse);
    result.off = static_cast<double>(off_count_) / judged;
    result.p99 = percentile(std::move(largest), 0.99);
    result.longest_line = longest_line(off, width_);
    return result;
}

Difference difference(const Picture& a, const Picture& b, const Mask& mask,
                      std::span<const float> flip_map) {
    check_sizes(a, b, mask, flip_map.size());
    DifferenceSum sum(a.width, a.pixels.size());
    sum.add(a.pixels, b.pixels, mask, flip_map);
    Difference result = sum.take();
    result.others = other_figures({a, b, mask, flip_map});
    return result;
}

void MeanSum::add(std::span<const vec3> pixels, std::span<const std::uint8_t> mask) {
    dvec3 sum = sum_, clamped_sum = clamped_sum_; // local copies stay in registers
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        if (!mask.empty() && mask[i] == 0) continue;
        sum += dvec3(pixels[i]);
        clamped_sum += clamped(pixels[i]);
        ++count_;
    }
    sum_ = sum, clamped_sum_ = clamped_sum;
}

Mean MeanSum::mean(Range range) const {
    const dvec3 rgb = (range == Range::clamped ? clamped_sum_ : sum_) /
                      static_cast<double>(count_); // 0/0 is NaN
    return {rgb, (rgb.x + rgb.y + rgb.z) / 3};
}

Mean mean_of(const Picture& picture, Range range, const Mask& mask) {
    check(mask.empty() || mask.size() == picture.pixels.size(), Failure::bad_data, "a mean of ",
          picture.pixels.size(), " pixels wants a mask of as many, found ", mask.size());
    MeanSum sum;
    sum.add(picture.pixels, mask);
    return sum.mean(range);
}

} // namespace catoptric::measure
