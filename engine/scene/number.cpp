#include "scene/number.hpp"

#include <charconv>
#include <cmath>
#include <cstdlib>

namespace catoptric::scene {

namespace {

template <typename Real>
std::string format_shortest_text(Real number) {
    if (number == 0) return "0";
    char text[32];
    const std::to_chars_result end = std::to_chars(text, text + sizeof text, number);
    return std::string(text, end.ptr);
}

} // namespace

std::string format_number(double number) { return format_shortest_text(number); }
std::string format_number(float number) { return format_shortest_text(number); }

double shortest_double(float number) {
    return parse_number(format_shortest_text(number)).value_or(double(number));
}

std::optional<double> parse_number(std::string_view text) {
    if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
    double number = 0;
    const char* end = text.data() + text.size();
    const std::from_chars_result result = std::from_chars(text.data(), end, number);
    if (text.empty() || result.ptr != end) return std::nullopt;
    // from_chars does not set a number that is out of range. We read a number too small for a
    // double as zero.
    const bool tiny = result.ec == std::errc::result_out_of_range &&
                      std::abs(std::strtod(std::string(text).c_str(), nullptr)) < 1;
    if (tiny) return 0;
    if (result.ec != std::errc() || !std::isfinite(number)) return std::nullopt;
    return number;
}

} // namespace catoptric::scene
