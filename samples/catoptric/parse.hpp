#pragma once

#include "core/error.hpp"
#include "core/math.hpp"

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

/// Converts text of the command line to values. Each function throws `Failure::usage` with the
/// option, the expected and the actual text.
namespace catoptric::cli {

/// Returns a size such as "640x480", both edges at least 1.
uvec2 parse_size(const std::string& option, const std::string& text);

std::int64_t parse_integer(const std::string& option, const std::string& text, std::int64_t low,
                           std::int64_t high);
std::uint64_t parse_seed(const std::string& option, const std::string& text);

/// Returns a finite number in [low, high].
double parse_real(const std::string& option, const std::string& text,
                  double low = -std::numeric_limits<double>::max(),
                  double high = std::numeric_limits<double>::max());

/// Returns the index of `text` in `choices`. The error message suggests the nearest choice.
std::size_t parse_choice(const std::string& option, const std::string& text,
                         const std::vector<std::string>& choices);

/// Calls `work`, whose errors of usage then begin with the option's name.
template <typename Work>
auto parse_option(const std::string& option, Work&& work) {
    try {
        return work();
    } catch (const Error& error) {
        if (error.failure != Failure::usage) throw;
        throw_error(error.failure, option + ": " + error.what());
    }
}

/// Returns text such as "a, b, c".
std::string join_with_commas(const std::vector<std::string>& parts);

} // namespace catoptric::cli
