#pragma once

#include "report/comparison.hpp"

#include <optional>
#include <string>
#include <vector>

namespace catoptric::report {

/// The pictures of a comparison as PNG, each encoded once however often the page is written.
struct EncodedPictures {
    struct OfRow {
        int pictured = -1;   ///< Row::pictured of the row that it was encoded from
        std::string picture; ///< as shown
        std::string error;   ///< heat map of its FLIP error; empty: it has none
        std::string causes;  ///< pixels by what is to blame; empty: not known
        std::string worst;   ///< at its worst view so far; empty: none was drawn
        std::optional<std::size_t> worst_view;
    };
    std::string reference; ///< empty: it was not rendered
    std::vector<OfRow> rows;
};

/// Encodes what has come since the last time: rows are added, show a later frame, get causes, and
/// their worst views may change.
void encode_new(EncodedPictures& pictures, const Comparison& comparison);

/// report.html with these pictures: a page of one section.
std::string to_html(const Comparison& comparison, const EncodedPictures& pictures);
std::string html_section(const Comparison& comparison, const EncodedPictures& pictures);
std::string html_page(const std::string& title, const std::string& content);
/// What ids of the comparison's section begin with; empty where it is the page's only one.
std::string section_of(const Comparison& comparison);

} // namespace catoptric::report
