#pragma once

#include <string>
#include <string_view>
#include <vector>

// Building blocks of the report's SVG drawings.
namespace catoptric::report::svg {

/// Approximate letter width and line height of an 11 px label, pixels.
inline constexpr double kLetter = 6.6, kLine = 13;

/// Mapping from the logarithm of a value to pixels.
struct Scale {
    double low, high; ///< logarithms to base 10
    double from, to;  ///< pixels
    double operator()(double value) const;
};

/// Returns a scale that covers all values, which are positive, with a margin. A single value gets
/// one decade.
Scale log_scale(const std::vector<double>& values, double from, double to);

/// Returns 1, 2 and 5 times the powers of ten inside the scale.
std::vector<double> ticks(const Scale& scale);

std::string grid_line(double x0, double y0, double x1, double y1);
/// Returns a text element. `anchor` is start, middle or end. `content` is not escaped.
std::string text(double x, double y, const char* anchor, std::string_view content);

} // namespace catoptric::report::svg
