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

void check_equal_sizes(const Picture& a, const Picture& b, const Mask& mask,
                       std::size_t flip_size) {
    check(a.width == b.width && a.height == b.height, Failure::bad_data,
          "a difference wants two "
          "pictures of the same size, found ",
          a.width, "x", a.height, " and ", b.width, "x", b.height);
    check(mask.empty() || mask.size() == a.pixels.size(), Failure::bad_data, "a difference of ",
          a.pixels.size(), " pixels wants a mask of as many, found ", mask.size());
    check(flip_size == a.pixels.size(), Failure::bad_data, "a difference of ", a.pixels.size(),
          " pixels wants a FLIP map of as many, found ", flip_size);
}

const RegisteredMetric kComparedPixelsMetric{
    {.name = "pixels",
     .unit = "pixels",
     .help = "number of pixels of the mask, including pixels that are not finite",
     .order = 100,
     .get = [](const Difference& error) -> MetricValue {
         return static_cast<double>(error.pixels);
     }}};
const RegisteredMetric kFlipMetric{
    {.name = "flip",
     .help = "mean LDR-FLIP at 67 pixels per degree, of the pictures as displayed",
     .better = BetterDirection::less,
     .order = 101,
     .each_mask_in_table = true,
     .columns = {{"FLIP"}},
     .get = [](const Difference& error) -> MetricValue { return error.flip; }}};
const RegisteredMetric kOffPixelShareMetric{
    {.name = "off",
     .help = "share of the pixels whose largest channel difference exceeds .02",
     .better = BetterDirection::less,
     .order = 102,
     .columns = {{"off, %", ValueFormat::percent, 2}},
     .get = [](const Difference& error) -> MetricValue { return error.off; }}};
const RegisteredMetric kMaeMetric{
    {.name = "mae",
     .help = "mean absolute difference, linear RGB times 2^exposure, clamped to [0,1]",
     .better = BetterDirection::less,
     .order = 103,
     .columns = {{"MAE"}},
     .get = [](const Difference& error) -> MetricValue { return error.mae; }}};
const RegisteredMetric kRmseMetric{
    {.name = "rmse",
     .help = "root of the mean square difference, linear RGB times 2^exposure, "
             "clamped to [0,1]; negative: below the noise of the reference",
     .better = BetterDirection::less,
     .order = 104,
     .each_mask_in_table = true,
     .columns = {{"rmse"}},
     .get = [](const Difference& error) -> MetricValue { return error.rmse; }}};
const RegisteredMetric kPsnrMetric{{.name = "psnr",
                                    .unit = "dB",
                                    .help = "-20 log10 rmse; none for equal pictures",
                                    .better = BetterDirection::more,
                                    .order = 106,
                                    .columns = {{"PSNR dB", ValueFormat::fixed, 1}},
                                    .get = [](const Difference& error) -> MetricValue {
                                        return error.psnr.value_or(Difference::kNone);
                                    }}};
const RegisteredMetric kPercentile99Metric{
    {.name = "p99",
     .help = "99th percentile of the pixels' largest channel difference",
     .better = BetterDirection::less,
     .order = 107,
     .columns = {{"p99"}},
     .get = [](const Difference& error) -> MetricValue { return error.p99; }}};
const RegisteredMetric kNonfiniteMetric{
    {.name = "nonfinite",
     .unit = "pixels",
     .help = "number of pixels that are NaN or infinite; any such pixel makes a row fail",
     .better = BetterDirection::less,
     .order = 108,
     .get = [](const Difference& error) -> MetricValue {
         return static_cast<double>(error.nonfinite);
     }}};
const RegisteredMetric kMaxDifferenceMetric{
    {.name = "max",
     .help = "largest channel difference of all pixels",
     .better = BetterDirection::less,
     .order = 109,
     .get = [](const Difference& error) -> MetricValue { return error.max; }}};
const RegisteredMetric kMaxPixelMetric{{.name = "max_at",
                                        .help = "pixel with the largest channel difference",
                                        .order = 110,
                                        .get = [](const Difference& error) -> MetricValue {
                                            return PixelPosition{error.max_x, error.max_y};
                                        }}};

const RegisteredMetric kMeanMetric{
    {.name = "mean",
     .help = "mean of the whole picture by channel, linear",
     .mask = "all",
     .order = 280,
     .get = [](const Row& row) -> MetricValue { return row.mean.rgb; }}};
const RegisteredMetric kMeanClampedMetric{
    {.name = "mean_clamped",
     .help = "mean of the whole picture by channel, linear, clamped to [0,1]",
     .mask = "all",
     .order = 281,
     .get = [](const Row& row) -> MetricValue { return row.mean_clamped.rgb; }}};

/// Differences of the pixels of a short run. `largest` is NaN where a pixel is not finite.
struct DifferenceBlock {
    static constexpr std::size_t kBlockPixels = 256;
    std::array<double, kBlockPixels> largest, square, absolute;
};

/// Fills `run` with the differences of `count` pixels of three values each.
CATOPTRIC_WIDE void compare_block(const float* __restrict a, const float* __restrict b,
                                  std::size_t count, DifferenceBlock& run) {
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

void DifferenceSum::add_rows(std::span<const vec3> a, std::span<const vec3> b,
                             std::span<const std::uint8_t> mask, std::span<const float> flip_map) {
    for (std::size_t first = 0; first < a.size(); first += DifferenceBlock::kBlockPixels) {
        const std::size_t count = std::min(DifferenceBlock::kBlockPixels, a.size() - first);
        const auto part = [&](auto values) {
            return values.empty() ? values : values.subspan(first, count);
        };
        add_run(part(a), part(b), part(mask), part(flip_map));
    }
}

void DifferenceSum::add_run(std::span<const vec3> a, std::span<const vec3> b,
                            std::span<const std::uint8_t> mask, std::span<const float> flip_map) {
    DifferenceBlock run;
    compare_block(&a[0].x, &b[0].x, a.size(), run);
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
        off_[first + i] = largest > kMaxInvisibleDifference;
        off_count_ += off_[first + i];
        if (largest_.size() == 1 || largest > result_.max) {
            const auto width = static_cast<std::size_t>(width_);
            result_.max = largest;
            result_.max_x = static_cast<int>((first + i) % width);
            result_.max_y = static_cast<int>((first + i) / width);
        }
    }
}

Difference DifferenceSum::finish() {
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
    result.longest_line = longest_line_length(off, width_);
    return result;
}

Difference difference(const Picture& a, const Picture& b, const Mask& mask,
                      std::span<const float> flip_map) {
    check_equal_sizes(a, b, mask, flip_map.size());
    DifferenceSum sum(a.width, a.pixels.size());
    sum.add_rows(a.pixels, b.pixels, mask, flip_map);
    Difference result = sum.finish();
    result.others = picture_metrics({a, b, mask, flip_map});
    return result;
}

void MeanSum::add_rows(std::span<const vec3> pixels, std::span<const std::uint8_t> mask) {
    dvec3 sum = sum_, clamped_sum = clamped_sum_; // local copies stay in registers
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        if (!mask.empty() && mask[i] == 0) continue;
        sum += dvec3(pixels[i]);
        clamped_sum += clamp_pixel(pixels[i]);
        ++count_;
    }
    sum_ = sum, clamped_sum_ = clamped_sum;
}

Mean MeanSum::mean(ValueRange range) const {
    const dvec3 rgb = (range == ValueRange::clamped ? clamped_sum_ : sum_) /
                      static_cast<double>(count_); // 0/0 is NaN
    return {rgb, (rgb.x + rgb.y + rgb.z) / 3};
}

Mean mean_of(const Picture& picture, ValueRange range, const Mask& mask) {
    check(mask.empty() || mask.size() == picture.pixels.size(), Failure::bad_data, "a mean of ",
          picture.pixels.size(), " pixels wants a mask of as many, found ", mask.size());
    MeanSum sum;
    sum.add_rows(picture.pixels, mask);
    return sum.mean(range);
}

} // namespace catoptric::measure
