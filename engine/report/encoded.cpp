#include "report/encoded.hpp"

#include "measure/heat.hpp"
#include "measure/picture_file.hpp"
#include "report/causes.hpp"

namespace catoptric::report {

namespace {

std::string png_of(const measure::Picture& display) {
    return display.pixels.empty() ? std::string() : measure::png_bytes(display);
}

} // namespace

void encode_new(EncodedPictures& pictures, const Comparison& comparison) {
    if (pictures.reference.empty()) pictures.reference = png_of(comparison.reference_display);
    for (std::size_t i = pictures.rows.size(); i < comparison.rows.size(); ++i) {
        const Row& row = comparison.rows[i];
        const bool has_map = !row.flip_map.empty();
        pictures.rows.push_back(
            {png_of(row.display),
             has_map ? png_of(measure::heat(row.flip_map, row.display.width, row.display.height))
                     : std::string(),
             {}});
    }
    for (std::size_t i = 0; i < comparison.rows.size(); ++i) {
        const Row& row = comparison.rows[i];
        if (row.causes && pictures.rows[i].causes.empty())
            pictures.rows[i].causes = png_of(cause_picture(row));
    }
}

} // namespace catoptric::report
