#include "measure/flip.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "measure/plane.hpp"
#include "measure/srgb.hpp"
#include "measure/wide.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <numbers>

// Section and symbol names follow the paper. All computation is in double: the feature exponent 1/2
// would turn float's rounding of a flat area (1e-7) into 3e-4.
namespace catoptric::measure {
namespace {

// --- colour spaces -------------------------------------------------------------------------------

/// Matrix whose columns are the XYZ of red, green and blue, with the constants of the authors'
/// program.
const dmat3 kXyzFromRgb = {{10135552.0 / 24577794, 2613072.0 / 12288897, 1425312.0 / 73733382},
                           {8788810.0 / 24577794, 8788810.0 / 12288897, 8788810.0 / 73733382},
                           {4435075.0 / 24577794, 887015.0 / 12288897, 70074185.0 / 73733382}};
const dvec3 kWhiteXyz = kXyzFromRgb * dvec3(1);

/// Returns `matrix * v`. It is written out so that compilers vectorise loops over it.
inline dvec3 multiply(const dmat3& matrix, const dvec3& v) {
    return {matrix[0].x * v.x + matrix[1].x * v.y + matrix[2].x * v.z,
            matrix[0].y * v.x + matrix[1].y * v.y + matrix[2].y * v.z,
            matrix[0].z * v.x + matrix[1].z * v.y + matrix[2].z * v.z};
}

/// Matrix from linear RGB to XYZ divided by the XYZ of white.
const dmat3 kRelativeXyzFromRgb = {kXyzFromRgb[0] / kWhiteXyz, kXyzFromRgb[1] / kWhiteXyz,
                                   kXyzFromRgb[2] / kWhiteXyz};
const dmat3 kRgbFromRelativeXyz = glm::inverse(kRelativeXyzFromRgb);

/// Returns a colour in opponent space: x achromatic, y red-green, z blue-yellow.
inline dvec3 ycxcz_from_rgb(const dvec3& rgb, const dmat3& relative_from_rgb) {
    const dvec3 n = multiply(relative_from_rgb, rgb);
    return {116 * n.y - 16, 500 * (n.x - n.y), 200 * (n.y - n.z)};
}

inline dvec3 rgb_from_ycxcz(const dvec3& ycxcz, const dmat3& rgb_from_relative) {
    const double y = (ycxcz.x + 16) * (1.0 / 116);
    return multiply(rgb_from_relative, {y + ycxcz.y * (1.0 / 500), y, y - ycxcz.z * (1.0 / 200)});
}

inline double clamp_to_gamut(double value) { return std::min(std::max(value, 0.0), 1.0); }

/// Returns the cube root of `t` within 2e-14 of it, for t from 1e-30 to 1e30. Uses two steps of
/// Halley's method after a guess that divides the exponent by three. It has no branch, so compilers
/// vectorise loops over it.
inline double cube_root(double t) {
    constexpr std::int32_t kCubeRootBias =
        0x2a51'37a0; // makes the guess's largest error least, 3.5 %
    const auto bits = std::bit_cast<std::int32_t>(static_cast<float>(t));
    const auto root = static_cast<double>(std::bit_cast<float>(bits / 3 + kCubeRootBias));
    const auto nearer = [t](double guess) {
        const double cube = guess * guess * guess;
        return guess * (cube + 2 * t) / (2 * cube + t);
    };
    return nearer(nearer(root));
}

/// Returns a colour in CIELAB with the Hunt effect: colourfulness falls with lightness.
inline dvec3 hunt_lab_from_rgb(const dvec3& rgb, const dmat3& relative_from_rgb) {
    // CIELAB's linear part meets the cube root with equal value and slope, so no branch is needed.
    const auto f = [](double t) {
        constexpr double kCieLabDelta = 6.0 / 29,
                         kLabLinearEnd = kCieLabDelta * kCieLabDelta * kCieLabDelta;
        return cube_root(std::max(t, kLabLinearEnd)) +
               std::min(t - kLabLinearEnd, 0.0) * (1 / (3 * kCieLabDelta * kCieLabDelta));
    };
    const dvec3 n = multiply(relative_from_rgb, rgb);
    const double l = 116 * f(n.y) - 16;
    return {l, 0.01 * l * 500 * (f(n.x) - f(n.y)), 0.01 * l * 200 * (f(n.y) - f(n.z))};
}

/// Returns the length of (x, y). Unlike std::hypot, it assumes that squares neither overflow nor
/// underflow.
inline double vector_length(double x, double y) { return std::sqrt(x * x + y * y); }

double hyab_distance(const dvec3& a, const dvec3& b) {
    return std::abs(a.x - b.x) + vector_length(a.y - b.y, a.z - b.z);
}

// --- section 4.1: colour pipeline ----------------------------------------------------------------

/// Returns a Gaussian of the contrast sensitivity functions, a * sqrt(pi / b) * exp(-pi^2 x^2 / b),
/// with x in degrees. It is one factor of a separable two-dimensional kernel, so its amplitude is
/// the square root. The kernel ends where weights become negligible, and at most at `radius`.
FilterKernel make_sensitivity_kernel(double a, double b, int radius, double pixels_per_degree) {
    constexpr double kPi = std::numbers::pi;
    const double amplitude = std::sqrt(a * std::sqrt(kPi / b));
    // Share of the middle weight that is below float's rounding.
    constexpr double kNegligibleKernelWeight = 1e-10;
    const auto weight = [&](int i) {
        const double degrees = i / pixels_per_degree;
        return amplitude * std::exp(-kPi * kPi * degrees * degrees / b);
    };
    while (radius > 0 && weight(radius) < kNegligibleKernelWeight * amplitude) --radius;
    FilterKernel kernel(radius);
    for (int i = -radius; i <= radius; ++i) kernel[i] = weight(i);
    return kernel;
}

int colour_kernel_radius(double pixels_per_degree) {
    constexpr double kPi = std::numbers::pi;
    constexpr double kWidestGaussianParameter = 0.04; // the largest b below
    return static_cast<int>(
        std::ceil(3 * std::sqrt(kWidestGaussianParameter / (2 * kPi * kPi)) * pixels_per_degree));
}

/// Picture by channel, in opponent colours or another space.
using ChannelPlanes = std::array<ChannelPlane, 3>;

/// Part of a picture: pixels from `low` up to but excluding `high`.
struct PixelRegion {
    ivec2 low, high;
};

/// Converts linear RGB to opponent colours in place.
CATOPTRIC_WIDE void to_opponent(double* __restrict x, double* __restrict y, double* __restrict z,
                                std::size_t count) {
    const dmat3 relative_from_rgb = kRelativeXyzFromRgb; // a local copy stays in registers
    for (std::size_t i = 0; i < count; ++i) {
        const dvec3 colour = ycxcz_from_rgb({x[i], y[i], z[i]}, relative_from_rgb);
        x[i] = colour.x, y[i] = colour.y, z[i] = colour.z;
    }
}

/// Writes the pixels, three values each, as linear RGB.
void decode_pixels(const vec3* pixels, std::size_t count, PixelEncoding encoding,
                   double* __restrict red, double* __restrict green, double* __restrict blue) {
    const auto decode_all_pixels = [&](const auto& curve) {
        for (std::size_t i = 0; i < count; ++i) {
            red[i] = curve(pixels[i].x);
            green[i] = curve(pixels[i].y);
            blue[i] = curve(pixels[i].z);
        }
    };
    if (encoding == PixelEncoding::srgb)
        decode_all_pixels(SrgbDecodeTable());
    else
        decode_all_pixels([](float light) { return static_cast<double>(light); });
}

/// Writes the opponent colours of a part of a displayed picture with a border of `reach` pixels.
/// Beyond the picture, its outermost pixels are repeated.
void region_to_opponent(const Picture& display, PixelEncoding encoding, const PixelRegion& part,
                        int reach, ChannelPlanes& result) {
    const ivec2 size = part.high - part.low + 2 * reach, low = part.low - reach;
    const int first = std::max(0, -low.x), end = std::min(size.x, display.width - low.x);
    for (ChannelPlane& plane : result) plane.resize(size.x, size.y);
    const auto count = static_cast<std::size_t>(end - first);
    for (int y = 0; y < size.y; ++y) {
        const vec3* const pixels = &display.at(0, std::clamp(low.y + y, 0, display.height - 1));
        const std::array<double*, 3> rows = {result[0].row(y), result[1].row(y), result[2].row(y)};
        decode_pixels(pixels + low.x + first, count, encoding, rows[0] + first, rows[1] + first,
                      rows[2] + first);
        to_opponent(rows[0] + first, rows[1] + first, rows[2] + first, count);
        for (double* const row : rows) {
            std::fill(row, row + first, row[first]);
            std::fill(row + end, row + size.x, row[end - 1]);
        }
    }
}

/// Converts opponent colours to the perceptually uniform space in place, clamped to the gamut.
CATOPTRIC_WIDE void to_uniform(double* __restrict x, double* __restrict y, double* __restrict z,
                               std::size_t count) {
    // local copies stay in registers
    const dmat3 rgb_from_relative = kRgbFromRelativeXyz, relative_from_rgb = kRelativeXyzFromRgb;
    for (std::size_t i = 0; i < count; ++i) {
        const dvec3 rgb = rgb_from_ycxcz({x[i], y[i], z[i]}, rgb_from_relative);
        const dvec3 even = hunt_lab_from_rgb(
            {clamp_to_gamut(rgb.x), clamp_to_gamut(rgb.y), clamp_to_gamut(rgb.z)},
            relative_from_rgb);
        x[i] = even.x, y[i] = even.y, z[i] = even.z;
    }
}

/// Filters for the eye's contrast sensitivity: a low pass for each opponent channel. Each filter is
/// a sum of separable Gaussians with a total weight of 1.
struct ColourKernels {
    explicit ColourKernels(double pixels_per_degree)
        : achromatic_kernel(make_colour_kernel(1, 0.0047, pixels_per_degree)),
          red_green(make_colour_kernel(1, 0.0053, pixels_per_degree)),
          blue_yellow(make_colour_kernel(34.1, 0.04, pixels_per_degree)),
          blue_yellow_2(make_colour_kernel(13.5, 0.025, pixels_per_degree)) {
        normalise_sum({&achromatic_kernel});
        normalise_sum({&red_green});
        normalise_sum({&blue_yellow, &blue_yellow_2});
    }

    FilterKernel achromatic_kernel, red_green, blue_yellow, blue_yellow_2;

private:
    static FilterKernel make_colour_kernel(double a, double b, double pixels_per_degree) {
        return make_sensitivity_kernel(a, b, colour_kernel_radius(pixels_per_degree),
                                       pixels_per_degree);
    }
    static void normalise_sum(std::initializer_list<FilterKernel*> kernels) {
        double total = 0;
        for (const FilterKernel* kernel : kernels) {
            double line = 0;
            for (const double weight : kernel->weights) line += weight;
            total += line * line;
        }
        for (FilterKernel* kernel : kernels)
            for (double& weight : kernel->weights) weight /= std::sqrt(total);
    }
};

/// Maps a colour distance to [0,1] (eqs. 5 and 6). Small distances get most of the range.
class ColourDistanceMap {
public:
    /// Returns the mapped difference. `distance` is that of two colours by `hyab_distance`.
    float operator()(float distance) const {
        const float error = std::pow(distance, kColourErrorExponent);
        const float knee = kErrorKneeInput * largest_;
        return error < knee
                   ? kErrorKneeOutput / knee * error
                   : kErrorKneeOutput + (error - knee) / (largest_ - knee) * (1 - kErrorKneeOutput);
    }

private:
    static dvec3 hunt_lab_from_linear(const dvec3& rgb) {
        return hunt_lab_from_rgb(rgb, kRelativeXyzFromRgb);
    }

    static constexpr float kColourErrorExponent = 0.7F; // q_c
    static constexpr float kErrorKneeInput = 0.4F;      // p_c
    static constexpr float kErrorKneeOutput = 0.95F;    // p_t
    // Green against blue is the largest difference in the sRGB gamut.
    float largest_ = std::pow(static_cast<float>(hyab_distance(hunt_lab_from_linear({0, 1, 0}),
                                                               hunt_lab_from_linear({0, 0, 1}))),
                              kColourErrorExponent);
};

// --- section 4.2: feature pipeline ---------------------------------------------------------------

/// Scales positive weights to sum 1 and negative ones to sum -1.
void normalise(FilterKernel& kernel) {
    double positive = 0;
    double negative = 0;
    for (const double w : kernel.weights) (w > 0 ? positive : negative) += std::abs(w);
    for (double& w : kernel.weights) w /= w > 0 ? positive : negative;
}

double feature_kernel_deviation(double pixels_per_degree) {
    return 0.5 * 0.082 * pixels_per_degree;
}
int feature_kernel_radius(double pixels_per_degree) {
    return static_cast<int>(std::ceil(3 * feature_kernel_deviation(pixels_per_degree)));
}

/// Kernels of the feature detector: a Gaussian with the width of the eye's edge detector, 0.082
/// degrees, and its first two derivatives.
struct FeatureKernels {
    explicit FeatureKernels(double pixels_per_degree)
        : smooth_kernel(feature_kernel_radius(pixels_per_degree)), first(smooth_kernel.radius),
          second(smooth_kernel.radius) {
        const double deviation = feature_kernel_deviation(pixels_per_degree);
        for (int i = -smooth_kernel.radius; i <= smooth_kernel.radius; ++i) {
            const double squared = i * i / (deviation * deviation);
            smooth_kernel[i] = std::exp(-squared / 2);
            first[i] = -i * smooth_kernel[i];
            second[i] = (squared - 1) * smooth_kernel[i];
        }
        normalise(smooth_kernel), normalise(first), normalise(second);
        // Luminance is (achromatic + 16) / 116, and the constant 16 vanishes in derivatives.
        for (FilterKernel* derivative : {&first, &second})
            for (double& weight : derivative->weights) weight /= 116;
    }

    FilterKernel smooth_kernel, first, second;
};

CATOPTRIC_WIDE void vector_lengths(double* __restrict x, const double* __restrict y,
                                   std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) x[i] = vector_length(x[i], y[i]);
}

/// Returns the feature difference in [0,1] (eq. 7).
inline double feature_difference(double edge_a, double edge_b, double point_a, double point_b) {
    const double largest = std::max(std::abs(edge_a - edge_b), std::abs(point_a - point_b));
    return std::sqrt(largest / std::numbers::sqrt2); // q_f = 1/2
}

/// Filters of FLIP at one distance from the screen.
struct FlipKernels {
    ColourKernels colour;
    FeatureKernels feature;
    int reach; ///< largest radius of the filters
};

/// Data of one picture that FLIP compares.
struct FlipInput {
    ChannelPlanes colour;     ///< filtered, clamped to the gamut, in the perceptually uniform space
    ChannelPlane edge, point; ///< strength of an edge and of a point at each pixel
};

/// Writes the distances of colours and of features, pixel by pixel.
CATOPTRIC_WIDE void compute_distances(const FlipInput& a, const FlipInput& b,
                                      float* __restrict colours, float* __restrict features) {
    const std::size_t count = a.edge.values.size();
    const double *a_x = a.colour[0].values.data(), *a_y = a.colour[1].values.data(),
                 *a_z = a.colour[2].values.data();
    const double *b_x = b.colour[0].values.data(), *b_y = b.colour[1].values.data(),
                 *b_z = b.colour[2].values.data();
    const double *edge_a = a.edge.values.data(), *edge_b = b.edge.values.data();
    const double *point_a = a.point.values.data(), *point_b = b.point.values.data();
    for (std::size_t i = 0; i < count; ++i) {
        colours[i] = static_cast<float>(std::abs(a_x[i] - b_x[i]) +
                                        vector_length(a_y[i] - b_y[i], a_z[i] - b_z[i]));
        features[i] = static_cast<float>(
            feature_difference(edge_a[i], edge_b[i], point_a[i], point_b[i]));
    }
}

/// Computes parts of a map, one after the other in the same memory.
class FlipRegionComputer {
public:
    FlipRegionComputer(const FlipKernels& kernels, PixelEncoding encoding)
        : kernels_(kernels), encoding_(encoding) {}

    /// Writes the map of `part` to `to`. Its rows begin `stride` values apart.
    void write_region(const Picture& a, const Picture& b, const PixelRegion& part, float* to,
                      std::ptrdiff_t stride) {
        prepare(a, part, a_);
        prepare(b, part, b_);
        colours_.resize(a_.edge.values.size()), features_.resize(a_.edge.values.size());
        compute_distances(a_, b_, colours_.data(), features_.data());
        std::size_t i = 0;
        for (int y = part.low.y; y < part.high.y; ++y, to += stride)
            for (int x = 0; x < part.high.x - part.low.x; ++x, ++i)
                to[x] = std::pow(colour_difference_(colours_[i]), 1 - features_[i]); // eq. 8
    }

private:
    void prepare(const Picture& display, const PixelRegion& part, FlipInput& seen) {
        region_to_opponent(display, encoding_, part, kernels_.reach, opponent_);
        const auto& [achromatic, red_green, blue_yellow] = opponent_;
        const ColourKernels& colour = kernels_.colour;
        convolve_x(achromatic, colour.achromatic_kernel, kernels_.reach, part_);
        sum_convolutions_y({{part_, colour.achromatic_kernel}}, kernels_.reach, seen.colour[0]);
        convolve_x(red_green, colour.red_green, kernels_.reach, part_);
        sum_convolutions_y({{part_, colour.red_green}}, kernels_.reach, seen.colour[1]);
        convolve_x(blue_yellow, colour.blue_yellow, kernels_.reach, part_);
        convolve_x(blue_yellow, colour.blue_yellow_2, kernels_.reach, part_2_);
        sum_convolutions_y({{part_, colour.blue_yellow}, {part_2_, colour.blue_yellow_2}},
                           kernels_.reach, seen.colour[2]);
        to_uniform(seen.colour[0].values.data(), seen.colour[1].values.data(),
                   seen.colour[2].values.data(), seen.colour[0].values.size());

        convolve_x(achromatic, kernels_.feature.smooth_kernel, kernels_.reach, smooth_x_);
        luminance_gradient(kernels_.feature.first, seen.edge);
        luminance_gradient(kernels_.feature.second, seen.point);
    }

    /// Writes the magnitude of the luminance's gradient by a derivative of a Gaussian.
    void luminance_gradient(const FilterKernel& derivative, ChannelPlane& magnitude) {
        convolve_x(opponent_[0], derivative, kernels_.reach, part_);
        sum_convolutions_y({{part_, kernels_.feature.smooth_kernel}}, kernels_.reach, magnitude);
        sum_convolutions_y({{smooth_x_, derivative}}, kernels_.reach, part_2_);
        vector_lengths(magnitude.values.data(), part_2_.values.data(), magnitude.values.size());
    }

    const FlipKernels& kernels_;
    PixelEncoding encoding_;
    ChannelPlanes opponent_;
    ChannelPlane part_, part_2_, smooth_x_;
    FlipInput a_, b_;
    std::vector<float> colours_, features_;
    ColourDistanceMap colour_difference_;
};

} // namespace

std::vector<float> flip(const Picture& a, const Picture& b, double pixels_per_degree) {
    return flip_rows(a, b, 0, a.height, PixelEncoding::srgb, pixels_per_degree);
}

std::vector<float> flip_rows(const Picture& a, const Picture& b, int first, int end,
                             PixelEncoding encoding, double pixels_per_degree) {
    check(a.width == b.width && a.height == b.height, Failure::bad_data,
          "FLIP wants two pictures "
          "of the same size, found ",
          a.width, "x", a.height, " and ", b.width, "x", b.height);
    check(a.width > 0 && a.height > 0, Failure::bad_data, "FLIP wants at least one pixel, found ",
          a.width, "x", a.height);
    check(pixels_per_degree >= 1 && pixels_per_degree <= 1000, Failure::usage,
          "FLIP wants 1 to 1000 pixels per degree, found ", pixels_per_degree);
    check(0 <= first && first <= end && end <= a.height, Failure::internal,
          "FLIP wants rows of 0 to ", a.height, ", found ", first, " to ", end);

    // The planes of a tile stay in the cache. Each tile is computed with as many pixels around it
    // as the filters reach, so no pixel depends on the tiling.
    constexpr int kFlipTileEdge = 128;
    const FlipKernels kernels{ColourKernels(pixels_per_degree), FeatureKernels(pixels_per_degree),
                              flip_filter_radius(pixels_per_degree)};
    const ivec2 size(a.width, end - first), tiles = (size + kFlipTileEdge - 1) / kFlipTileEdge;
    std::vector<float> map(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
    const int tile_count = tiles.x * tiles.y;
    std::atomic<int> next{0};
    const auto work = [&](std::size_t) {
        FlipRegionComputer part_of_map(kernels, encoding);
        for (int tile = next++; tile < tile_count; tile = next++) {
            const ivec2 low = kFlipTileEdge * ivec2(tile % tiles.x, tile / tiles.x);
            const ivec2 high = min(low + kFlipTileEdge, size), from(0, first);
            part_of_map.write_region(a, b, {low + from, high + from},
                                     map.data() + std::ptrdiff_t(low.y) * size.x + low.x, size.x);
        }
    };
    const unsigned threads = std::min(hardware_thread_count(), static_cast<unsigned>(tile_count));
    parallel_for(threads, threads, work);
    return map;
}

int flip_filter_radius(double pixels_per_degree) {
    return std::max(colour_kernel_radius(pixels_per_degree),
                    feature_kernel_radius(pixels_per_degree));
}

double flip_mean(std::span<const float> map, const Mask& mask) {
    check(mask.empty() || mask.size() == map.size(), Failure::internal, "mask of ", mask.size(),
          " pixels for a FLIP map of ", map.size());
    double sum = 0;
    double count = 0;
    for (std::size_t i = 0; i < map.size(); ++i) {
        if (!mask.empty() && mask[i] == 0) continue;
        sum += static_cast<double>(map[i]);
        count += 1;
    }
    return sum / count; // 0/0 is NaN: without a pixel there is no mean
}

} // namespace catoptric::measure
