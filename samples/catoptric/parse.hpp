#pragma once

#include "core/math.hpp"

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

/// Text of the command line to values. Each throws `Failure::usage` naming the option, what was
/// wanted and what was found.
namespace catoptric::cli {

/// "640x480", both at least 1.
uvec2 parse_size(const std::string& option, const std::string& text);

std::int64_t parse_whole(const std::string& option, const std::string& text, std::int64_t low,
                         std::int64_t high);
std::uint64_t parse_seed(const std::string& option, const std::string& text);

/// A finite number in [low, high].
double parse_real(const std::string& option, const std::string& text,
                  double low = -std::numeric_limits<double>::max(),
                  double high = std::numeric_limits<double>::max());

/// Index of `text` in `choices`; the message suggests the nearest.
std::size_t parse_choice(const std::string& option, const std::string& text,
                         const std::vector<std::string>& choices);

/// "a, b, c".
std::string join(const std::vector<std::string>& parts);

} // namespace catoptric::cli
