#include "report/tables.hpp"

#include "core/mirror_id.hpp"
#include "measure/findings.hpp"
#include "measure/judge.hpp"
#include "measure/metric.hpp"
#include "measure/row_notes.hpp"
#include "measure/rows.hpp"
#include "measure/seed_report.hpp"
#include "report/part.hpp"
#include "report/text.hpp"

#include <algorithm>
#include <iterator>

namespace catoptric::report {

namespace {

std::string nothing() { return std::string(kNothing); }

/// Returns the interval of the median.
std::string interval_text(const measure::Summary& times, int decimals) {
    if (!times.ci95.is_known()) return nothing();
    return fixed(times.ci95.low, decimals) + "–" + fixed(times.ci95.high, decimals);
}

/// Returns places as "3" or "3–5".
std::string places_text(const measure::PlaceRange& places) {
    const std::string first = std::to_string(places.first);
    return places.first == places.last ? first : first + "–" + std::to_string(places.last);
}

const Row* ours(const Comparison& comparison, const measure::SeedRow& seed) {
    if (seed.inter_reflections >= 0) return measure::find_naive(comparison, seed.inter_reflections);
    if (seed.technique == "parallax") return measure::find_parallax(comparison);
    if (seed.technique == "raytrace") return measure::find_ray_traced(comparison);
    return measure::find_row(comparison, seed.technique);
}

std::vector<std::string> theirs(const measure::SeedRow& seed) {
    const bool counted = seed.inter_reflections >= 0;
    return {std::string(seed.implementation),
            counted ? std::to_string(seed.inter_reflections) : nothing(),
            seed.scene_passes > 0 ? std::to_string(seed.scene_passes) : nothing(),
            fixed(seed.fps, seed.fps < 20 ? 1 : 0), fixed(seed.ms, 1)};
}

std::vector<std::string> measured(const Comparison& comparison, const Row& row, int decimals) {
    return {row.label,
            std::to_string(row.scene_passes),
            std::to_string(row.scene_draws),
            fixed(row.time_ms().median, decimals),
            interval_text(row.time_ms(), decimals),
            places_text(measure::places_in_time(comparison, row)),
            fps_text(row.time_ms().median),
            error_text(row.error.flip),
            fixed(100 * row.error.off, 2),
            error_text(row.error.mae),
            error_text(row.error.rmse),
            error_text(row.error_first_order.flip)};
}

std::string seed_note(const Comparison& comparison) {
    std::string note =
        "Left: the seed report, frames per second in a browser on a GeForce GTX 770; R by its "
        "formula for four mirrors. Right: this run; R counted in the executed plan, a cube counted "
        "once, draws with every face; ms the median of the rounds' medians and its 95 % interval; "
        "place: from the fastest, rows that tie share one; FPS = 1000 / ms; errors against the "
        "reference over the pixels whose first hit is a mirror, off the share of these in which a "
        "channel differs by more than .02; first order leaves out mirrors seen in mirrors.";
    if (comparison.scene.mirrors != measure::kSeedMirrors)
        note += " This scene has " + std::to_string(comparison.scene.mirrors) +
                " mirrors, so R cannot be the report's.";
    return note;
}

std::string remark(const Comparison& comparison, const Row& row) {
    std::vector<std::string> remarks;
    if (measure::failed(row)) remarks.push_back("failed");
    if (row.is_reference) remarks.push_back("reference");
    if (measure::on_front(comparison, row)) remarks.push_back("front");
    if (row.noisy) remarks.push_back("noisy");
    if (row.model != "everything") remarks.push_back("model " + row.model);
    for (std::string& note : measure::notes_of(comparison, row)) remarks.push_back(std::move(note));
    return joined(remarks, ", ");
}

/// Returns a cell of a metric's column. `decimals` is that of times in the whole table.
std::string cell(const measure::MetricColumn& column, const measure::Value& value, int decimals) {
    using measure::Style;
    if (measure::is_nothing(value)) return nothing();
    if (const auto* times = std::get_if<measure::Summary>(&value)) {
        if (column.style == Style::time_interval) return interval_text(*times, decimals);
        return column.style == Style::times ? fixed(times->median, decimals)
                                            : ms_text(times->median);
    }
    if (const auto* mark = std::get_if<bool>(&value)) return *mark ? "yes" : "no";
    const auto* number = std::get_if<double>(&value);
    if (number == nullptr) return nothing(); // the value is more than one number
    return number_text(*number, column, decimals);
}

/// Column of a metric. For metrics of a difference, `mask` is the mask of the column.
struct FigureColumn {
    const measure::Metric* quantity;
    measure::MetricColumn column;
    const measure::RowMask* mask = nullptr;

    int order() const { return column.order != 0 ? column.order : quantity->order; }
    measure::Value value(const Row& row) const {
        return mask == nullptr ? measure::value_of(*quantity, row)
                               : measure::value_of(*quantity, row.*mask->error);
    }
    std::string title() const {
        const std::string words(column.title);
        return mask == nullptr || mask->title.empty() ? words
                                                      : words + ", " + std::string(mask->title);
    }
};

/// Returns the columns of the metrics in a table, by order. Columns over other masks follow all
/// columns over the mirrors.
std::vector<FigureColumn> figure_columns(measure::MetricTable table, const Comparison& comparison) {
    std::vector<FigureColumn> columns;
    int last = 0; // the last order of a metric of differences
    for (const measure::Metric& quantity : measure::difference_metrics())
        if (quantity.order < measure::kAfterDifferences) last = quantity.order;
    for (const measure::Metric& quantity : measure::metrics())
        for (const measure::MetricColumn& column : quantity.columns) {
            if (column.table != table || !measure::is_shown(quantity, comparison)) continue;
            if (quantity.mask != "each") {
                columns.push_back({&quantity, column});
                continue;
            }
            for (const measure::RowMask& mask : measure::masks()) {
                if (!mask.title.empty() && !quantity.each_mask_in_table) continue;
                if (!measure::has_columns(mask, comparison)) continue;
                columns.push_back({&quantity, column, &mask});
                if (!mask.title.empty()) columns.back().column.order = last;
            }
        }
    std::ranges::stable_sort(columns, {}, &FigureColumn::order);
    return columns;
}

void add_columns(Table& table, const std::vector<FigureColumn>& columns) {
    for (const FigureColumn& column : columns) table.columns.emplace_back(column.title());
}

std::vector<std::string> cells_of(const Row& row, const std::vector<FigureColumn>& columns,
                                  int decimals) {
    std::vector<std::string> cells{row.label};
    for (const FigureColumn& column : columns)
        cells.push_back(cell(column.column, column.value(row), decimals));
    return cells;
}

/// Returns the technique as the user would write it. Knobs with default values are left out.
std::string technique_text(const PlanEntry& entry) {
    std::vector<std::string> changed;
    for (const Setting& setting : entry.settings)
        if (setting.changed) changed.push_back(setting.name + "=" + setting.text);
    return entry.technique + (changed.empty() ? "" : ":" + joined(changed, ","));
}

struct Words {
    std::string_view id, text;
};

constexpr Words kWords[] = {
    {"normal-texture", "surfaces are as smooth as their triangles"},
    {"occlusion-texture", "left out"},
    {"clearcoat", "left out"},
    {"sheen", "left out"},
    {"anisotropy", "left out"},
    {"iridescence", "left out"},
    {"blend-as-mask", "there or not there, cut at half their alpha"},
    {"specular-left-out", "drawn without a highlight: its diffuse part alone"},
    {"indirect-left-out", "light from one diffuse surface to another is not computed; --ambient "
                          "stands in for it"},
    {"environment-unshadowed", "lit by the whole environment, whatever stands in its way"},
    {"rough-metal", "drawn as diffuse with the metal's colour"},
    {"rough-glass", "drawn as diffuse"},
    {"glass-as-diffuse", "its diffuse part is drawn"},
    {"glass-shadow", "glass casts the full shadow of an opaque surface"},
    {"smooth-dielectric", "reflects the environment alone where rays are not traced; "
                          "--dielectric-mirrors makes mirrors of them"},
    {"skin", "posed by its joints at rest"},
    {"morph", "weights at their defaults"},
    {"points-lines", "left out"},
    {"other-animations", "left out; --animation chooses another"},
    {"missing-image", "drawn with the factor alone"},
    {"missing-material", "drawn grey"},
    {"lights-left-out", "the strongest are kept"},
    {"material-extension", "left out"},
    {"added-studio", "lit by a built-in environment, since nothing else lights"},
    {"added-camera", "seen from the front right and above, a closed room from inside"},
};

} // namespace

std::string number_text(double value, const measure::MetricColumn& column, int decimals) {
    using measure::Style;
    switch (column.style) {
    case Style::fixed: return fixed(value, column.decimals);
    case Style::percent: return fixed(100 * value, column.decimals);
    case Style::mebibytes: return mebibytes(static_cast<std::uint64_t>(value));
    case Style::times: return fixed(value, decimals);
    case Style::own_times: return ms_text(value);
    default: return error_text(value);
    }
}

Column text_column(const char* title) {
    Column column(title);
    column.is_number = false;
    return column;
}

Table seed_table(const Comparison& comparison) {
    // "llvmpipe" for "llvmpipe (LLVM 15.0.6, 256 bits)"
    const std::string device = comparison.device.name.substr(0, comparison.device.name.find(" ("));
    Table table{"The seed report's Table 1, measured again",
                {text_column("Implementation"), "i", "their R", "FPS, GTX 770", "ms, GTX 770",
                 text_column("Here"), "R", "Draws", "ms, " + device, "95 %", "Place",
                 "FPS, " + device, "FLIP", "off, %", "MAE", "rmse", "FLIP, first order"},
                seed_note(comparison)};
    const int decimals = ms_decimals(comparison);
    for (const measure::SeedRow& seed : measure::kSeedTable) {
        std::vector<std::string>& cells = table.rows.emplace_back(theirs(seed));
        std::vector<std::string> right{"not in this run"};
        if (const Row* row = ours(comparison, seed)) right = measured(comparison, *row, decimals);
        cells.insert(cells.end(), right.begin(), right.end());
        cells.resize(table.columns.size(), nothing());
    }
    return table;
}

Table rows_table(const Comparison& comparison) {
    Table table{"Every row, times on " + comparison.device.name,
                {text_column("Row"), "Place"},
                "A row's name leaves out knobs that nobody set. Place: in the order of time, from "
                "the fastest; rows that tie share one. Without another word, errors are over the "
                "pixels whose first hit is a mirror; off: a channel differs by more than .02. "
                "rmse, light edges and rest: of pixels that looked within a texel of a light's "
                "outline, and of the others; their squares add up to that of rmse. Longest line: "
                "of pixels that are off, in pixels. wall: submit to fence; cpu: of all the "
                "process's threads; record: filling the command buffer; MiB: the frame's images."};
    if (measure::find_not_drawn(comparison))
        table.note += " Smooth dielectrics: the pixels whose first hit reflects without being a "
                      "mirror.";
    const std::vector<FigureColumn> columns = figure_columns(measure::MetricTable::rows,
                                                             comparison);
    add_columns(table, columns);
    table.columns.push_back(text_column("Remark"));
    const int decimals = ms_decimals(comparison);
    for (const Row& row : comparison.rows) {
        std::vector<std::string>& cells = table.rows.emplace_back(cells_of(row, columns, decimals));
        cells.insert(cells.begin() + 1, places_text(measure::places_in_time(comparison, row)));
        cells.push_back(remark(comparison, row));
        table.marked.push_back(measure::on_front(comparison, row));
    }
    return table;
}

Table mirror_table(const Comparison& comparison) {
    Table table{"Mirror by mirror", {text_column("Row")}, "FLIP over the pixels of each mirror."};
    std::size_t mirrors = 0;
    for (const Row& row : comparison.rows) mirrors = std::max(mirrors, row.error_per_mirror.size());
    for (std::size_t i = 0; i < mirrors; ++i)
        table.columns.push_back("Mirror " + std::to_string(MirrorId::at(i).number()));
    for (const Row& row : comparison.rows) {
        std::vector<std::string>& cells = table.rows.emplace_back(1, row.label);
        for (const measure::Difference& error : row.error_per_mirror)
            cells.push_back(error_text(error.flip));
        cells.resize(mirrors + 1, nothing());
    }
    return table;
}

Table lookup_table(const Comparison& comparison) {
    Table table{"Where mirrors looked",
                {text_column("Row")},
                "Angle between the looked-up and the true direction from the centre of the capture "
                "that was looked into, over mirror pixels whose reflected ray meets no second "
                "mirror, in whichever capture the row looked; wrong object: the capture shows "
                "another one there; unknown and miss: what the search says of itself; traced: of "
                "all mirror pixels."};
    const std::vector<FigureColumn> columns = figure_columns(measure::MetricTable::lookup,
                                                             comparison);
    add_columns(table, columns);
    const int decimals = ms_decimals(comparison);
    for (const Row& row : comparison.rows)
        if (row.lookup) table.rows.push_back(cells_of(row, columns, decimals));
    return table;
}

Table plan_table(const Comparison& comparison) {
    Table table{"Mirror by mirror, what draws it",
                {text_column("Row"), "Mirror", text_column("Name"), text_column("Technique"),
                 text_column("Why")},
                "Rows that are plans. Each of their mirrors has its own technique; the error of "
                "such a row is not split by cause."};
    for (const Row& row : comparison.rows) {
        if (row.technique != "plan") continue;
        for (const PlanEntry& entry : row.plan)
            table.rows.push_back({row.label, std::to_string(entry.mirror), entry.name,
                                  technique_text(entry), entry.why});
    }
    return table;
}

const RegisteredPart kMirrorsPart{
    {.name = "mirrors",
     .order = 200,
     .tables = [](const Comparison& comparison) { return std::vector{mirror_table(comparison)}; },
     .look = "mirrors",
     .links_rows = true}};
const RegisteredPart kLookupsPart{
    {.name = "lookups",
     .order = 300,
     .tables = [](const Comparison& comparison) { return std::vector{lookup_table(comparison)}; },
     .look = "lookups",
     .links_rows = true}};

std::string gap_in_words(const std::string& id) {
    const auto* const known = std::ranges::find(kWords, id, &Words::id);
    return known == std::end(kWords) ? "" : std::string(known->text);
}

Table unsupported_table(const SceneFacts& scene) {
    Table table{
        "Added, approximated, left out",
        {text_column("What"), "Count", "Pixels, %", text_column("First"), text_column("Instead")},
        "What the scene says that is not shown so, and what was added to it, the largest "
        "share of the picture first. Pixels: share of the picture that shows such a "
        "material first; none where pixels cannot tell."};
    for (const UnsupportedFeatureFacts& gap : scene.unsupported)
        table.rows.push_back({gap.id, std::to_string(gap.count),
                              gap.pixel_share ? fixed(100 * *gap.pixel_share, 1) : nothing(),
                              gap.first, gap_in_words(gap.id)});
    return table;
}

} // namespace catoptric::report
