#pragma once

#include <string>
#include <string_view>

// What a self-contained page is made of.
namespace catoptric::report {

/// Text for between tags and inside quoted attributes.
std::string html_escaped(std::string_view text);
/// A picture for `src`.
std::string data_uri(std::string_view png);

/// The page's style sheet.
extern const char* const kStyle;

} // namespace catoptric::report
