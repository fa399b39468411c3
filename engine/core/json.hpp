#pragma once

#include "core/error.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

// JSON input: scene files, plans, device profiles, benchmarks, the documents of glTF.
namespace catoptric {

/// Function that is called before each JSON value is stored, with the largest number of bytes that
/// the value can take. The function may throw to stop reading.
using JsonMemoryUse = std::function<void(std::uint64_t bytes)>;

/// Checks that `text` is JSON, without storing values. Throws `bad_data` if it is not JSON or nests
/// 64 levels deep or more. The message has file, line, column (from 1, in bytes), what was expected
/// and what was found; that of the nesting has the file.
void check_json(const std::string& file, std::string_view text, const JsonMemoryUse& spends = {});

/// Returns the text of a JSON file. Users may name any file, so its type and size are checked
/// first. `what` is the content for messages, such as "a plan". Throws `bad_data` for a folder, a
/// device or more than `max_bytes`, and as read_file does.
std::string read_json_text(const std::filesystem::path& file, const std::string& what,
                           std::uintmax_t max_bytes);

/// Returns the values of `text`. Throws like `check_json`. `Json` is a type of nlohmann's library.
template <typename Json>
Json parse_json(const std::string& file, std::string_view text, const JsonMemoryUse& spends = {}) {
    check_json(file, text, spends);
    return Json::parse(text);
}

} // namespace catoptric
