// Writes the data of the comparer in report.html: the list of rows in the page, and the linear
// values of pictures in files beside the page.
#include "measure/masks.hpp"
#include "report/chart.hpp"
#include "report/html.hpp"
#include "report/json.hpp"
#include "report/tables.hpp"
#include "report/text.hpp"

#include <fmt/format.h>
#include <glm/gtc/packing.hpp>

#include <cmath>

namespace catoptric::report {

namespace {

std::string words_script(const std::vector<std::uint16_t>& words, const std::string& file) {
    std::string bytes;
    bytes.reserve(2 * words.size());
    for (const std::uint16_t word : words) {
        bytes += static_cast<char>(word & 0xFF);
        bytes += static_cast<char>(word >> 8);
    }
    return bytes_script(bytes, file);
}

/// Returns where the comparer finds a map of a row: the file of its bytes, and the id of the
/// picture in the page.
Json map_json(const Comparison& comparison, const std::string& name, const std::string& id) {
    return {{"file", id.empty() ? "" : image_path(comparison, name + ".js")}, {"id", id}};
}

/// `anchor`: id of the row's article; empty for the reference.
Json picture_json(const Comparison& comparison, const std::string& label, const std::string& image,
                  const std::string& picture_id, const std::string& anchor, bool is_first) {
    const auto id = [&](const char* ending) { return anchor.empty() ? "" : anchor + ending; };
    return {{"label", label},
            {"file", image_path(comparison, image + ".js")},
            {"picture_id", picture_id},
            {"error", map_json(comparison, image + "-error", id("-error"))},
            {"causes", map_json(comparison, "causes-" + image, id("-causes"))},
            {"first", is_first}};
}

/// Returns the causes of error that some row has, with their colours in pictures, 0..255.
Json cause_colours_json(const Comparison& comparison) {
    Json list = Json::array();
    for (const CauseColour& colour : found_cause_colours(comparison)) {
        Json bytes = Json::array();
        for (int k = 0; k < 3; ++k)
            bytes.push_back(static_cast<int>(std::lround(255 * colour.colour[k])));
        list.push_back({{"name", colour.cause}, {"colour", bytes}});
    }
    return list;
}

/// Returns the pictures of each row's largest lag, one entry an instant: the reference first, then
/// the row in the moving scene and in the scene at rest. They have no maps.
Json lag_instants_json(const Comparison& comparison) {
    Json list = Json::array();
    if (!comparison.lag) return list;
    for (const LagRow& row : comparison.lag->rows) {
        const std::string name = find_lag_image(comparison, row);
        if (!row.worst || name.empty()) continue;
        const std::string when = fmt::format("{:.2f} s", row.worst->seconds);
        Json pictures = Json::array();
        for (const auto& [label, ending] :
             {std::pair("reference at " + when, "-reference"),
              {fmt::format("{}, moving at {:g}x", row.label, row.worst->speed), "-moving"},
              {row.label + ", at rest", "-still"}})
            pictures.push_back(picture_json(comparison, label, name + ending, "", "", false));
        list.push_back({{"label", fmt::format("worst lag of {}: {:g}x, {}", row.label,
                                              row.worst->speed, when)},
                        {"mirrors_file", image_path(comparison, name + "-mirrors.js")},
                        {"pictures", pictures}});
    }
    return list;
}

/// Returns the row with the smallest FLIP above 0 over the mirrors, or null if there is none. The
/// comparer shows this row first.
const Row* closest_with_error(const Comparison& comparison) {
    const Row* closest = nullptr;
    for (const Row& row : comparison.rows)
        if (row.error.flip > 0 && (closest == nullptr || row.error.flip < closest->error.flip))
            closest = &row;
    return closest;
}

} // namespace

std::string bytes_script(std::string_view bytes, const std::string& file) {
    return "catoptric_values(" + Json(file).dump() + ", \"" + encode_base64(bytes) + "\");\n";
}

std::string html_comparer(const Comparison& comparison) {
    if (comparison.reference_display.pixels.empty() || comparison.rows.empty()) return "";
    const std::string prefix = id_prefix(comparison);
    const Row* first = closest_with_error(comparison);
    Json pictures = Json::array();
    pictures.push_back(picture_json(comparison, "reference " + comparison.reference_label,
                                    "reference", prefix + "reference", "", false));
    for (std::size_t i = 0; i < comparison.rows.size(); ++i) {
        const Row& row = comparison.rows[i];
        const std::string anchor = row_anchor(comparison, i);
        pictures.push_back(picture_json(comparison, row.label, row.image, anchor + "-picture",
                                        anchor, &row == first));
    }
    Json mirrors = Json::array();
    for (std::size_t i = 0; i < comparison.scene.mirrors; ++i)
        mirrors.push_back(fmt::format("mirror {}", i + 1));
    const Json data{{"width", comparison.reference_display.width},
                    {"height", comparison.reference_display.height},
                    {"exposure", comparison.exposure},
                    {"mirrors", mirrors},
                    {"causes", cause_colours_json(comparison)},
                    {"mirrors_file", image_path(comparison, "mirrors.js")},
                    {"pictures", pictures},
                    {"lag", lag_instants_json(comparison)}};
    return "<section class=\"comparer\" aria-label=\"Comparer\">" + data_script(data) +
           "</section>";
}

std::string picture_script(const measure::Picture& picture, const std::string& file) {
    std::vector<std::uint16_t> halves;
    halves.reserve(3 * picture.pixels.size());
    for (const vec3& pixel : picture.pixels)
        for (int k = 0; k < 3; ++k) halves.push_back(glm::packHalf1x16(pixel[k]));
    return words_script(halves, file);
}

std::string mirror_script(const std::vector<std::uint32_t>& mirror_hits, const std::string& file) {
    std::vector<std::uint16_t> mirrors;
    mirrors.reserve(mirror_hits.size());
    for (const std::uint32_t hit : mirror_hits)
        mirrors.push_back(static_cast<std::uint16_t>(hit & 0xFFFF));
    return words_script(mirrors, file);
}

} // namespace catoptric::report
