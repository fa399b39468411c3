#pragma once

#include <string>
#include <string_view>

// Building blocks of a self-contained HTML page.
namespace catoptric::report {

/// Returns text escaped for use between tags and inside quoted attributes.
std::string html_escaped(std::string_view text);
/// Returns a PNG as a data URI for `src`.
std::string data_uri(std::string_view png);

/// Style sheet of the page.
extern const char* const kStyle;

} // namespace catoptric::report
