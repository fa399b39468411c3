#include "measure/flip.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "measure/plane.hpp"
#include "measure/srgb.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

// Section and symbol names follow the paper. Double throughout: the feature exponent 1/2 would turn
// float's rounding of a flat area (1e-7) into 3e-4.
namespace catoptric::measure {
namespace {

// --- colour spaces -------------------------------------------------------------------------------

/// Columns are the XYZ of red, green and blue, the constants of the authors' program.
const dmat3 kXyzFromRgb = {{10135552.0 / 24577794, 2613072.0 / 12288897, 1425312.0 / 73733382},
                           {8788810.0 / 24577794, 8788810.0 / 12288897, 8788810.0 / 73733382},
                           {4435075.0 / 24577794, 887015.0 / 12288897, 70074185.0 / 73733382}};
const dmat3 kRgbFromXyz = glm::inverse(kXyzFromRgb);
const dvec3 kWhite = kXyzFromRgb * dvec3(1);

/// Opponent space: x achromatic, y red-green, z blue-yellow.
dvec3 ycxcz_from_rgb(const dvec3& rgb) {
    const dvec3 n = kXyzFromRgb * rgb / kWhite;
    return {116 * n.y - 16, 500 * (n.x - n.y), 200 * (n.y - n.z)};
}

/// As `matrix * v`, written out: loops over it become vector code.
inline dvec3 product(const dmat3& matrix, const dvec3& v) {
    return {matrix[0].x * v.x + matrix[1].x * v.y + matrix[2].x * v.z,
            matrix[0].y * v.x + matrix[1].y * v.y + matrix[2].y * v.z,
            matrix[0].z * v.x + matrix[1].z * v.y + matrix[2].z * v.z};
}

inline dvec3 rgb_from_ycxcz(const dvec3& ycxcz, const dmat3& rgb_from_xyz, const dvec3& white) {
    const double y = (ycxcz.x + 16) * (1.0 / 116);
    return product(rgb_from_xyz, {white.x * (y + ycxcz.y * (1.0 / 500)), white.y * y,
                                  white.z * (y - ycxcz.z * (1.0 / 200))});
}

inline double within_gamut(double value) { return std::min(std::max(value, 0.0), 1.0); }

/// Returns the cube root of `t` within 2e-14 of it, for t from 1e-30 to 1e30, without a branch:
/// loops over it become vector code. Two steps of Halley's method after a guess that divides the
/// exponent by three.
inline double cube_root(double t) {
    constexpr std::int32_t kBias = 0x2a51'37a0; // makes the guess's largest error least, 3.5 %
    const auto bits = std::bit_cast<std::int32_t>(static_cast<float>(t));
    const auto root = static_cast<double>(std::bit_cast<float>(bits / 3 + kBias));
    const auto nearer = [t](double guess) {
        const double cube = guess * guess * guess;
        return guess * (cube + 2 * t) / (2 * cube + t);
    };
    return nearer(nearer(root));
}

/// CIELAB with the Hunt effect: colourfulness falls with lightness.
inline dvec3 hunt_lab_from_rgb(const dvec3& rgb, const dmat3& xyz_from_rgb, const dvec3& white) {
    // Its straight part meets the cube root at the same value and slope, so no branch is needed.
    const auto f = [](double t) {
        constexpr double kDelta = 6.0 / 29, kLeast = kDelta * kDelta * kDelta;
        return cube_root(std::max(t, kLeast)) +
               std::min(t - kLeast, 0.0) * (1 / (3 * kDelta * kDelta));
    };
    const dvec3 xyz = product(xyz_from_rgb, rgb);
    const dvec3 n(xyz.x / white.x, xyz.y / white.y, xyz.z / white.z);
    const double l = 116 * f(n.y) - 16;
    return {l, 0.01 * l * 500 * (f(n.x) - f(n.y)), 0.01 * l * 200 * (f(n.y) - f(n.z))};
}

/// Of values that neither overflow nor underflow when squared, which std::hypot allows for.
inline double length(double x, double y) { return std::sqrt(x * x + y * y); }

double hyab(const dvec3& a, const dvec3& b) {
    return std::abs(a.x - b.x) + length(a.y - b.y, a.z - b.z);
}

// --- section 4.1: colour pipeline ----------------------------------------------------------------

/// Gaussian of the contrast sensitivity functions, a * sqrt(pi / b) * exp(-pi^2 x^2 / b), x in
/// degrees, as a factor of a separable two-dimensional kernel: its amplitude under a square root.
/// Reaches as far as its weights matter, at most to `radius`.
Kernel sensitivity(double a, double b, int radius, double pixels_per_degree) {
    constexpr double kPi = std::numbers::pi;
    const double amplitude = std::sqrt(a * std::sqrt(kPi / b));
    constexpr double kNothing = 1e-10; // of the weight in the middle: below a float's rounding
    const auto weight = [&](int i) {
        const double degrees = i / pixels_per_degree;
        return amplitude * std::exp(-kPi * kPi * degrees * degrees / b);
    };
    while (radius > 0 && weight(radius) < kNothing * amplitude) --radius;
    Kernel kernel(radius);
    for (int i = -radius; i <= radius; ++i) kernel[i] = weight(i);
    return kernel;
}

/// The picture through the eye's contrast sensitivity: a low pass for each opponent channel, which
/// is a sum of separable Gaussians with a total weight of 1.
Plane blurred(const Plane& channel, const std::vector<Kernel>& kernels) {
    Plane sum(channel.width, channel.height);
    double total = 0;
    for (const Kernel& kernel : kernels) {
        double line = 0;
        for (const double weight : kernel.weights) line += weight;
        total += line * line;
        const Plane part = along_y(along_x(channel, kernel), kernel);
        for (std::size_t i = 0; i < sum.values.size(); ++i) sum.values[i] += part.values[i];
    }
    for (double& value : sum.values) value /= total;
    return sum;
}

int colour_radius(double pixels_per_degree) {
    constexpr double kPi = std::numbers::pi;
    constexpr double kWidest = 0.04; // the largest b below
    return static_cast<int>(
        std::ceil(3 * std::sqrt(kWidest / (2 * kPi * kPi)) * pixels_per_degree));
}

/// A picture by channel, opponent colours or others.
using Channels = std::array<Plane, 3>;

/// Returns opponent colours of a picture as the screen shows it.
Channels opponent(const Picture& display) {
    const Plane empty(display.width, display.height);
    Channels result{empty, empty, empty};
    constexpr LinearTable kLinear;
    for (std::size_t i = 0; i < display.pixels.size(); ++i) {
        const vec3& p = display.pixels[i];
        const dvec3 colour = ycxcz_from_rgb({kLinear(p.x), kLinear(p.y), kLinear(p.z)});
        for (std::size_t c = 0; c < 3; ++c) result[c].values[i] = colour[static_cast<int>(c)];
    }
    return result;
}

/// Clamps colours of opponent space into the gamut; writes them in the perceptually even space.
CATOPTRIC_WIDE void make_even(double* __restrict x, double* __restrict y, double* __restrict z,
                              std::size_t count) {
    const dmat3 rgb_from_xyz = kRgbFromXyz, xyz_from_rgb = kXyzFromRgb; // stay in registers
    const dvec3 white = kWhite;
    for (std::size_t i = 0; i < count; ++i) {
        const dvec3 rgb = rgb_from_ycxcz({x[i], y[i], z[i]}, rgb_from_xyz, white);
        const dvec3 even = hunt_lab_from_rgb(
            {within_gamut(rgb.x), within_gamut(rgb.y), within_gamut(rgb.z)}, xyz_from_rgb, white);
        x[i] = even.x, y[i] = even.y, z[i] = even.z;
    }
}

/// Filtered, clamped into the gamut, in the perceptually even space.
Channels perceived(const Channels& opponent, double pixels_per_degree) {
    const int radius = colour_radius(pixels_per_degree);
    const auto gaussian = [&](double a, double b) {
        return sensitivity(a, b, radius, pixels_per_degree);
    };
    const auto& [y, cx, cz] = opponent;
    Channels result{blurred(y, {gaussian(1, 0.0047)}), blurred(cx, {gaussian(1, 0.0053)}),
                    blurred(cz, {gaussian(34.1, 0.04), gaussian(13.5, 0.025)})};
    make_even(result[0].values.data(), result[1].values.data(), result[2].values.data(),
              result[0].values.size());
    return result;
}

/// Colour difference in [0,1] (eqs. 5 and 6): small differences get most of the range.
class ColourDifference {
public:
    /// `distance`: of two colours, as `hyab`.
    float operator()(float distance) const {
        const float error = std::pow(distance, kExponent);
        const float knee = kKneeIn * largest_;
        return error < knee ? kKneeOut / knee * error
                            : kKneeOut + (error - knee) / (largest_ - knee) * (1 - kKneeOut);
    }

private:
    static dvec3 lab(const dvec3& rgb) { return hunt_lab_from_rgb(rgb, kXyzFromRgb, kWhite); }

    static constexpr float kExponent = 0.7F; // q_c
    static constexpr float kKneeIn = 0.4F;   // p_c
    static constexpr float kKneeOut = 0.95F; // p_t
    // Green against blue is the largest difference in the sRGB gamut.
    float largest_ = std::pow(static_cast<float>(hyab(lab({0, 1, 0}), lab({0, 0, 1}))), kExponent);
};

// --- section 4.2: feature pipeline ---------------------------------------------------------------

/// How strong an edge and a point are at a pixel.
struct Features {
    Plane edge;
    Plane point;
};

/// Scales positive weights to sum 1 and negative ones to sum -1.
void normalise(Kernel& kernel) {
    double positive = 0;
    double negative = 0;
    for (const double w : kernel.weights) (w > 0 ? positive : negative) += std::abs(w);
    for (double& w : kernel.weights) w /= w > 0 ? positive : negative;
}

double feature_deviation(double pixels_per_degree) { return 0.5 * 0.082 * pixels_per_degree; }
int feature_radius(double pixels_per_degree) {
    return static_cast<int>(std::ceil(3 * feature_deviation(pixels_per_degree)));
}

CATOPTRIC_WIDE void lengths(double* __restrict x, const double* __restrict y, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) x[i] = length(x[i], y[i]);
}

/// Gradient magnitudes of the luminance by the first (edge) and second (point) derivative of a
/// Gaussian whose width is that of the eye's edge detector, 0.082 degrees.
Features features(const Plane& achromatic, double pixels_per_degree) {
    const double deviation = feature_deviation(pixels_per_degree);
    const int radius = feature_radius(pixels_per_degree);
    Kernel smooth(radius), first(radius), second(radius);
    for (int i = -radius; i <= radius; ++i) {
        const double squared = i * i / (deviation * deviation);
        smooth[i] = std::exp(-squared / 2);
        first[i] = -i * smooth[i];
        second[i] = (squared - 1) * smooth[i];
    }
    normalise(smooth), normalise(first), normalise(second);

    Plane luminance = achromatic;
    for (double& value : luminance.values) value = (value + 16) / 116;
    const Plane smooth_x = along_x(luminance, smooth);
    const auto magnitude = [&](const Kernel& derivative) {
        Plane result = along_y(along_x(luminance, derivative), smooth);
        const Plane other = along_y(smooth_x, derivative);
        lengths(result.values.data(), other.values.data(), result.values.size());
        return result;
    };
    return {magnitude(first), magnitude(second)};
}

/// Feature difference in [0,1] (eq. 7).
inline double feature_difference(double edge_a, double edge_b, double point_a, double point_b) {
    const double largest = std::max(std::abs(edge_a - edge_b), std::abs(point_a - point_b));
    return std::sqrt(largest / std::numbers::sqrt2); // q_f = 1/2
}

/// Distances of colours and of features, pixel by pixel.
CATOPTRIC_WIDE void compare(const Channels& a, const Channels& b, const Features& of_a,
                            const Features& of_b, float* __restrict colours,
                            float* __restrict features) {
    const std::size_t count = of_a.edge.values.size();
    const double *a_x = a[0].values.data(), *a_y = a[1].values.data(), *a_z = a[2].values.data();
    const double *b_x = b[0].values.data(), *b_y = b[1].values.data(), *b_z = b[2].values.data();
    const double *edge_a = of_a.edge.values.data(), *edge_b = of_b.edge.values.data();
    const double *point_a = of_a.point.values.data(), *point_b = of_b.point.values.data();
    for (std::size_t i = 0; i < count; ++i) {
        colours[i] = static_cast<float>(std::abs(a_x[i] - b_x[i]) +
                                        length(a_y[i] - b_y[i], a_z[i] - b_z[i]));
        features[i] = static_cast<float>(
            feature_difference(edge_a[i], edge_b[i], point_a[i], point_b[i]));
    }
}

/// Part of a picture, from `low` to before `high`.
struct Part {
    ivec2 low, high;
};

Picture cut_out(const Picture& picture, const Part& part) {
    Picture result(part.high.x - part.low.x, part.high.y - part.low.y);
    for (int y = part.low.y; y < part.high.y; ++y)
        for (int x = part.low.x; x < part.high.x; ++x)
            result.at(x - part.low.x, y - part.low.y) = picture.at(x, y);
    return result;
}

/// The map of a whole picture, on one core.
std::vector<float> map_of(const Picture& a, const Picture& b, double pixels_per_degree) {
    const Channels opponent_a = opponent(a), opponent_b = opponent(b);
    const std::size_t count = a.pixels.size();
    std::vector<float> colours(count), features_apart(count);
    compare(perceived(opponent_a, pixels_per_degree), perceived(opponent_b, pixels_per_degree),
            features(opponent_a[0], pixels_per_degree), features(opponent_b[0], pixels_per_degree),
            colours.data(), features_apart.data());
    const ColourDifference colour_difference;
    for (std::size_t i = 0; i < count; ++i)
        colours[i] = std::pow(colour_difference(colours[i]), 1 - features_apart[i]); // eq. 8
    return colours;
}

} // namespace

std::vector<float> flip(const Picture& a, const Picture& b, double pixels_per_degree) {
    check(a.width == b.width && a.height == b.height, Failure::bad_data,
          "FLIP wants two pictures "
          "of the same size, found ",
          a.width, "x", a.height, " and ", b.width, "x", b.height);
    check(a.width > 0 && a.height > 0, Failure::bad_data, "FLIP wants at least one pixel, found ",
          a.width, "x", a.height);
    check(pixels_per_degree >= 1 && pixels_per_degree <= 1000, Failure::usage,
          "FLIP wants 1 to 1000 pixels per degree, found ", pixels_per_degree);

    // Tiles whose planes stay in the cache. Each is computed with as much around it as filters
    // reach, so no pixel depends on where tiles end.
    constexpr int kTile = 256;
    const int reach = flip_reach(pixels_per_degree);
    const ivec2 size(a.width, a.height), tiles = (size + kTile - 1) / kTile;
    std::vector<float> map(a.pixels.size());
    in_parallel(static_cast<std::size_t>(tiles.x) * static_cast<std::size_t>(tiles.y),
                all_threads(), [&](std::size_t i) {
                    const int tile = static_cast<int>(i);
                    const ivec2 low = kTile * ivec2(tile % tiles.x, tile / tiles.x);
                    const ivec2 high = min(low + kTile, size);
                    const Part part{max(low - reach, ivec2(0)), min(high + reach, size)};
                    const std::vector<float> inner = map_of(cut_out(a, part), cut_out(b, part),
                                                            pixels_per_degree);
                    const int width = part.high.x - part.low.x;
                    for (int y = low.y; y < high.y; ++y)
                        std::copy_n(inner.begin() + (y - part.low.y) * width + (low.x - part.low.x),
                                    high.x - low.x,
                                    map.begin() + std::ptrdiff_t(y) * a.width + low.x);
                });
    return map;
}

int flip_reach(double pixels_per_degree) {
    return std::max(colour_radius(pixels_per_degree), feature_radius(pixels_per_degree));
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
    return sum / count; // 0/0 is NaN: no pixel, no error
}

} // namespace catoptric::measure
