// Writes rows.csv by RFC 4180, so lines end in CR LF. A missing value is an empty field.
#include "core/mirror_id.hpp"
#include "measure/judge.hpp"
#include "measure/metric.hpp"
#include "measure/views.hpp"
#include "report/text.hpp"
#include "report/writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace catoptric::report {

namespace {

/// Field of a row and the name of its column.
struct CsvField {
    std::string name, text;
    bool in_table = true; ///< whether CsvColumns::table has the column, too
};

class CsvLine {
public:
    void add_field(std::string name, std::string text, bool in_table = true) {
        fields.push_back({std::move(name), std::move(text), in_table});
    }
    void add_field(std::string name, double value, bool in_table = true) {
        add_field(std::move(name), format_csv_number(value), in_table);
    }
    void add_field(const std::string& name, const measure::MetricValue& value, bool in_table);
    /// Adds one field for each axis.
    void add_field(const std::string& name, std::string_view axes, const dvec3& values,
                   bool in_table) {
        for (int i = 0; i < 3; ++i) add_field(name + "_" + axes[i], values[i], in_table);
    }

    std::vector<CsvField> fields;
};

/// Returns one field, with spaces between the numbers.
std::string format_number_list(const std::vector<double>& list) {
    std::vector<std::string> texts;
    for (const double value : list) texts.push_back(format_csv_number(value));
    return join_texts(texts, " ");
}

/// Adds the fields of a value: one column for each of its parts.
struct CsvFieldAdder {
    CsvLine& line;
    const std::string& name;
    bool in_table;

    void operator()(std::monostate) const { line.add_field(name, std::string(), in_table); }
    void operator()(double value) const { line.add_field(name, value, in_table); }
    void operator()(const dvec3& colour) const { line.add_field(name, "rgb", colour, in_table); }
    void operator()(const measure::PixelPosition& place) const {
        constexpr double kMissingDifferenceValue = measure::Difference::kNone;
        line.add_field(name + "_x", place.x < 0 ? kMissingDifferenceValue : place.x, in_table);
        line.add_field(name + "_y", place.x < 0 ? kMissingDifferenceValue : place.y, in_table);
    }
    void operator()(const measure::SampleSummary& times) const {
        line.add_field(name + "_median", times.median, in_table);
        line.add_field(name + "_ci95_low", times.ci95.low, in_table);
        line.add_field(name + "_ci95_high", times.ci95.high, in_table);
        line.add_field(name + "_p05", times.p05, false);
        line.add_field(name + "_p95", times.p95, false);
        line.add_field(name + "_mad", times.mad, false);
        line.add_field(name + "_n", static_cast<double>(times.n), false);
        line.add_field(name + "_rounds", format_number_list(times.rounds), false);
        line.add_field(name + "_samples", format_number_list(times.samples), false);
    }
    void operator()(const std::vector<double>& list) const {
        line.add_field(name, format_number_list(list), in_table);
    }
    void operator()(const std::vector<measure::MetricParts>& list) const {
        for (const measure::MetricParts& parts : list)
            for (const auto& [what, value] : parts.values)
                line.add_field(name + "_" + parts.name + "_" + std::string(what), value, false);
    }
};

void CsvLine::add_field(const std::string& name, const measure::MetricValue& value, bool in_table) {
    std::visit(CsvFieldAdder{*this, name, in_table}, value);
}

/// Returns whether the report's table of rows has a column of this metric.
bool is_in_rows_table(const measure::Metric& metric) {
    return std::ranges::any_of(metric.columns, [](const measure::MetricColumn& column) {
        return column.table == measure::TableKind::rows;
    });
}

/// Adds the metrics of a difference over one mask. Those that `is_in_table` accepts are columns of
/// the table.
template <class Predicate>
void add_differences(CsvLine& line, const std::string& mask, const measure::Difference& error,
                     Predicate is_in_table) {
    for (const measure::Metric& metric : measure::difference_metrics())
        line.add_field(mask + "_" + std::string(metric.name), measure::metric_value(metric, error),
                       is_in_table(metric));
}

/// Appends fields with the errors over each mask of pixels, then over each mirror. Appends fields
/// for `mirrors` mirrors, even if the row has fewer, so that all lines have the same columns.
void add_error_fields(CsvLine& line, const Comparison& comparison, const Row& row,
                      std::size_t mirrors) {
    for (const measure::RowMask& mask : measure::row_masks())
        if (measure::has_table_columns(mask, comparison))
            add_differences(line, std::string(mask.name), row.*mask.error,
                            [&](const measure::Metric& metric) {
                                return is_in_rows_table(metric) &&
                                       (mask.title.empty() || metric.each_mask_in_table);
                            });
    for (std::size_t i = 0; i < mirrors; ++i)
        add_differences(line, "mirror_" + std::to_string(MirrorId::from_index(i).number()),
                        i < row.error_per_mirror.size() ? row.error_per_mirror[i]
                                                        : measure::Difference{},
                        [](const measure::Metric&) { return false; });
}

void add_metric_fields(CsvLine& line, const Comparison& comparison, const Row& row,
                       std::size_t mirrors) {
    bool has_errors = false;
    for (const measure::Metric& metric : measure::metrics()) {
        if (!measure::is_shown(metric, comparison)) continue;
        if (metric.mask != "each") {
            std::string name(metric.name);
            std::ranges::replace(name, '/', '_');
            line.add_field(name, measure::metric_value(metric, row), is_in_rows_table(metric));
        } else if (!std::exchange(has_errors, true)) {
            add_error_fields(line, comparison, row, mirrors);
        }
    }
}

/// Adds the errors over the mirrors in the drawn views. Adds no columns if no views were drawn.
void add_view_fields(CsvLine& line, const Comparison& comparison, const Row& row) {
    if (comparison.views.empty()) return;
    for (const measure::Metric& metric : measure::difference_metrics()) {
        if (!measure::is_scalar(metric)) continue;
        const measure::MetricOverViews over = measure::metric_over_views(
            row, measure::row_masks().front(), metric);
        const std::string name = "views_" + std::string(metric.name);
        line.add_field(name + "_median", over.median);
        line.add_field(name + "_low", over.ci95.low);
        line.add_field(name + "_high", over.ci95.high);
    }
    line.add_field("views", static_cast<double>(row.views.size()));
    const measure::View* worst = row.worst ? &comparison.views.at(row.worst->view) : nullptr;
    line.add_field("worst_view", worst ? std::to_string(row.worst->view) : "");
    line.add_field("worst_view_camera", worst ? worst->camera.name : "");
    line.add_field("worst_view_time", worst ? worst->time : NAN);
}

/// Adds the fields that distinguish the rows of this run from those of other runs.
void add_identity_fields(CsvLine& line, const Comparison& comparison, const Row& row) {
    line.add_field("scene", comparison.scene.name);
    line.add_field("device", comparison.device.name);
    line.add_field("driver", comparison.device.driver);
    line.add_field("date", comparison.date);
    const auto add = [&](const char* name, const auto& value) {
        line.add_field(name, value, false);
    };
    add("plan", row.label);
    add("scene_hash", comparison.scene.hash);
    add("scene_triangles", static_cast<double>(comparison.scene.triangles));
    add("scene_mirrors", static_cast<double>(comparison.scene.mirrors));
    const measure::CameraFacts& camera = comparison.scene.camera;
    add("camera", camera.name);
    line.add_field("camera_eye", "xyz", camera.eye, false);
    line.add_field("camera_target", "xyz", camera.target, false);
    line.add_field("camera_up", "xyz", camera.up, false);
    add("camera_vertical_fov_degrees", camera.vertical_fov_degrees);
    add("time", comparison.time);
    add("width", comparison.width);
    add("height", comparison.height);
    add("ambient", comparison.ambient);
    add("exposure", comparison.exposure);
    add("frames", comparison.frames);
    add("warmup", comparison.warmup);
    add("rounds", comparison.rounds);
    add("load_start", comparison.load_start);
    add("load_end", comparison.load_end);
    add("timing", comparison.timing);
    add("together", comparison.together);
    add("reference", comparison.reference_label);
    add("device_type", comparison.device.type);
    add("threads", comparison.device.threads);
    add("api", comparison.device.api);
    add("version", comparison.version);
    add("commit", comparison.commit);
}

CsvLine make_line(const Comparison& comparison, const Row& row, std::size_t mirrors) {
    CsvLine line;
    line.add_field("technique", row.technique);
    line.add_field("label", row.label);
    line.add_field("settings", format_settings(row));
    line.add_field("model", row.model);
    const measure::RankRange places = measure::find_rank_range(comparison, row);
    const bool has_place = places.first > 0;
    line.add_field("place_first", has_place ? static_cast<double>(places.first) : NAN);
    line.add_field("place_last", has_place ? static_cast<double>(places.last) : NAN);
    add_metric_fields(line, comparison, row, mirrors);
    add_view_fields(line, comparison, row);
    line.add_field("image", image_path(comparison, row.image + ".png"));
    line.add_field("on_front", measure::is_on_front(comparison, row));
    line.add_field("is_reference", row.is_reference);
    add_identity_fields(line, comparison, row);
    line.add_field("incomplete", describe_incomplete_run(comparison));
    return line;
}

/// Adds the names of the columns of a line. A column that only some lines have is inserted after
/// the column that precedes it in these lines.
void add_columns(std::vector<std::string>& columns, const CsvLine& line, CsvColumns which) {
    auto at = columns.begin();
    for (const CsvField& field : line.fields) {
        if (which == CsvColumns::table && !field.in_table) continue;
        const auto found = std::ranges::find(columns, field.name);
        at = (found != columns.end() ? found : columns.insert(at, field.name)) + 1;
    }
}

std::string join_cells(const std::vector<std::string>& cells) {
    std::vector<std::string> escaped;
    for (const std::string& cell : cells) escaped.push_back(escape_csv(cell));
    return join_texts(escaped, ",") + "\r\n";
}

std::string format_line(const CsvLine& line, const std::vector<std::string>& columns) {
    std::unordered_map<std::string, std::string> fields;
    for (const CsvField& field : line.fields) fields.emplace(field.name, field.text);
    std::vector<std::string> cells;
    for (const std::string& name : columns) cells.push_back(fields[name]);
    return join_cells(cells);
}

} // namespace

std::string to_csv(const Comparison& comparison) { return to_csv(comparison, CsvColumns::table); }

std::string to_csv(const Comparison& comparison, CsvColumns which) {
    return to_csv(std::vector{&comparison}, which);
}

std::string to_csv(const std::vector<const Comparison*>& comparisons, CsvColumns which) {
    std::size_t mirrors = 0;
    for (const Comparison* comparison : comparisons)
        for (const Row& row : comparison->rows)
            mirrors = std::max(mirrors, row.error_per_mirror.size());
    std::vector<CsvLine> lines;
    std::vector<std::string> columns;
    for (const Comparison* comparison : comparisons) {
        // An empty row gives the columns of all metrics whose values are single numbers.
        add_columns(columns, make_line(*comparison, Row{}, mirrors), which);
        for (const Row& row : comparison->rows)
            lines.push_back(make_line(*comparison, row, mirrors));
        if (comparison->complete || !comparison->rows.empty()) continue;
        lines.emplace_back(); // a CSV line with only this field
        lines.back().add_field("incomplete", describe_incomplete_run(*comparison));
    }
    for (const CsvLine& line : lines) add_columns(columns, line, which);
    std::string csv = join_cells(columns);
    for (const CsvLine& line : lines) csv += format_line(line, columns);
    return csv;
}

} // namespace catoptric::report
