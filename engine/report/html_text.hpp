#pragma once

#include "measure/picture.hpp"

#include <string>
#include <string_view>

// What a self-contained page is made of.
namespace catoptric::report {

/// Text for between tags and inside quoted attributes.
std::string html_escaped(std::string_view text);
/// The picture as a PNG inside a data: URI.
std::string data_uri(const measure::Picture& display);

/// The page's style sheet.
extern const char* const kStyle;

} // namespace catoptric::report
