#include "report/tables.hpp"

#include "core/mirror_id.hpp"
#include "measure/findings.hpp"
#include "measure/judge.hpp"
#include "measure/metric.hpp"
#include "measure/row_notes.hpp"
#include "measure/rows.hpp"
#include "measure/seed_report.hpp"
#include "report/report_part.hpp"
#include "report/text.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace catoptric::report {

namespace {

std::string empty_cell() { return std::string(kEmptyCell); }

/// Returns the interval of the median.
std::string format_interval(const measure::SampleSummary& times, int decimals) {
    if (!times.ci95.is_known()) return empty_cell();
    return format_fixed(times.ci95.low, decimals) + "–" + format_fixed(times.ci95.high, decimals);
}

const Row* find_own_row(const Comparison& comparison, const measure::SeedReportRow& seed) {
    if (seed.inter_reflections >= 0)
        return measure::find_naive_row(comparison, seed.inter_reflections);
    if (seed.part == TechniqueTraits::SeedPart::parallax)
        return measure::find_parallax_row(comparison);
    if (seed.part == TechniqueTraits::SeedPart::rays)
        return measure::find_ray_traced_row(comparison);
    return measure::find_seed_row(comparison, seed.part);
}

std::vector<std::string> seed_cells(const measure::SeedReportRow& seed) {
    const bool counted = seed.inter_reflections >= 0;
    return {std::string(seed.implementation),
            counted ? std::to_string(seed.inter_reflections) : empty_cell(),
            seed.scene_passes > 0 ? std::to_string(seed.scene_passes) : empty_cell(),
            format_fixed(seed.fps, seed.fps < 20 ? 1 : 0), format_fixed(seed.ms, 1)};
}

std::vector<std::string> format_measured_cells(const Comparison& comparison, const Row& row,
                                               int decimals) {
    return {row.label,
            std::to_string(row.scene_passes),
            std::to_string(row.scene_draws),
            format_fixed(row.time_ms().median, decimals),
            format_interval(row.time_ms(), decimals),
            format_time_places(measure::find_rank_range(comparison, row)),
            format_fps(row.elapsed_ms().median),
            format_flip(row.error),
            format_fixed(100 * row.error.off, 2),
            format_error(row.error.mae),
            format_error(row.error.rmse),
            format_flip(row.error_first_order)};
}

std::string seed_note(const Comparison& comparison) {
    std::string note =
        "Left: the seed report, frames per second in a browser on a GeForce GTX 770; R by its "
        "formula for four mirrors. Right: this run; R counted in the executed plan, a cube counted "
        "once, draws with every face; ms" +
        describe_judged_time(comparison) +
        " the median of the rounds' medians and its 95 % interval; place: from the fastest, rows "
        "that tie share one; FPS: 1000 ms divided by the device time; errors against the reference over the pixels whose first hit is a mirror, off the share of these in which a "
        "channel differs by more than .02; first order leaves out mirrors seen in mirrors.";
    if (comparison.scene.mirrors != measure::kSeedReportMirrorCount)
        note += " This scene has " + std::to_string(comparison.scene.mirrors) +
                " mirrors, so R cannot be the report's.";
    return note;
}

std::string row_remark(const Comparison& comparison, const Row& row) {
    std::vector<std::string> remarks;
    if (measure::has_nonfinite_pixels(row)) remarks.push_back("failed");
    if (row.is_reference) remarks.push_back("reference");
    if (measure::is_on_front(comparison, row)) remarks.push_back("front");
    if (row.noisy) remarks.push_back("noisy");
    if (row.model != "everything") remarks.push_back("model " + row.model);
    for (std::string& note : measure::row_notes(comparison, row))
        remarks.push_back(std::move(note));
    return join_texts(remarks, ", ");
}

/// `decimals`: that of times in the whole table.
std::string format_metric_cell(const measure::MetricColumn& column,
                               const measure::MetricValue& value, int decimals) {
    using measure::ValueFormat;
    if (measure::is_missing(value)) return empty_cell();
    if (const auto* times = std::get_if<measure::SampleSummary>(&value)) {
        if (column.style == ValueFormat::time_interval) return format_interval(*times, decimals);
        return column.style == ValueFormat::times ? format_fixed(times->median, decimals)
                                                  : format_ms(times->median);
    }
    if (const auto* mark = std::get_if<bool>(&value)) return *mark ? "yes" : "no";
    const auto* number = std::get_if<double>(&value);
    if (number == nullptr) return empty_cell(); // the value is more than one number
    return format_metric_number(*number, column, decimals);
}

/// If the FLIP is not larger than the noise of the reference, the cell says so.
std::string format_flip_cell(const measure::Difference& error) {
    return std::isfinite(error.flip) ? format_flip(error) : empty_cell();
}

/// Column of a metric. For metrics of a difference, `mask` is the mask of the column.
struct MetricTableColumn {
    const measure::Metric* metric;
    measure::MetricColumn column;
    const measure::RowMask* mask = nullptr;

    int order() const { return column.order != 0 ? column.order : metric->order; }
    measure::MetricValue value(const Row& row) const {
        return mask == nullptr ? measure::metric_value(*metric, row)
                               : measure::metric_value(*metric, row.*mask->error);
    }
    std::string title() const {
        const std::string words(column.title);
        return mask == nullptr || mask->title.empty() ? words
                                                      : words + ", " + std::string(mask->title);
    }
};

/// Returns the columns of the metrics in a table, by order. Columns over other masks follow all
/// columns over the mirrors.
std::vector<MetricTableColumn> metric_columns(measure::TableKind table,
                                              const Comparison& comparison) {
    std::vector<MetricTableColumn> columns;
    int last = 0; // the last order of a metric of differences
    for (const measure::Metric& metric : measure::difference_metrics())
        if (metric.order < measure::kOrderAfterDifferences) last = metric.order;
    for (const measure::Metric& metric : measure::metrics())
        for (const measure::MetricColumn& column : metric.columns) {
            if (column.table != table || !measure::is_shown(metric, comparison)) continue;
            if (metric.mask != "each") {
                columns.push_back({&metric, column});
                continue;
            }
            for (const measure::RowMask& mask : measure::row_masks()) {
                if (!mask.title.empty() && !metric.each_mask_in_table) continue;
                if (!measure::has_table_columns(mask, comparison)) continue;
                columns.push_back({&metric, column, &mask});
                if (!mask.title.empty()) columns.back().column.order = last;
            }
        }
    std::ranges::stable_sort(columns, {}, &MetricTableColumn::order);
    return columns;
}

void add_metric_columns(ReportTable& table, const std::vector<MetricTableColumn>& columns) {
    for (const MetricTableColumn& column : columns) table.columns.emplace_back(column.title());
}

std::vector<std::string>
format_row_cells(const Row& row, const std::vector<MetricTableColumn>& columns, int decimals) {
    std::vector<std::string> cells{row.label};
    for (const MetricTableColumn& column : columns)
        cells.push_back(column.mask != nullptr && column.metric->name == "flip"
                            ? format_flip_cell(row.*column.mask->error)
                            : format_metric_cell(column.column, column.value(row), decimals));
    return cells;
}

struct FeatureText {
    std::string_view id, text;
};

constexpr FeatureText kFeatureTexts[] = {
    {"normal-texture", "height maps are left out; surfaces are as smooth as their triangles"},
    {"occlusion-texture", "left out"},
    {"clearcoat", "left out on glass, unlit surfaces and mirrors by `reflectance`"},
    {"clearcoat-texture", "textures of the coat are left out, and its normals are those of the "
                          "surface below"},
    {"sheen", "left out"},
    {"anisotropy", "left out"},
    {"iridescence", "left out"},
    {"blend-shadow", "blended over what is behind, but shadows and mirrors are cut at half their "
                     "alpha, and overlapping parts of one object are not sorted"},
    {"indirect-left-out", "light from one diffuse surface to another is not computed; --ambient "
                          "or light probes can stand in for it"},
    {"environment-unshadowed", "lit by the whole environment, whatever stands in its way"},
    {"rough-metal", "too rough for a capture: where rays are not traced, it reflects the "
                    "environment and lights without a surface, and lamps light it as if it were "
                    "diffuse"},
    {"rough-dielectric", "where rays are not traced, it reflects the environment and lights "
                         "without a surface, but no lamps and objects; --dielectric-mirrors makes "
                         "mirrors of those that are smooth enough"},
    {"rough-glass", "where rays are not traced, a blurred look-up stands for the light that passes "
                    "it, and lights without a surface are seen in its reflections alone"},
    {"dispersion", "where rays are not traced, all colours bend alike"},
    {"glass-approximated",
     "where rays are not traced, light that passes it bends by a model of the body (knob "
     "`refract`) and is not reflected inside"},
    {"glass-as-diffuse", "where rays are not traced, of more objects of glass than 64 only the "
                         "largest are glass; of the others, the diffuse part is drawn"},
    {"nested-glass", "solid glass that shares space with other solid glass: where rays are not "
                     "traced, each surface bends light as if air were outside; traced rays find "
                     "the inner body, else that of the higher index of refraction"},
    {"partial-glass", "glass that is partly metal, or lets less than half of the light pass: drawn "
                      "as if no light passed it"},
    {"glass-shadow", "glass casts no shadow, so light passes it without being tinted or bent; "
                     "--glass-shadow tint tints it"},
    {"glass-shadow-straight", "light passes it on straight rays: it is tinted, but not bent"},
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

std::string format_technique(const PlanEntry& entry) {
    std::vector<std::string> changed;
    for (const Setting& setting : entry.settings)
        if (setting.changed) changed.push_back(setting.name + "=" + setting.text);
    return entry.technique + (changed.empty() ? "" : ":" + join_texts(changed, ","));
}

std::string format_metric_number(double value, const measure::MetricColumn& column, int decimals) {
    using measure::ValueFormat;
    switch (column.style) {
    case ValueFormat::fixed: return format_fixed(value, column.decimals);
    case ValueFormat::percent: return format_fixed(100 * value, column.decimals);
    case ValueFormat::mebibytes: return format_mebibytes(static_cast<std::uint64_t>(value));
    case ValueFormat::times: return format_fixed(value, decimals);
    case ValueFormat::own_times: return format_ms(value);
    default: return format_error(value);
    }
}

std::string format_time_places(const measure::RankRange& places) {
    if (places.first == 0) return std::string(kEmptyCell);
    const std::string first = std::to_string(places.first);
    return places.first == places.last ? first : first + "–" + std::to_string(places.last);
}

TableColumn text_column(const char* title) {
    TableColumn column(title);
    column.is_number = false;
    return column;
}

ReportTable seed_table(const Comparison& comparison) {
    // "llvmpipe" for "llvmpipe (LLVM 15.0.6, 256 bits)"
    const std::string device = comparison.device.name.substr(0, comparison.device.name.find(" ("));
    ReportTable table{"The seed report's Table 1, measured again",
                      {text_column("Implementation"), "i", "their R", "FPS, GTX 770", "ms, GTX 770",
                       text_column("Here"), "R", "Draws", "ms, " + device, "95 %", "Place",
                       "FPS, " + device, "FLIP", "off, %", "MAE", "rmse", "FLIP, first order"},
                      seed_note(comparison)};
    const int decimals = ms_decimals(comparison);
    for (const measure::SeedReportRow& seed : measure::kSeedReportTable) {
        std::vector<std::string>& cells = table.rows.emplace_back(seed_cells(seed));
        std::vector<std::string> right{"not in this run"};
        if (const Row* row = find_own_row(comparison, seed))
            right = format_measured_cells(comparison, *row, decimals);
        cells.insert(cells.end(), right.begin(), right.end());
        cells.resize(table.columns.size(), empty_cell());
    }
    return table;
}

ReportTable rows_table(const Comparison& comparison) {
    ReportTable table{
        "Every row, times on " + comparison.device.name,
        {text_column("Row"), "Place"},
        "A row's name leaves out knobs that nobody set. Place: in the order of time" +
            describe_judged_time(comparison) +
            ", from the fastest; rows whose times are equal or cannot be told apart share one. "
            "Without another word, errors are over the pixels whose first hit is a mirror; off: a channel differs by more than .02. "
            "rmse, light edges and rest: of pixels that looked within a texel of a light's "
            "outline, and of the others; their squares add up to that of rmse. Longest line: "
            "of pixels that are off, in pixels. wall: submit to fence; cpu: of all the "
            "process's threads; record: filling the command buffer; MiB: the frame's images."};
    if (measure::find_undrawn_dielectrics(comparison))
        table.note += " Smooth dielectrics: the pixels whose first hit reflects without being a "
                      "mirror.";
    const std::vector<MetricTableColumn> columns = metric_columns(measure::TableKind::rows,
                                                                  comparison);
    add_metric_columns(table, columns);
    table.columns.push_back(text_column("Remark"));
    const int decimals = ms_decimals(comparison);
    for (const Row& row : comparison.rows) {
        std::vector<std::string>& cells = table.rows.emplace_back(
            format_row_cells(row, columns, decimals));
        cells.insert(cells.begin() + 1,
                     format_time_places(measure::find_rank_range(comparison, row)));
        cells.push_back(row_remark(comparison, row));
        table.marked.push_back(measure::is_on_front(comparison, row));
    }
    return table;
}

std::vector<RowMetricColumn> row_metric_columns(const Comparison& comparison) {
    using measure::ValueFormat;
    const std::string_view ranked = measure::judged_time(comparison);
    std::vector<RowMetricColumn> list;
    for (const MetricTableColumn& column : metric_columns(measure::TableKind::rows, comparison)) {
        const ValueFormat style = column.column.style;
        if (style == ValueFormat::time_interval || column.metric->name == ranked) continue;
        const bool is_over_mirrors = column.mask != nullptr && column.mask->title.empty();
        RowMetricColumn numbers{
            column.title() + (is_over_mirrors ? " over the mirrors" : ""), {}, {}};
        const double scale = style == ValueFormat::percent     ? 100
                             : style == ValueFormat::mebibytes ? 1.0 / (1 << 20)
                                                               : 1;
        for (const Row& row : comparison.rows) {
            const measure::MetricValue value = column.value(row);
            const auto* times = std::get_if<measure::SampleSummary>(&value);
            const auto* number = std::get_if<double>(&value);
            const bool is_missing = measure::is_missing(value);
            numbers.values.push_back(is_missing          ? NAN
                                     : times != nullptr  ? times->median
                                     : number != nullptr ? scale * *number
                                                         : NAN);
            const bool is_rmse = is_over_mirrors && column.metric->name == "rmse";
            numbers.intervals.push_back(times != nullptr ? times->ci95
                                        : is_rmse        ? find_rmse_interval(row)
                                                         : measure::Interval());
        }
        if (std::ranges::any_of(numbers.values, [](double value) { return std::isfinite(value); }))
            list.push_back(std::move(numbers));
    }
    std::ranges::stable_partition(
        list, [](const RowMetricColumn& column) { return column.name == "FLIP over the mirrors"; });
    return list;
}

ReportTable mirror_table(const Comparison& comparison) {
    ReportTable table{
        "Mirror by mirror", {text_column("Row")}, "FLIP over the pixels of each mirror."};
    std::size_t mirrors = 0;
    for (const Row& row : comparison.rows) mirrors = std::max(mirrors, row.error_per_mirror.size());
    for (std::size_t i = 0; i < mirrors; ++i)
        table.columns.push_back("Mirror " + std::to_string(MirrorId::from_index(i).number()));
    for (const Row& row : comparison.rows) {
        std::vector<std::string>& cells = table.rows.emplace_back(1, row.label);
        for (const measure::Difference& error : row.error_per_mirror)
            cells.push_back(format_flip(error));
        cells.resize(mirrors + 1, empty_cell());
    }
    return table;
}

ReportTable lookup_table(const Comparison& comparison) {
    ReportTable table{
        "Where mirrors looked",
        {text_column("Row")},
        "Angle between the looked-up and the true direction from the centre of the capture "
        "that was looked into, over mirror pixels whose reflected ray meets no second "
        "mirror, in whichever capture the row looked; wrong object: the capture shows "
        "another one there; unknown and miss: what the search says of itself; traced: of "
        "all mirror pixels."};
    const std::vector<MetricTableColumn> columns = metric_columns(measure::TableKind::lookup,
                                                                  comparison);
    add_metric_columns(table, columns);
    const int decimals = ms_decimals(comparison);
    for (const Row& row : comparison.rows)
        if (row.lookup) table.rows.push_back(format_row_cells(row, columns, decimals));
    return table;
}

ReportTable plan_table(const Comparison& comparison) {
    ReportTable table{
        "Mirror by mirror, what draws it",
        {text_column("Row"), "Mirror", text_column("Name"), text_column("Technique"),
         text_column("Why")},
        "Rows that are plans. Each of their mirrors has its own technique; the error of "
        "such a row is not split by cause."};
    for (const Row& row : comparison.rows) {
        if (row.technique != "plan") continue;
        for (const PlanEntry& entry : row.plan)
            table.rows.push_back({row.label, std::to_string(entry.mirror), entry.name,
                                  format_technique(entry), entry.why});
    }
    return table;
}

const RegisteredPart kMirrorErrorsPart{
    {.name = "mirrors",
     .order = 200,
     .tables = [](const Comparison& comparison) { return std::vector{mirror_table(comparison)}; },
     .look = "mirrors",
     .links_rows = true}};
const RegisteredPart kLookupErrorsPart{
    {.name = "lookups",
     .order = 300,
     .tables = [](const Comparison& comparison) { return std::vector{lookup_table(comparison)}; },
     .look = "lookups",
     .links_rows = true}};

std::string describe_feature(const std::string& id) {
    const auto* const known = std::ranges::find(kFeatureTexts, id, &FeatureText::id);
    return known == std::end(kFeatureTexts) ? "" : std::string(known->text);
}

ReportTable unsupported_table(const SceneFacts& scene) {
    ReportTable table{
        "Added, approximated, left out",
        {text_column("What"), "Count", "Pixels, %", text_column("First"), text_column("Instead")},
        "Features of the scene that are approximated or left out, and parts that were added to "
        "it, the largest share of the picture first. Pixels: share of the picture that shows such a "
        "material first; none where pixels cannot tell."};
    for (const UnsupportedFeatureFacts& gap : measure::read_scene_contents(scene).unsupported)
        table.rows.push_back(
            {gap.id, std::to_string(gap.count),
             gap.pixel_share ? format_fixed(100 * *gap.pixel_share, 1) : empty_cell(), gap.first,
             describe_feature(gap.id)});
    return table;
}

} // namespace catoptric::report
