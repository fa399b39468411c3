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
    pictures.rows.resize(comparison.rows.size());
    for (std::size_t i = 0; i < comparison.rows.size(); ++i) {
        const Row& row = comparison.rows[i];
        if (pictures.rows[i].pictured == row.pictured) continue;
        const bool has_map = !row.flip_map.empty();
        EncodedPictures::OfRow& encoded = pictures.rows[i];
        encoded.pictured = row.pictured;
        encoded.picture = png_of(row.display);
        encoded.error = has_map ? png_of(measure::heat(row.flip_map, row.display.width,
                                                       row.display.height))
                                : std::string();
    }
    for (std::size_t i = 0; i < comparison.rows.size(); ++i) {
        const Row& row = comparison.rows[i];
        EncodedPictures::OfRow& encoded = pictures.rows[i];
        if (row.causes && encoded.causes.empty()) encoded.causes = png_of(cause_picture(row));
        if (!row.worst || encoded.worst_view == row.worst->view) continue;
        encoded.worst = png_of(row.worst->display);
        encoded.worst_view = row.worst->view;
    }
}

} // namespace catoptric::report
