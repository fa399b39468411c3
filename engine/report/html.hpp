#pragma once

#include "report/writer.hpp"

#include <string>
#include <string_view>

// Building blocks of a self-contained HTML page.
namespace catoptric::report {

/// Returns text escaped for use between tags and inside quoted attributes.
std::string escape_html(std::string_view text);
/// Returns bytes in base64 (RFC 4648), padded.
std::string encode_base64(std::string_view bytes);
/// Returns a PNG as a data URI for `src`.
std::string png_uri(std::string_view png);

/// Returns a PNG with a caption, or nothing if `png` is empty. `id` names the picture in the page;
/// empty: no name. `file`: the picture's file relative to the page, which then loads it when it
/// comes into view; empty: the page holds the picture.
std::string html_figure(int width, int height, const std::string& png, const std::string& alt,
                        const std::string& caption, const std::string& id = {},
                        const std::string& file = {});

/// Returns a section of a page under its title, which is HTML.
std::string titled_section(const std::string& title, const std::string& content);

/// CSS style sheet and script of report.html and stress.html, from report/page/.
extern const char* const kStyleSheet;
extern const char* const kPageScript;
/// The library uPlot with its licence and style sheet, and the script that draws charts by it.
/// Pages without a chart do not contain them.
extern const char* const kChartStyleSheet;
extern const char* const kChartLibrary;
extern const char* const kChartScript;
/// Begin of the element of each chart (report/chart.hpp).
inline constexpr std::string_view kChartOpening = "<div class=\"chart\">";
/// The script of maps of the trade, and the begin of the element of each (study/map.cpp).
extern const char* const kMapScript;
inline constexpr std::string_view kMapOpening = "<div class=\"map\">";

/// Returns the anchor in the page at which the pictures of a row stand. The ids of its pictures are
/// the anchor with "-picture", "-error" and "-causes".
std::string row_anchor(const Comparison& comparison, std::size_t row);

/// Returns HTML of the comparer of the reference and the rows. The page's script fills it. Returns
/// nothing without a reference or a row.
std::string html_comparer(const Comparison& comparison);
/// Returns a script that gives the comparer these bytes in base64. `file` is its path relative to
/// the page.
std::string bytes_script(std::string_view bytes, const std::string& file);
/// Returns a script that gives the comparer the linear values of a picture, as halves in base64.
/// `file` is its path relative to the page.
std::string picture_script(const measure::Picture& picture, const std::string& file);
/// Returns a script that gives the comparer the mirror that each pixel shows: 0 for none, or the
/// mirror's number from 1, in 16 bits. `mirror_hits`: as in Comparison::mirror_hits.
std::string mirror_script(const std::vector<std::uint32_t>& mirror_hits, const std::string& file);

/// Returns the whole report.html of one comparison.
std::string to_html(const Comparison& comparison, const EncodedPictures& pictures);
/// Returns the section of one comparison on a page with several.
std::string html_section(const Comparison& comparison, const EncodedPictures& pictures);
/// Returns a page around the HTML of its sections.
std::string html_page(const std::string& title, const std::string& content);
/// Returns the prefix of HTML ids in the comparison's section. It is empty if the page has no other
/// section.
std::string id_prefix(const Comparison& comparison);

} // namespace catoptric::report
