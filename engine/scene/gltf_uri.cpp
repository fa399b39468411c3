#include "core/text.hpp"
#include "scene/gltf_container.hpp"

#include <array>
#include <cstdint>

namespace catoptric::scene::gltf {

namespace {

constexpr std::string_view kDigits = "0123456789abcdef";
constexpr std::string_view kBase64 =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// 0 to 15; more for what is no hexadecimal digit.
std::size_t digit(char c) { return kDigits.find(c >= 'A' && c <= 'F' ? char(c - 'A' + 'a') : c); }

/// "%20" and kin become the bytes they stand for; a '%' without two digits stays.
std::string decoded(std::string_view uri) {
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const bool is_code = uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) < 16 &&
                             digit(uri[i + 2]) < 16;
        text += is_code ? static_cast<char>(16 * digit(uri[i + 1]) + digit(uri[i + 2])) : uri[i];
        if (is_code) i += 2;
    }
    return text;
}

/// For each byte what it stands for in base64; 64 and more: nothing.
std::array<std::uint8_t, 256> base64_values() {
    std::array<std::uint8_t, 256> values;
    values.fill(64);
    for (std::size_t i = 0; i < kBase64.size(); ++i)
        values[static_cast<unsigned char>(kBase64[i])] = static_cast<std::uint8_t>(i);
    return values;
}

} // namespace

std::string file_name_of(const std::string& uri, const std::string& place) {
    const auto wanted = [&](bool ok, std::string_view what) {
        check(ok, Failure::bad_data, place, ": uri: wanted a path relative to the scene, found ",
              in_quotes(uri), what);
    };
    wanted(uri.find(':') >= uri.find_first_of("/?#"), ", which has a scheme");
    const std::string name = decoded(uri);
    wanted(!name.starts_with('/'), ", which is absolute");
    wanted(name.find('\\') == name.npos, ", which has a backslash");
    wanted(name.find('\0') == name.npos, ", which has a NUL");
    wanted(!name.empty(), "");
    return name;
}

bool is_data_uri(std::string_view uri) { return uri.starts_with("data:"); }

std::string data_of(std::string_view uri, const std::string& place) {
    const std::size_t comma = uri.find(',');
    check(comma != uri.npos && uri.substr(0, comma).ends_with(";base64"), Failure::bad_data, place,
          ": uri: wanted data in base64, found ", in_quotes(uri.substr(0, comma)));
    std::string_view text = uri.substr(comma + 1);
    const int most = text.size() % 4 == 0 ? 2 : 0; // of padding
    for (int i = 0; i < most && text.ends_with('='); ++i) text.remove_suffix(1);
    static const std::array<std::uint8_t, 256> values = base64_values();
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3 + 3);
    std::uint32_t bits = 0, count = 0; // not yet bytes
    for (const char c : text) {
        const std::uint8_t value = values[static_cast<unsigned char>(c)];
        check(value < 64, Failure::bad_data, place, ": uri: wanted digits of base64, found ",
              in_quotes(std::string_view(&c, 1)));
        bits = (bits << 6 | value) & 0xffff;
        count += 6;
        if (count < 8) continue;
        count -= 8;
        bytes += static_cast<char>(bits >> count & 255);
    }
    check(count < 6, Failure::bad_data, place,
          ": uri: wanted four digits of base64 for three bytes, "
          "found one more");
    return bytes;
}

} // namespace catoptric::scene::gltf
