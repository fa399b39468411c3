
#include "report/tables.hpp"

#include "core/error.hpp"
#include "measure/causes.hpp"
#include "measure/light_edges.hpp"
#include "report/report_part.hpp"
#include "report/text.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>

namespace catoptric::report {

namespace {

constexpr vec3 rgb_from_bytes(int red, int green, int blue) {
    return vec3(red, green, blue) / 255.0F;
}

const CauseColour kCauseColours[] = {{"storage format", "sky blue", rgb_from_bytes(86, 180, 233)},
                                     {"last frame", "orange", rgb_from_bytes(230, 159, 0)},
                                     {"noise", "violet", rgb_from_bytes(110, 60, 160)},
                                     {"filter", "brown", rgb_from_bytes(140, 86, 75)},
                                     {"distance law", "dark green", rgb_from_bytes(50, 90, 20)},
                                     {"lobe shape", "crimson", rgb_from_bytes(200, 20, 60)},
                                     {"direction", "blue", rgb_from_bytes(0, 114, 178)},
                                     {"hidden target", "vermilion", rgb_from_bytes(213, 94, 0)},
                                     {"texels", "yellow", rgb_from_bytes(240, 228, 66)},
                                     {"mirror in mirror", "green", rgb_from_bytes(0, 158, 115)},
                                     {"shadow map", "pink", rgb_from_bytes(204, 121, 167)},
                                     {"silhouettes", "white", vec3(1)},
                                     {"rest", "light grey", rgb_from_bytes(190, 190, 190)}};

/// Kind of line in the table: its name, and the function that computes its cells as shares of the
/// row's error.
struct CauseTableRow {
    const char* name;
    double (*part)(const CauseShare& cause, double squared_error);
    bool adds_up;
};

constexpr CauseTableRow kCauseTableLines[] = {
    {"all", [](const CauseShare& cause, double) { return cause.share; }, true},
    {"first order", [](const CauseShare& cause, double) { return cause.share_first_order; }, true},
    {"mirror in mirror",
     [](const CauseShare& cause, double) { return cause.share_mirror_in_mirror; }, true},
    {"bound", [](const CauseShare& cause, double whole) { return cause.alone / whole; }, false}};

constexpr const char* kRoughMirrorNote =
    " On rough mirrors, further causes are removed before these five. Noise: the mean of many "
    "drawings replaces the row's random directions. Filter: sharp look-ups in many directions of "
    "the level's lobe replace the filtered level. Distance law, and lobe shape: each direction is "
    "searched for itself, and directions follow the surface's own lobe; these two share their "
    "error by Shapley values. A dash means that the row has no such part. Squared errors are "
    "unbiased estimates from both halves of the reference.";

std::vector<std::string> format_cause_cells(const CauseTableRow& line, const Causes& causes,
                                            const std::vector<CauseColour>& columns) {
    std::vector<std::string> cells{line.name};
    double sum = 0;
    for (const CauseColour& colour : columns) {
        const auto cause = std::ranges::find(causes.list, colour.cause, &CauseShare::name);
        const bool is_there = cause != causes.list.end();
        const double part = is_there ? line.part(*cause, causes.squared_error) : NAN;
        if (is_there) sum += part;
        cells.push_back(format_fixed(100 * part, 1));
    }
    cells.push_back(line.adds_up ? format_fixed(100 * sum, 1) : std::string());
    cells.emplace_back();
    return cells;
}

const RegisteredPart kCausesPart{
    {.name = "causes",
     .order = 400,
     .tables = [](const Comparison& comparison) { return std::vector{cause_table(comparison)}; },
     .look = "causes"}};

} // namespace

std::span<const CauseColour> cause_colours() { return kCauseColours; }

std::vector<CauseColour> found_cause_colours(const Comparison& comparison) {
    std::vector<CauseColour> found;
    std::ranges::copy_if(kCauseColours, std::back_inserter(found), [&](const CauseColour& colour) {
        return std::ranges::any_of(comparison.rows, [&](const Row& row) {
            return row.causes && std::ranges::find(row.causes->list, colour.cause,
                                                   &CauseShare::name) != row.causes->list.end();
        });
    });
    return found;
}

measure::Picture cause_picture(const Row& row) {
    constexpr float kUncausedErrorBrightness = .35F;
    measure::Picture picture = row.display;
    check(row.causes != nullptr, Failure::internal, "row '", row.label, "' has no causes");
    const std::vector<std::uint8_t>& largest = row.causes->largest;
    check(largest.size() == picture.pixels.size(), Failure::internal, "row '", row.label,
          "': wanted a cause for each of ", picture.pixels.size(), " pixels, found ",
          largest.size());
    for (std::size_t i = 0; i < largest.size(); ++i) {
        vec3& pixel = picture.pixels[i];
        pixel = largest[i] > 0
                    ? std::ranges::find(kCauseColours, row.causes->list.at(largest[i] - 1U).name,
                                        &CauseColour::cause)
                          ->colour
                    : vec3(kUncausedErrorBrightness *
                           glm::dot(pixel, vec3(.2126F, .7152F, .0722F)));
    }
    return picture;
}

ReportTable cause_table(const Comparison& comparison) {
    ReportTable table{
        "Error by cause",
        {text_column("Row"), text_column("Over")},
        "Share of a row's squared error over the mirrors, in %: over all of their pixels, over "
        "those whose reflected ray meets no second mirror, and over the others. Causes are "
        "removed in this order: the storage format of distances, captures that are one frame "
        "old (last frame), then five causes that share the rest by Shapley values, from every "
        "set of them replaced by the reference's own. direction: where the ray "
        "really ends, and exact distances; hidden target: what the capture's centre does "
        "not see; texels: the captured surface at the very point; mirror in mirror: what "
        "mirrors show there; shadow map: shadow rays. Then silhouettes: pixels where "
        "rasteriser and ray see different mirrors; rest: no cause is missing where it is "
        "0. A negative share uncovers another's error. bound: what goes when one alone is "
        "replaced, first of all; these do not add up. In brackets: the colour, in "
        "images/causes-ROW.png, of pixels in which the cause has the largest part. At "
        "light edges: share of the squared error in pixels that looked within a texel of a "
        "light's outline."};
    const std::vector<CauseColour> found = found_cause_colours(comparison);
    const auto is_of_rough_mirrors = [](const CauseColour& colour) {
        return colour.cause == "noise";
    };
    if (std::ranges::any_of(found, is_of_rough_mirrors)) table.note += kRoughMirrorNote;
    for (const CauseColour& colour : found)
        table.columns.emplace_back(fmt::format("{} ({})", colour.cause, colour.name));
    table.columns.emplace_back("Sum");
    table.columns.emplace_back("At light edges");
    for (const Row& row : comparison.rows) {
        if (!row.causes) continue;
        for (const CauseTableRow& line : kCauseTableLines) {
            std::vector<std::string> cells = format_cause_cells(line, *row.causes, found);
            cells.insert(cells.begin(), &line == kCauseTableLines ? row.label : std::string());
            if (&line == kCauseTableLines)
                cells.back() = format_fixed(row.light_edges ? 100 * row.light_edges->share : NAN,
                                            1);
            table.rows.push_back(std::move(cells));
        }
    }
    return table;
}

} // namespace catoptric::report
