#pragma once

#include "core/error.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

// JSON from outside: scene files, plans, device profiles, benchmarks, the documents of glTF.
namespace catoptric {

/// Called with the bytes that the next value takes in memory, at most; may throw.
using JsonSpends = std::function<void(std::uint64_t bytes)>;

/// Reads over `text` and keeps nothing. Throws `bad_data` for text that is no JSON, or that nests
/// 64 deep or more: the file, line and column (from 1, in bytes), what was wanted and what was
/// found.
void check_json(const std::string& file, std::string_view text, const JsonSpends& spends = {});

/// Returns the values of `text`; errors as those of `check_json`. `Json` is a type of nlohmann's.
template <typename Json>
Json parse_json(const std::string& file, std::string_view text, const JsonSpends& spends = {}) {
    check_json(file, text, spends);
    return Json::parse(text);
}

} // namespace catoptric
