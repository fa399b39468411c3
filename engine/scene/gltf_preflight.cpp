#include "core/error.hpp"
#include "scene/gltf_document.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include <nlohmann/json.hpp>

namespace catoptric::scene::gltf {

namespace fs = std::filesystem;

namespace {

constexpr int kDeepest = 64;
constexpr std::string_view kExtensions[] = {"KHR_materials_emissive_strength"};

std::uint32_t word_at(std::string_view bytes, std::size_t offset) {
    std::uint32_t word = 0; // glTF and every machine that we run on are little-endian
    std::memcpy(&word, bytes.data() + offset, sizeof word);
    return word;
}

/// The JSON chunk of a GLB, or the whole text.
std::string_view json_text(const std::string& file, std::string_view bytes) {
    if (!is_binary(bytes)) return bytes;
    check(bytes.size() >= 20, Failure::bad_data, file, ": header: wanted 20 bytes, found ",
          bytes.size());
    check(word_at(bytes, 4) == 2, Failure::bad_data, file, ": header: wanted GLB version 2, found ",
          word_at(bytes, 4));
    check(word_at(bytes, 8) == bytes.size(), Failure::bad_data, file, ": header: wanted ",
          word_at(bytes, 8), " bytes, found ", bytes.size());
    const std::uint32_t length = word_at(bytes, 12);
    check(word_at(bytes, 16) == 0x4e4f534a && length <= bytes.size() - 20, Failure::bad_data, file,
          ": first chunk: wanted JSON of at most ", bytes.size() - 20, " bytes, found ", length);
    return bytes.substr(20, length);
}

nlohmann::json parse(const std::string& file, std::string_view text) {
    using Json = nlohmann::json;
    const auto limit_depth = [&](int depth, Json::parse_event_t, Json&) {
        check(depth < kDeepest, Failure::bad_data, file, ": JSON: wanted nesting below ", kDeepest,
              ", found more");
        return true;
    };
    try {
        return Json::parse(text, limit_depth);
    } catch (const Json::exception& error) {
        fail(Failure::bad_data, file, ": JSON: ", error.what());
    }
}

void check_extensions(const std::string& file, const nlohmann::json& root) {
    const auto found = root.find("extensionsRequired");
    if (found == root.end()) return;
    for (const nlohmann::json& extension : *found) {
        const bool known = extension.is_string() &&
                           std::ranges::find(kExtensions, extension.get<std::string_view>()) !=
                               std::end(kExtensions);
        check(known, Failure::bad_data, file,
              ": extensionsRequired: wanted none but KHR_materials_emissive_strength, found ",
              extension.dump());
    }
}

/// "%20" and kin become the bytes they stand for.
std::string decoded(std::string_view uri) {
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        unsigned value = 0;
        const std::string digits(uri.substr(i + 1, 2));
        const bool is_code = uri[i] == '%' && digits.size() == 2 &&
                             digits.find_first_not_of("0123456789abcdefABCDEF") == digits.npos;
        if (is_code) value = static_cast<unsigned>(std::stoul(digits, nullptr, 16)), i += 2;
        text += is_code ? static_cast<char>(value) : uri[i];
    }
    return text;
}

void check_buffers(const fs::path& path, const nlohmann::json& root) {
    const auto buffers = root.find("buffers");
    if (buffers == root.end()) return;
    for (const nlohmann::json& buffer : *buffers) {
        if (!buffer.is_object() || !buffer.contains("uri")) continue;
        const nlohmann::json& value = buffer["uri"];
        check(value.is_string(), Failure::bad_data, path.string(),
              ": buffer uri: wanted a text, found ", value.type_name());
        const std::string uri = value.get<std::string>();
        if (uri.starts_with("data:")) continue;
        const fs::path name = decoded(uri);
        const bool stays = name.is_relative() && name.has_filename() && name.filename() != "." &&
                           *name.lexically_normal().begin() != "..";
        check(stays, Failure::bad_data, path.string(),
              ": buffer uri: wanted a file in the same folder, found '", uri, "'");
        std::error_code ignored;
        check(fs::is_regular_file(path.parent_path() / name, ignored), Failure::missing_input,
              path.string(), ": buffer '", uri, "' is not there");
    }
}

} // namespace

bool is_binary(std::string_view bytes) { return bytes.starts_with("glTF"); }

void preflight(const fs::path& path, std::string_view bytes) {
    const std::string file = path.string();
    const nlohmann::json root = parse(file, json_text(file, bytes));
    const nlohmann::json asset = root.is_object() ? root.value("asset", nlohmann::json()) : root;
    const nlohmann::json version = asset.is_object() ? asset.value("version", nlohmann::json())
                                                     : nlohmann::json();
    check(version.is_string() && version.get<std::string_view>().starts_with("2."),
          Failure::bad_data, file, ": asset.version: wanted \"2.0\", found ", version.dump());
    check_extensions(file, root);
    check_buffers(path, root);
}

} // namespace catoptric::scene::gltf
