#pragma once

#include <string>
#include <string_view>
#include <vector>

// What the report's drawings are made of.
namespace catoptric::report::svg {

inline constexpr double kLetter = 6.6, kLine = 13; ///< pixels of an 11 px label, about

/// From the logarithm of a value to pixels.
struct Scale {
    double low, high; ///< logarithms to base 10
    double from, to;  ///< pixels
    double operator()(double value) const;
};

/// Room for all values (positive) with some air; one decade around a single one.
Scale log_scale(const std::vector<double>& values, double from, double to);

/// 1, 2 and 5 times powers of ten inside the scale.
std::vector<double> ticks(const Scale& scale);

std::string grid_line(double x0, double y0, double x1, double y1);
/// `anchor`: start, middle or end. The content is not escaped.
std::string text(double x, double y, const char* anchor, std::string_view content);

} // namespace catoptric::report::svg
