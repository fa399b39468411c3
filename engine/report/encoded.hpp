#pragma once

#include "report/comparison.hpp"

#include <string>
#include <vector>

namespace catoptric::report {

/// The pictures of a comparison as PNG, each encoded once however often the page is written.
struct EncodedPictures {
    struct OfRow {
        std::string picture; ///< as shown
        std::string error;   ///< heat map of its FLIP error; empty: it has none
        std::string causes;  ///< pixels by what is to blame; empty: not known
    };
    std::string reference; ///< empty: it was not rendered
    std::vector<OfRow> rows;
};

/// Encodes what has come since the last time: rows are only ever added, causes to any.
void encode_new(EncodedPictures& pictures, const Comparison& comparison);

/// report.html with these pictures.
std::string to_html(const Comparison& comparison, const EncodedPictures& pictures);

} // namespace catoptric::report
