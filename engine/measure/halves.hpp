#pragma once

#include "measure/comparison.hpp"
#include "measure/picture.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

// Errors against a reference with noise. The reference is kept as two halves A and B, whose noise
// is independent. For a picture x, the mean of (x - A)(x - B) is an unbiased estimate of the
// squared error of x against the reference without noise, because the noise of A and that of B have
// mean 0 and do not correlate. The estimate may be negative if the error is smaller than the noise.
namespace catoptric::measure {

/// Two halves of a reference, as linear RGB after exposure, and the FLIP between them.
struct NoisyHalves {
    Picture a, b;
    Picture mean;                 ///< mean of both halves
    std::vector<float> floor_map; ///< FLIP map of `a` and `b`
};
/// `exposure`: stops, by which the pictures are multiplied.
NoisyHalves make_halves(const Picture& a, const Picture& b, double exposure);

/// Returns the mean of a picture's FLIP maps against the two halves. `picture` is linear, before
/// exposure.
std::vector<float> flip_against_halves(const Picture& picture, const NoisyHalves& halves,
                                       double exposure);

/// Returns the difference of a picture, after exposure, and the halves. `rmse` is the root of the
/// unbiased squared error; if the estimate is negative, -sqrt(-estimate), and the error is below
/// the noise. `psnr` follows `rmse`, and is empty below the noise. `flip` is the mean of `flip_map`
/// (see flip_against_halves), and `flip_floor` the mean FLIP between the halves.
/// `square_margin` is such that the true squared error exceeds the estimate by more with a
/// probability of kNoiseMissProbability at most. All other figures are those against the mean of
/// both halves, whose noise they include.
Difference difference_from_halves(const Picture& picture, const NoisyHalves& halves,
                                  const Mask& mask, std::span<const float> flip_map);

/// Probability that noise makes an error exceed rmse_bound, for noise that is independent in
/// each pixel and nearly normal in the sum over pixels. Taken for flip_bound as well, whose
/// noise is not known in closed form (tests/unit/halves_test.cpp tries it).
inline constexpr double kNoiseMissProbability = .001;
/// Returns a bound of the picture's error against the reference without noise: the root of the
/// squared error plus its margin. Without noise it is the error itself. NaN without finite pixels.
double rmse_bound(const Difference& error);
/// Returns a bound of the picture's FLIP against the reference without noise: the mean FLIP against
/// both halves plus the FLIP between them. FLIP against a half alone may be too small, because
/// noise of the half can resemble noise of the picture. Differences of colours obey the triangle
/// inequality: the difference from the truth is at most that from a half plus that of this half
/// from the truth, and the two halves differ more than a half and the truth.
double flip_bound(const Difference& error);
/// Return a bound on the other side, which the picture's error is not below, as an audit needs it
/// for alarms. 0 if the error may be 0.
double lower_rmse_bound(const Difference& error);
double lower_flip_bound(const Difference& error);

/// Returns sqrt(square), or -sqrt(-square) if an unbiased squared error is negative, as
/// Difference::rmse has it.
double signed_sqrt(double square);

/// Edge of the tiles that the bootstrap draws, pixels.
inline constexpr int kBootstrapTileEdge = 16;
/// Fewest tiles with pixels of the mask for which there is an interval.
inline constexpr std::size_t kMinTiles = 10;

/// The estimate of a picture's squared error over the pixels of a mask, and its noise. All squared
/// errors are means over pixels and channels.
struct NoiseFreeError {
    /// Unbiased for the clamped pictures: linear RGB times 2^exposure, clamped to [0,1].
    double squared_error = Difference::kNone;
    /// 95 % interval of the squared error, by the percentile bootstrap over tiles of 16x16 pixels
    /// (Efron and Tibshirani 1993, 13). Neighbouring pixels share errors, and tiles keep them
    /// together. Unknown for fewer than kMinTiles tiles.
    Interval ci95;
    /// Standard deviation of the estimate by the noise of this picture's halves alone. With M =
    /// (A + B) / 2, the product (x - M)(A - B) has the variance of (x - A)(x - B) if the noise of
    /// both halves has one normal distribution, because M and A - B are then independent. Noise is
    /// independent from pixel to pixel.
    double deviation = Difference::kNone;
    /// The estimate without clamping, which stays unbiased where one half exceeds 1 and the other
    /// does not.
    double unclamped = Difference::kNone;
    /// Share of the pixels in which a channel of one half exceeds 1 and that of the other does not.
    /// Clamping biases the estimate in these pixels.
    double crossing = Difference::kNone;
    double halves_rmse = Difference::kNone; ///< rmse between the two halves, clamped
    double flip = Difference::kNone;        ///< as in Difference
    double flip_floor = Difference::kNone;  ///< as in Difference
};
NoiseFreeError estimate_noise_free(const Picture& picture, const NoisyHalves& halves,
                                   const Mask& mask, std::span<const float> flip_map);

/// Returns whether a row's FLIP over these pixels is no larger than that between the halves of its
/// reference. False for a reference without noise.
bool is_below_noise(const Difference& error);
/// Returns the difference of two rows' FLIP below which they tie: the larger floor of the two, or 0
/// for references without noise.
double flip_noise_floor(const Difference& a, const Difference& b);

/// Returns the noise floor (FLIP between the halves) at which a reference needs no more frames: a
/// fifth of the least FLIP over the mirrors of a row that looks into captures. If there is no such
/// row, all rows except the reference count. Returns 0 if there are no rows.
double target_noise_floor(const std::vector<const Row*>& rows);

/// Name of the metric that lists a row's NoiseFreeError for each mask, and of the study
/// that shows it.
inline constexpr std::string_view kNoiseMetricName = "noise";
/// Sets the row's metric kNoiseMetricName. `estimates` has one entry for each of row_masks().
void set_noise(Row& row, const std::vector<NoiseFreeError>& estimates);

/// The noise of a comparison's reference.
struct ReferenceNoise {
    int frames = 0; ///< frames of each half, each with seeds of its own
    /// Rays of a lobe for each pixel of a frame, and those that the reference asks for in each
    /// half; 0: the reference traces no lobes.
    int rays = 0, wanted_rays = 0;
    double seconds = 0;                      ///< time in which they were rendered
    double most_seconds = 0;                 ///< CompareRequest::reference_seconds
    double wanted_floor = Difference::kNone; ///< a fifth of the least FLIP of a row with captures
    /// FLIP and rmse between the halves, over the mirrors.
    double flip_floor = Difference::kNone, halves_rmse = Difference::kNone;
    /// rmse between the halves that the variance of each half's frames predicts, over the mirrors
    /// and not clamped; NaN for fewer than two frames a half.
    double predicted_rmse = Difference::kNone;
    std::vector<double>
        view_floors; ///< noise floor of each drawn view, by the target's quantity; NaN: unknown

    /// Returns whether a half has fewer rays than the reference asks for.
    bool is_coarse() const { return rays * frames < wanted_rays; }
    bool is_target_reached() const { return flip_floor <= wanted_floor; }
};

} // namespace catoptric::measure
