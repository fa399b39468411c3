#include "study/picture_rows.hpp"

#include "core/error.hpp"
#include "core/text.hpp"
#include "measure/display.hpp"
#include "measure/findings.hpp"
#include "measure/masks.hpp"
#include "measure/picture_file.hpp"
#include "session/technique_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace catoptric::app {

namespace {

measure::SampleSummary make_unknown_time() {
    measure::SampleSummary time;
    time.median = time.p05 = time.p95 = time.mad = NAN;
    return time;
}

/// Returns the picture with its rows in reverse order.
measure::Picture flip_picture_vertically(const measure::Picture& picture) {
    measure::Picture turned(picture.width, picture.height);
    for (int y = 0; y < picture.height; ++y)
        std::copy_n(&picture.at(0, y), picture.width, &turned.at(0, picture.height - 1 - y));
    return turned;
}

/// Returns the mean square difference over the pixels of the mask, after exposure and clamping.
double mean_square_error(const measure::Picture& picture, const ComparedReference& truth,
                         const measure::Mask& mask, double exposure) {
    const std::vector<float> no_flip(picture.pixels.size());
    const double rmse = compute_masked_error(picture, {truth.hdr}, mask, no_flip, exposure).rmse;
    return rmse * rmse;
}

} // namespace

std::string picture_row_image_name(const std::string& name, std::size_t index) {
    std::string safe;
    for (const char c : name.substr(0, 40)) {
        const bool is_plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') ||
                              (c >= 'a' && c <= 'z') || c == '-' || c == '_';
        safe += is_plain ? c : '-';
    }
    return fmt::format("picture{}-{}", index + 1, safe);
}

void check_picture_rows(const CompareRequest& request) {
    std::vector<std::string> names;
    for (const std::string& text : request.base.techniques)
        names.push_back(parse_technique(text).label);
    for (const auto& [name, file] : request.pictures) {
        check(!name.empty(), Failure::usage, "--row ", quote_as_printable_text("=" + file),
              ": wanted NAME=FILE with a name, found none");
        check(std::ranges::find(names, name) == names.end(), Failure::usage, "--row ",
              quote_as_printable_text(name), ": wanted a name that no other row has");
        names.push_back(name);
        const auto width = static_cast<int>(request.base.size.x),
                   height = static_cast<int>(request.base.size.y);
        measure::PictureReader picture_reader(file, [&](int columns, int rows) {
            check(columns == width && rows == height, Failure::bad_data, file,
                  ": wanted a picture of ", width, "x", height,
                  " pixels, as the comparison (--size), found ", columns, "x", rows);
        });
    }
}

measure::Picture read_row_picture(const std::string& file, double exposure) {
    const measure::Picture picture = measure::read_picture(file);
    return measure::is_png(file) ? measure::apply_exposure(picture, -exposure) : picture;
}

report::Row make_picture_row(const std::string& name, std::size_t index,
                             const measure::Picture& picture, const ComparedReference& truth,
                             const std::vector<std::uint32_t>& hits, std::size_t mirrors,
                             double exposure) {
    report::Row row;
    row.technique = "picture";
    row.label = name;
    row.image = picture_row_image_name(name, index);
    for (measure::SampleSummary report::Row::*time :
         {&report::Row::gpu_ms, &report::Row::frame_ms, &report::Row::cpu_record_ms,
          &report::Row::wall_ms, &report::Row::cpu_ms})
        row.*time = make_unknown_time();
    TechniqueResult part;
    part.hdr = picture;
    part.display = measure::to_display(picture, exposure);
    fill_row_errors(row, part, truth, hits, mirrors, exposure);
    return row;
}

std::vector<std::string> list_picture_row_warnings(const report::Row& row,
                                                   const ComparedReference& truth,
                                                   const std::vector<std::uint32_t>& hits,
                                                   double exposure) {
    measure::Mask beside = measure::mask_mirror_pixels(hits);
    for (std::uint8_t& counts : beside) counts = counts == 0 ? 255 : 0;
    const std::string begin = "'" + row.label + "': ";
    std::vector<std::string> warnings;
    const double error = mean_square_error(row.hdr, truth, beside, exposure),
                 turned = mean_square_error(flip_picture_vertically(row.hdr), truth, beside,
                                            exposure);
    if (turned < error / 4)
        warnings.push_back(begin + "its picture is upside down, as far as the pixels beside the "
                                   "mirrors tell");
    else if (std::sqrt(error) > std::max(std::abs(row.error.rmse), measure::kEightBitStep))
        warnings.push_back(begin +
                           fmt::format("its rmse is {:.3g} beside the mirrors and {:.3g} on them: "
                                       "its light, exposure or camera differs, not its reflections "
                                       "alone",
                                       std::sqrt(error), row.error.rmse));
    return warnings;
}

} // namespace catoptric::app
