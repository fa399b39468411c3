#pragma once

#include "report/writer.hpp"

#include <string>
#include <string_view>

// Building blocks of a self-contained HTML page.
namespace catoptric::report {

/// Returns text escaped for use between tags and inside quoted attributes.
std::string escape_html(std::string_view text);
/// Returns a PNG as a data URI for `src`.
std::string make_png_data_uri(std::string_view png);

/// Returns a PNG with a caption, or nothing if `png` is empty.
std::string make_html_figure(int width, int height, const std::string& png, const std::string& alt,
                             const std::string& caption);

/// Returns a section of a page under its title, which is HTML.
std::string make_html_titled_section(const std::string& title, const std::string& content);

/// CSS style sheet of report.html and stress.html.
extern const char* const kStyleSheet;

/// Returns the whole report.html of one comparison.
std::string to_html(const Comparison& comparison, const EncodedPictures& pictures);
/// Returns the section of one comparison on a page with several.
std::string make_html_section(const Comparison& comparison, const EncodedPictures& pictures);
/// Returns a page around the HTML of its sections.
std::string make_html_page(const std::string& title, const std::string& content);
/// Returns the prefix of HTML ids in the comparison's section. It is empty if the page has no other
/// section.
std::string make_html_id_prefix(const Comparison& comparison);

} // namespace catoptric::report
