#include "core/text.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace catoptric {

namespace {

constexpr std::size_t kMaxQuotedBytes = 80;

std::string to_hex(std::uint32_t value, std::size_t digits) {
    std::string text;
    for (std::size_t i = digits; i-- > 0;) text += "0123456789abcdef"[value >> (4 * i) & 15];
    return text;
}

/// One character of UTF-8. `size` is its number of bytes, 0 for a byte that begins no character.
struct Utf8 {
    std::size_t size = 0;
    std::uint32_t code = 0;
};

Utf8 decode_utf8(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char lead = byte(0);
    const std::size_t size = lead < 0x80   ? 1
                             : lead < 0xc2 ? 0
                             : lead < 0xe0 ? 2
                             : lead < 0xf0 ? 3
                                           : 4;
    if (size == 0 || size > text.size() || lead > 0xf4) return {};
    std::uint32_t code = size == 1 ? lead : lead & (0x7f >> size);
    for (std::size_t i = 1; i < size; ++i) {
        if ((byte(i) & 0xc0) != 0x80) return {};
        code = code << 6 | (byte(i) & 0x3f);
    }
    // UTF-8 forbids a longer encoding than necessary. The table holds the smallest code point for
    // each number of bytes.
    constexpr std::uint32_t kMinCodePoints[] = {0, 0, 0x80, 0x800, 0x10000};
    const bool is_surrogate = code >= 0xd800 && code < 0xe000;
    if (code < kMinCodePoints[size] || is_surrogate || code > 0x10ffff) return {};
    return {size, code};
}

bool is_control(std::uint32_t code) {
    return (code >= 0x80 && code < 0xa0) || (code >= 0x2028 && code <= 0x202e) ||
           (code >= 0x2066 && code <= 0x2069);
}

} // namespace

std::string escape(std::string_view text, std::string_view kept) {
    std::string result;
    result.reserve(text.size());
    while (!text.empty()) {
        const auto [size, code] = decode_utf8(text);
        const bool is_kept = kept.find(text[0]) != kept.npos;
        if (!is_kept && (size == 0 || code < 0x20 || code == 0x7f))
            result += "\\x" + to_hex(static_cast<unsigned char>(text[0]), 2);
        else if (is_control(code))
            result += "\\u{" + to_hex(code, code < 0x100 ? 2 : 4) + "}";
        else
            result += text.substr(0, is_kept ? 1 : size);
        text.remove_prefix(size == 0 ? 1 : size);
    }
    return result;
}

std::string quote(std::string_view text) {
    if (text.size() <= kMaxQuotedBytes) return "'" + escape(text) + "'";
    std::size_t end = kMaxQuotedBytes;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
    return "'" + escape(text.substr(0, end)) + "...' (" + std::to_string(text.size()) + " bytes)";
}

std::vector<std::string> split(std::string_view text, std::string_view separators) {
    std::vector<std::string> parts;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find_first_of(separators, begin), text.size());
        parts.emplace_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return parts;
}

} // namespace catoptric
