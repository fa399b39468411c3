#include "measure/flip.hpp"

#include "core/error.hpp"
#include "measure/plane.hpp"
#include "measure/srgb.hpp"

#include <algorithm>
#include <array>
#include <cmath>
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

dvec3 rgb_from_ycxcz(const dvec3& ycxcz) {
    const double y = (ycxcz.x + 16) / 116;
    return kRgbFromXyz * (dvec3(y + ycxcz.y / 500, y, y - ycxcz.z / 200) * kWhite);
}

/// CIELAB with the Hunt effect: colourfulness falls with lightness.
dvec3 hunt_lab_from_rgb(const dvec3& rgb) {
    const auto f = [](double t) {
        constexpr double kDelta = 6.0 / 29;
        return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
    };
    const dvec3 n = kXyzFromRgb * rgb / kWhite;
    const double l = 116 * f(n.y) - 16;
    return {l, 0.01 * l * 500 * (f(n.x) - f(n.y)), 0.01 * l * 200 * (f(n.y) - f(n.z))};
}

double hyab(const dvec3& a, const dvec3& b) {
    return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

// --- section 4.1: colour pipeline ----------------------------------------------------------------

/// Gaussian of the contrast sensitivity functions, a * sqrt(pi / b) * exp(-pi^2 x^2 / b), x in
/// degrees, as a factor of a separable two-dimensional kernel: its amplitude under a square root.
Kernel sensitivity(double a, double b, int radius, double pixels_per_degree) {
    constexpr double kPi = std::numbers::pi;
    const double amplitude = std::sqrt(a * std::sqrt(kPi / b));
    Kernel kernel(radius);
    for (int i = -radius; i <= radius; ++i) {
        const double degrees = i / pixels_per_degree;
        kernel[i] = amplitude * std::exp(-kPi * kPi * degrees * degrees / b);
    }
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

/// Filtered, clamped into the gamut, in the perceptually even space.
std::vector<dvec3> perceived(const Picture& display, double pixels_per_degree) {
    const int radius = colour_radius(pixels_per_degree);
    const auto gaussian = [&](double a, double b) {
        return sensitivity(a, b, radius, pixels_per_degree);
    };
    const std::array<std::vector<Kernel>, 3> kernels = {
        std::vector{gaussian(1, 0.0047)}, std::vector{gaussian(1, 0.0053)},
        std::vector{gaussian(34.1, 0.04), gaussian(13.5, 0.025)}};

    std::vector<dvec3> result(display.pixels.size());
    for (std::size_t i = 0; i < result.size(); ++i) {
        const vec3& p = display.pixels[i];
        result[i] = ycxcz_from_rgb(
            {linear_from_srgb(p.x), linear_from_srgb(p.y), linear_from_srgb(p.z)});
    }
    for (int channel = 0; channel < 3; ++channel) {
        Plane plane(display.width, display.height);
        for (std::size_t i = 0; i < result.size(); ++i) plane.values[i] = result[i][channel];
        plane = blurred(plane, kernels[static_cast<std::size_t>(channel)]);
        for (std::size_t i = 0; i < result.size(); ++i) result[i][channel] = plane.values[i];
    }
    for_rows(display.height, [&](int y) {
        const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(y) * display.width;
        for (std::ptrdiff_t i = first; i < first + display.width; ++i) {
            dvec3& p = result[static_cast<std::size_t>(i)];
            p = hunt_lab_from_rgb(glm::clamp(rgb_from_ycxcz(p), dvec3(0), dvec3(1)));
        }
    });
    return result;
}

/// Colour difference in [0,1] (eqs. 5 and 6): small differences get most of the range.
class ColourDifference {
public:
    double operator()(const dvec3& a, const dvec3& b) const {
        const double error = std::pow(hyab(a, b), kExponent);
        const double knee = kKneeIn * largest_;
        return error < knee ? kKneeOut / knee * error
                            : kKneeOut + (error - knee) / (largest_ - knee) * (1 - kKneeOut);
    }

private:
    static constexpr double kExponent = 0.7; // q_c
    static constexpr double kKneeIn = 0.4;   // p_c
    static constexpr double kKneeOut = 0.95; // p_t
    // Green against blue is the largest difference in the sRGB gamut.
    double largest_ = std::pow(hyab(hunt_lab_from_rgb({0, 1, 0}), hunt_lab_from_rgb({0, 0, 1})),
                               kExponent);
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

/// Gradient magnitudes of the luminance by the first (edge) and second (point) derivative of a
/// Gaussian whose width is that of the eye's edge detector, 0.082 degrees.
Features features(const Picture& display, double pixels_per_degree) {
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

    Plane luminance(display.width, display.height);
    for (std::size_t i = 0; i < luminance.values.size(); ++i) {
        const vec3& p = display.pixels[i];
        const dvec3 linear(linear_from_srgb(p.x), linear_from_srgb(p.y), linear_from_srgb(p.z));
        luminance.values[i] = (ycxcz_from_rgb(linear).x + 16) / 116;
    }
    const Plane smooth_x = along_x(luminance, smooth);
    const auto magnitude = [&](const Kernel& derivative) {
        Plane result = along_y(along_x(luminance, derivative), smooth);
        const Plane other = along_y(smooth_x, derivative);
        for (std::size_t i = 0; i < result.values.size(); ++i)
            result.values[i] = std::hypot(result.values[i], other.values[i]);
        return result;
    };
    return {magnitude(first), magnitude(second)};
}

/// Feature difference in [0,1] (eq. 7).
double feature_difference(double edge_a, double edge_b, double point_a, double point_b) {
    const double largest = std::max(std::abs(edge_a - edge_b), std::abs(point_a - point_b));
    return std::sqrt(largest / std::numbers::sqrt2); // q_f = 1/2
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

    const std::vector<dvec3> seen_a = perceived(a, pixels_per_degree);
    const std::vector<dvec3> seen_b = perceived(b, pixels_per_degree);
    const Features of_a = features(a, pixels_per_degree);
    const Features of_b = features(b, pixels_per_degree);
    const ColourDifference colour_difference;
    std::vector<float> map(a.pixels.size());
    for_rows(a.height, [&](int y) {
        const std::size_t first = static_cast<std::size_t>(y) * static_cast<std::size_t>(a.width);
        for (std::size_t i = first; i < first + static_cast<std::size_t>(a.width); ++i) {
            const double colour = colour_difference(seen_a[i], seen_b[i]);
            const double feature = feature_difference(of_a.edge.values[i], of_b.edge.values[i],
                                                      of_a.point.values[i], of_b.point.values[i]);
            map[i] = static_cast<float>(std::pow(colour, 1 - feature)); // eq. 8
        }
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
