#include "measure/halves.hpp"

#include "core/error.hpp"
#include "measure/display.hpp"
#include "measure/metric.hpp"
#include "measure/pixel_error.hpp"
#include "measure/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace catoptric::measure {

namespace {

/// Returns the root of the squared error plus `margin`; 0 if that is negative, and NaN for NaN.
double root_with_margin(const Difference& error, double margin) {
    if (margin == 0 && !(error.rmse < 0)) return error.rmse; // no noise
    const double square = std::copysign(error.rmse * error.rmse, error.rmse) + margin;
    return square < 0 ? 0 : std::sqrt(square);
}

} // namespace

double rmse_bound(const Difference& error) { return root_with_margin(error, error.square_margin); }

double lower_rmse_bound(const Difference& error) {
    return root_with_margin(error, -error.square_margin);
}

double flip_bound(const Difference& error) { return error.flip + error.flip_floor; }

double lower_flip_bound(const Difference& error) {
    const double bound = error.flip - error.flip_floor;
    return bound < 0 ? 0 : bound;
}

double signed_sqrt(double square) { return square < 0 ? -std::sqrt(-square) : std::sqrt(square); }

namespace {

constexpr int kResamples = 1000;
constexpr std::uint64_t kBootstrapSeed = 1;

/// Sum over the pixels of one bootstrap tile whose values are finite.
struct TileSum {
    double products = 0, pixels = 0;
};

/// Returns the product of both differences, summed over the channels.
double difference_product(const dvec3& x, const dvec3& a, const dvec3& b) {
    return glm::dot(x - a, x - b);
}

bool clamps_differ(const vec3& a, const vec3& b) {
    for (int channel = 0; channel < 3; ++channel)
        if ((a[channel] > 1) != (b[channel] > 1)) return true;
    return false;
}

/// Returns by how much clamping may lower the product of the differences, in expectation. `a` and
/// `b` are clamped, and the raw values are not.
/// If one half exceeds 1 and the other does not, the true value lies between the smaller half and
/// 1, and at one of these ends the squared difference is largest.
/// If both halves are below 1, a true value of 1 or more looks too dark. For symmetric noise, this
/// is at most as likely as both halves above 1. Those pixels therefore count twice, unless they are
/// so bright that the noise cannot bring them below 1.
double clamped_excess(const dvec3& x, const dvec3& a, const dvec3& b, const vec3& raw_a,
                      const vec3& raw_b) {
    constexpr float kFarAboveNoise = 10; // in differences of the halves
    double excess = 0;
    for (int channel = 0; channel < 3; ++channel) {
        const float low = std::min(raw_a[channel], raw_b[channel]),
                    high = std::max(raw_a[channel], raw_b[channel]);
        if (high <= 1) continue;
        const double from_a = x[channel] - a[channel], from_b = x[channel] - b[channel];
        if (low <= 1)
            excess += std::max(from_a * from_a, from_b * from_b) - from_a * from_b;
        else if (low - 1 < kFarAboveNoise * (high - low))
            excess += from_a * from_b;
    }
    return excess;
}

/// Returns the standard deviations of the noise that the margin of an error covers. 4 deviations of
/// a normal distribution are exceeded with a probability of .00003, which leaves room for noise
/// that is not normal. The deviation is estimated from `count` squares around 0, so fewer values
/// need more (Student's t, by the expansion of Cornish and Fisher). One value bounds nothing.
double margin_deviations(double count) {
    constexpr double kZ = 4;
    constexpr double kZ3 = kZ * kZ * kZ, kZ5 = kZ3 * kZ * kZ;
    if (count < 2) return INFINITY;
    const double n = count; // degrees of freedom
    return kZ + (kZ3 + kZ) / (4 * n) + (5 * kZ5 + 16 * kZ3 + 3 * kZ) / (96 * n * n);
}

/// Returns the interval of the mean product over tiles that are drawn with replacement.
Interval bootstrap_interval(std::vector<TileSum> tiles) {
    std::erase_if(tiles, [](const TileSum& tile) { return tile.pixels == 0; });
    if (tiles.size() < kMinTiles) return {};
    std::mt19937_64 random(kBootstrapSeed);
    std::vector<double> means;
    means.reserve(kResamples);
    for (int k = 0; k < kResamples; ++k) {
        TileSum sum;
        for (std::size_t i = 0; i < tiles.size(); ++i) {
            const TileSum& drawn = tiles[(random() >> 32) * tiles.size() >> 32];
            sum.products += drawn.products, sum.pixels += drawn.pixels;
        }
        means.push_back(sum.products / (3 * sum.pixels));
    }
    return {percentile(means, .025), percentile(std::move(means), .975)};
}

/// Sums of squared errors over the pixels of one mask.
struct NoiseFreeSum {
    std::vector<TileSum> tiles;
    double pixels = 0, products = 0, unclamped = 0, between = 0, crossing = 0, flip = 0, floor = 0;
    double variance = 0;     ///< variance of `products`
    double clamp_excess = 0; ///< by which clamping may have lowered `products`
};

NoiseFreeSum sum_noise_free(const Picture& picture, const NoisyHalves& halves, const Mask& mask,
                            std::span<const float> flip_map) {
    const auto width = static_cast<std::size_t>(picture.width);
    const std::size_t across = (width + kBootstrapTileEdge - 1) / kBootstrapTileEdge;
    NoiseFreeSum sum;
    sum.tiles.resize(
        across * ((picture.pixels.size() / width + kBootstrapTileEdge - 1) / kBootstrapTileEdge));
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const vec3 &x = picture.pixels[i], &a = halves.a.pixels[i], &b = halves.b.pixels[i];
        if (!mask.empty() && mask[i] == 0) continue;
        if (!is_finite_pixel(x) || !is_finite_pixel(a) || !is_finite_pixel(b)) continue;
        const dvec3 low_a = clamp_pixel(a), low_b = clamp_pixel(b);
        const dvec3 low_x = clamp_pixel(x);
        const double product = difference_product(low_x, low_a, low_b);
        TileSum& tile =
            sum.tiles[i / width / kBootstrapTileEdge * across + i % width / kBootstrapTileEdge];
        tile.products += product, ++tile.pixels;
        sum.products += product, ++sum.pixels;
        const double swapped = glm::dot(low_x - (low_a + low_b) / 2., low_a - low_b);
        sum.variance += swapped * swapped;
        sum.clamp_excess += clamped_excess(low_x, low_a, low_b, a, b);
        sum.unclamped += difference_product(dvec3(x), dvec3(a), dvec3(b));
        sum.between += glm::dot(low_a - low_b, low_a - low_b);
        sum.crossing += clamps_differ(a, b);
        sum.flip += static_cast<double>(flip_map[i]);
        sum.floor += static_cast<double>(halves.floor_map[i]);
    }
    return sum;
}

void check_halves(const Picture& picture, const NoisyHalves& halves, const Mask& mask,
                  std::size_t flip_size) {
    for (const Picture* half : {&halves.a, &halves.b})
        check(half->width == picture.width && half->height == picture.height, Failure::bad_data,
              "halves of a reference: wanted the size of the picture, ", picture.width, "x",
              picture.height, ", found ", half->width, "x", half->height);
    check((mask.empty() || mask.size() == picture.pixels.size()) &&
              flip_size == picture.pixels.size() &&
              halves.floor_map.size() == picture.pixels.size(),
          Failure::bad_data, "halves of a reference: wanted a mask and FLIP maps of ",
          picture.pixels.size(), " pixels, found ", mask.size(), ", ", flip_size, " and ",
          halves.floor_map.size());
}

MetricValue interval_value(const Interval& interval) {
    return interval.is_known() ? MetricValue(std::vector{interval.low, interval.high})
                               : MetricValue();
}

const RegisteredMetric kNoiseMetric{
    {.name = kNoiseMetricName,
     .help =
         "errors against a reference with noise, for each mask: the unbiased squared error, its "
         "95 % interval, the same without clamping, the share of pixels in which one half of "
         "the reference crosses 1, and FLIP with its floor",
     .order = 290,
     .study = kNoiseMetricName}};

} // namespace

NoisyHalves make_halves(const Picture& a, const Picture& b, double exposure) {
    NoisyHalves halves{apply_exposure(a, exposure), apply_exposure(b, exposure), {}, {}};
    halves.mean = Picture(a.width, a.height);
    for (std::size_t i = 0; i < halves.mean.pixels.size(); ++i)
        halves.mean.pixels[i] = vec3((dvec3(halves.a.pixels[i]) + dvec3(halves.b.pixels[i])) / 2.);
    halves.floor_map = flip(to_unrounded_display(a, exposure), to_unrounded_display(b, exposure));
    return halves;
}

std::vector<float> flip_against_halves(const Picture& picture, const NoisyHalves& halves,
                                       double exposure) {
    const Picture shown = to_unrounded_display(picture, exposure);
    std::vector<float> map = flip(shown, to_unrounded_display(halves.a));
    const std::vector<float> second = flip(shown, to_unrounded_display(halves.b));
    for (std::size_t i = 0; i < map.size(); ++i) map[i] = (map[i] + second[i]) / 2;
    return map;
}

Difference difference_from_halves(const Picture& picture, const NoisyHalves& halves,
                                  const Mask& mask, std::span<const float> flip_map) {
    check_halves(picture, halves, mask, flip_map.size());
    Difference result = difference(picture, halves.mean, mask, flip_map);
    const NoiseFreeSum sum = sum_noise_free(picture, halves, mask, flip_map);
    if (sum.pixels == 0) return result;
    result.rmse = signed_sqrt(sum.products / (3 * sum.pixels));
    result.psnr.reset();
    if (result.rmse > 0) result.psnr = -20 * std::log10(result.rmse);
    result.flip_floor = sum.floor / sum.pixels;
    const double noise = sum.variance > 0 ? margin_deviations(sum.pixels) * std::sqrt(sum.variance)
                                          : 0;
    result.square_margin = (noise + sum.clamp_excess) / (3 * sum.pixels);
    return result;
}

NoiseFreeError estimate_noise_free(const Picture& picture, const NoisyHalves& halves,
                                   const Mask& mask, std::span<const float> flip_map) {
    check_halves(picture, halves, mask, flip_map.size());
    NoiseFreeSum sum = sum_noise_free(picture, halves, mask, flip_map);
    if (sum.pixels == 0) return {};
    const double values = 3 * sum.pixels;
    return {.squared_error = sum.products / values,
            .ci95 = bootstrap_interval(std::move(sum.tiles)),
            .deviation = std::sqrt(sum.variance) / values,
            .unclamped = sum.unclamped / values,
            .crossing = sum.crossing / sum.pixels,
            .halves_rmse = std::sqrt(sum.between / values),
            .flip = sum.flip / sum.pixels,
            .flip_floor = sum.floor / sum.pixels};
}

bool is_below_noise(const Difference& error) {
    return error.flip_floor > 0 && error.flip <= error.flip_floor;
}

double flip_noise_floor(const Difference& a, const Difference& b) {
    return std::max(a.flip_floor, b.flip_floor);
}

double target_noise_floor(const std::vector<const Row*>& rows) {
    constexpr double kNoiseShareOfFlip = .2;
    double captures = INFINITY, others = INFINITY;
    for (const Row* row : rows) {
        if (row->is_reference || !std::isfinite(row->error.flip)) continue;
        const bool traces_all = row->rays && !row->traced_fraction;
        double& least = traces_all ? others : captures;
        least = std::min(least, row->error.flip);
    }
    const double least = std::isfinite(captures) ? captures : others;
    return std::isfinite(least) ? kNoiseShareOfFlip * least : 0;
}

void set_noise(Row& row, const std::vector<NoiseFreeError>& estimates) {
    std::vector<MetricParts> list;
    for (std::size_t i = 0; i < estimates.size(); ++i) {
        const NoiseFreeError& estimate = estimates[i];
        if (std::isnan(estimate.squared_error)) continue; // a mask without pixels has no estimate
        list.push_back({"mask",
                        std::string(row_masks()[i].name),
                        {{"squared_error", estimate.squared_error},
                         {"ci95", interval_value(estimate.ci95)},
                         {"deviation", estimate.deviation},
                         {"squared_error_unclamped", estimate.unclamped},
                         {"crossing", estimate.crossing},
                         {"halves_rmse", estimate.halves_rmse},
                         {"flip", estimate.flip},
                         {"flip_floor", estimate.flip_floor}}});
    }
    set_study_metric(row, std::string(kNoiseMetricName), std::move(list));
}

} // namespace catoptric::measure
