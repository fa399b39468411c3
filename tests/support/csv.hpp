#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace test {

/// Returns the fields of the first line of a CSV text. A field in quotes may hold commas, but no
/// line breaks and no quotes.
inline std::vector<std::string> split_csv_fields(std::string_view text) {
    std::vector<std::string> fields(1);
    bool is_quoted = false;
    for (const char c : text) {
        if (c == '\r' || c == '\n') break;
        if (c == '"')
            is_quoted = !is_quoted;
        else if (c == ',' && !is_quoted)
            fields.emplace_back();
        else
            fields.back() += c;
    }
    return fields;
}

} // namespace test
