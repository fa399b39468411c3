#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace catoptric::scene {

/// Returns the shortest text that reads back as the same number; "0" for both zeros.
std::string format_number(double number);
std::string format_number(float number);

/// Returns the double with the same shortest text as the float, as a person would type it: 0.1 for
/// 0.1f.
double shortest_double(float number);

/// Returns the finite number that the whole of `text` spells, with an optional sign; otherwise
/// nothing.
std::optional<double> parse_number(std::string_view text);

} // namespace catoptric::scene
