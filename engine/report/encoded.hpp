#pragma once

#include "report/comparison.hpp"

#include <optional>
#include <string>
#include <vector>

namespace catoptric::report {

/// Pictures of a comparison as PNG. Each is encoded once, however often the page is written.
struct EncodedPictures {
    struct OfRow {
        int pictured = -1;   ///< Row::pictured at the time of encoding
        std::string picture; ///< picture as displayed
        std::string error;   ///< heat map of its FLIP error; empty if it has none
        std::string causes;  ///< picture by cause; empty if causes are not known
        std::string worst;   ///< picture at its worst view so far; empty if no view was drawn
        std::optional<std::size_t> worst_view;
    };
    std::string reference; ///< empty if the reference was not rendered
    std::vector<OfRow> rows;
};

/// Encodes pictures that are new since the last call. Rows are added, show a later frame or get
/// causes, and their worst views may change.
void encode_new(EncodedPictures& pictures, const Comparison& comparison);

/// Return report.html with these pictures, the section of one comparison, and a page around
/// sections.
std::string to_html(const Comparison& comparison, const EncodedPictures& pictures);
std::string html_section(const Comparison& comparison, const EncodedPictures& pictures);
std::string html_page(const std::string& title, const std::string& content);
/// Returns the prefix of HTML ids in the comparison's section. It is empty if the page has no other
/// section.
std::string section_of(const Comparison& comparison);

} // namespace catoptric::report
