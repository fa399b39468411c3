#include "core/text.hpp"
#include "scene/gltf_container.hpp"

#include <algorithm>
#include <charconv>

#include <tiny_gltf.h>

namespace catoptric::scene::gltf {

namespace {

constexpr std::string_view kBase64Digits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Decodes percent-encoded bytes such as "%20". A '%' without two hexadecimal digits stays.
std::string decode_percent(std::string_view uri) {
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const std::string_view digits = uri.substr(i + 1, 2);
        unsigned char code = 0;
        const auto result = std::from_chars(digits.begin(), digits.end(), code, 16);
        const bool is_code = uri[i] == '%' && digits.size() == 2 && result.ptr == digits.end();
        text += is_code ? static_cast<char>(code) : uri[i];
        if (is_code) i += 2;
    }
    return text;
}

} // namespace

std::string name_from_uri(const std::string& uri, const std::string& place) {
    const auto wanted = [&](bool ok, std::string_view what) {
        check(ok, Failure::bad_data, place, ": uri: wanted a path relative to the scene, found ",
              quote(uri), what);
    };
    wanted(uri.find(':') >= uri.find_first_of("/?#"), ", which has a scheme");
    const std::string name = decode_percent(uri);
    wanted(!name.starts_with('/'), ", which is absolute");
    wanted(name.find('\\') == name.npos, ", which has a backslash");
    wanted(name.find('\0') == name.npos, ", which has a NUL");
    wanted(!name.empty(), "");
    return name;
}

bool is_data_uri(std::string_view uri) { return uri.starts_with("data:"); }

ByteList decode_data_uri(std::string_view uri, const std::string& place) {
    const std::size_t comma = uri.find(',');
    check(comma != uri.npos && uri.substr(0, comma).ends_with(";base64"), Failure::bad_data, place,
          ": uri: wanted data in base64, found ", quote(uri.substr(0, comma)));
    std::string_view text = uri.substr(comma + 1);
    const int most = text.size() % 4 == 0 ? 2 : 0; // padding characters
    for (int i = 0; i < most && text.ends_with('='); ++i) text.remove_suffix(1);
    const std::size_t wrong = std::min(text.find_first_not_of(kBase64Digits), text.size());
    check(wrong == text.size(), Failure::bad_data, place, ": uri: wanted digits of base64, found ",
          quote(text.substr(wrong, 1)));
    check(text.size() % 4 != 1, Failure::bad_data, place,
          ": uri: wanted four digits of base64 for three bytes, found one more");
    ByteList bytes;
    std::string kind;
    tinygltf::DecodeDataURI(&bytes, kind,
                            "data:application/octet-stream;base64," + std::string(text), 0, false);
    return bytes;
}

} // namespace catoptric::scene::gltf
