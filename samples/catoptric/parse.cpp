#include "parse.hpp"

#include "core/error.hpp"
#include "core/knob.hpp"
#include "core/text.hpp"

#include <algorithm>
#include <charconv>

namespace catoptric::cli {

namespace {

/// Reads the whole of `text` as a number. Returns false if any text is left over.
template <typename Number>
bool parse_whole(const std::string& text, Number& value) {
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    return error == std::errc{} && stop == end;
}

std::string format_range(double low, double high) {
    constexpr double kLargestDouble = std::numeric_limits<double>::max();
    std::ostringstream text;
    text.precision(15);
    if (low > -kLargestDouble) text << (high < kLargestDouble ? " from " : " of at least ") << low;
    if (high < kLargestDouble) text << (low > -kLargestDouble ? " to " : " of at most ") << high;
    return text.str();
}

} // namespace

uvec2 parse_size(const std::string& option, const std::string& text) {
    constexpr std::uint32_t kMaxPictureSide = 1U << 20; // larger than any device allows
    const std::vector<std::string> parts = split(text, "x");
    uvec2 size{0, 0};
    const bool numbers = parts.size() == 2 && parse_whole(parts[0], size.x) &&
                         parse_whole(parts[1], size.y);
    const bool in_range = size.x >= 1 && size.y >= 1 && size.x <= kMaxPictureSide &&
                          size.y <= kMaxPictureSide;
    check(numbers && in_range, Failure::usage, option,
          ": wanted WxH, such as 512x512, both from 1 to ", kMaxPictureSide, ", found '", text,
          "'");
    return size;
}

std::int64_t parse_integer(const std::string& option, const std::string& text, std::int64_t low,
                           std::int64_t high) {
    std::int64_t value = 0;
    check(parse_whole(text, value) && value >= low && value <= high, Failure::usage, option,
          ": wanted a whole number from ", low, " to ", high, ", found '", text, "'");
    return value;
}

std::uint64_t parse_seed(const std::string& option, const std::string& text) {
    std::uint64_t value = 0;
    check(parse_whole(text, value), Failure::usage, option, ": wanted a whole number from 0 to ",
          std::numeric_limits<std::uint64_t>::max(), ", found '", text, "'");
    return value;
}

double parse_real(const std::string& option, const std::string& text, double low, double high) {
    double value = 0;
    // NaN and infinities fail this comparison.
    check(parse_whole(text, value) && value >= low && value <= high, Failure::usage, option,
          ": wanted a finite number", format_range(low, high), ", found '", text, "'");
    return value;
}

std::size_t parse_choice(const std::string& option, const std::string& text,
                         const std::vector<std::string>& choices) {
    const auto found = std::ranges::find(choices, text);
    check(found != choices.end(), Failure::usage, option, ": wanted one of ",
          join_with_commas(choices), ", found '", text, "'", suggest_name(text, choices));
    return static_cast<std::size_t>(found - choices.begin());
}

std::string join_with_commas(const std::vector<std::string>& parts) {
    std::string text;
    for (const std::string& part : parts) text += (text.empty() ? "" : ", ") + part;
    return text;
}

} // namespace catoptric::cli
