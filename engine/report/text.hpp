#pragma once

#include "report/comparison.hpp"

#include <cstdint>
#include <string>
#include <string_view>

// How numbers read in the report, the same in Markdown and HTML. What is not there reads "–".
namespace catoptric::report {

inline constexpr std::string_view kNothing = "–";

/// With so many decimals; "–" for NaN and infinities.
std::string fixed(double value, int decimals);
/// An error in 0..1: four decimals, "0" for exactly 0, a power of ten below 0.0001.
std::string error_text(double error);
/// Milliseconds with three significant digits.
std::string ms_text(double ms);
/// Decimals at which the fastest row still has three significant digits: one for a whole table, so
/// that its columns line up.
int ms_decimals(const Comparison& comparison);
/// 1000 / ms with three significant digits; "–" when no time passed.
std::string fps_text(double ms);
std::string mebibytes(std::uint64_t bytes);
/// Of a picture of the comparison, from the report's folder.
std::string image_path(const Comparison& comparison, const std::string& file);
/// "bounces=3, face=256".
std::string settings_text(const Row& row);
/// What a run has of what it was asked for and why no more: "4 of 8 rows: ...".
std::string incomplete_text(std::size_t rows, std::size_t asked,
                            const std::optional<Error>& stopped);
/// The same, and of the lag; empty when it is complete.
std::string incomplete_text(const Comparison& comparison);
std::string joined(const std::vector<std::string>& parts, std::string_view between);

} // namespace catoptric::report
