#include "report/html.hpp"

#include "core/text.hpp"

#include <cstdint>

namespace catoptric::report {

std::string encode_base64(std::string_view bytes) {
    constexpr char kBase64Digits[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0; // three bytes; missing bytes are 0
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 |
                    (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k <= bytes.size() ? kBase64Digits[group >> (18 - 6 * k) & 63U] : '=';
    }
    return text;
}

std::string escape_html(std::string_view text) {
    std::string result;
    for (const char c : escape(text, "\n")) {
        switch (c) {
        case '&': result += "&amp;"; break;
        case '<': result += "&lt;"; break;
        case '>': result += "&gt;"; break;
        case '"': result += "&quot;"; break;
        case '\'': result += "&#39;"; break;
        case '\n': result += ' '; break; // a browser shows a line break as a space
        default: result += c;
        }
    }
    return result;
}

std::string png_uri(std::string_view png) { return "data:image/png;base64," + encode_base64(png); }

} // namespace catoptric::report
