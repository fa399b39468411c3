// Writes rows.csv by RFC 4180, so lines end in CR LF. A missing value is an empty field.
#include "core/mirror_id.hpp"
#include "core/text.hpp"
#include "measure/judge.hpp"
#include "measure/metric.hpp"
#include "measure/views.hpp"
#include "report/report.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace catoptric::report {

namespace {

/// Returns whether a cell is a formula. Spreadsheet programs execute a cell that begins with one of
/// these characters. Numbers may begin with them.
bool is_formula(const std::string& text) {
    constexpr std::string_view kNumbers = "0123456789.eE+- ";
    return text.find_first_of("=+-@") == 0 && text.find_first_not_of(kNumbers) != text.npos;
}

/// Returns a cell with escaped text from any source. All text enters the table through this
/// function.
std::string csv_field(const std::string& field) {
    std::string shown = printable(field, "\n");
    if (is_formula(shown)) shown.insert(0, "'");
    if (shown.find_first_of("\",\n") == std::string::npos) return shown;
    std::string result = "\"";
    for (const char c : shown) result += c == '"' ? "\"\"" : std::string(1, c);
    return result + "\"";
}

/// Returns the shortest text that reads back as the same number.
std::string text_of(double value) {
    return std::isfinite(value) ? fmt::format("{}", value) : std::string();
}

/// Field of a row and the name of its column.
struct Field {
    std::string name, text;
    bool in_table = true; ///< whether CsvColumns::table has the column, too
};

/// The fields of a row.
class CsvLine {
public:
    void add(std::string name, std::string text) {
        fields.push_back({std::move(name), std::move(text), in_table});
    }
    void add(std::string name, double value) { add(std::move(name), text_of(value)); }
    template <std::integral Number>
    void add(std::string name, Number value) {
        add(std::move(name), fmt::format("{}", value));
    }
    void add(const std::string& name, const measure::Value& value);

    std::vector<Field> fields;
    bool in_table = true; ///< value of Field::in_table for the fields that are added next
};

/// Sets CsvLine::in_table until the end of a block. Inside a block that is left out, fields stay
/// left out.
class InTable {
public:
    InTable(CsvLine& line, bool shown) : line_(line), before_(line.in_table) {
        line.in_table = before_ && shown;
    }
    ~InTable() { line_.in_table = before_; }
    InTable(const InTable&) = delete;
    InTable& operator=(const InTable&) = delete;

private:
    CsvLine& line_;
    bool before_;
};

/// Returns a list of numbers as one field, separated by spaces.
std::string list_text(const std::vector<double>& list) {
    std::vector<std::string> texts;
    for (const double value : list) texts.push_back(text_of(value));
    return joined(texts, " ");
}

/// Adds the fields of a value: one column for each of its parts.
struct Adds {
    CsvLine& line;
    const std::string& name;

    void operator()(std::monostate) const { line.add(name, std::string()); }
    void operator()(bool mark) const { line.add(name, int{mark}); }
    void operator()(double value) const { line.add(name, value); }
    void operator()(const dvec3& colour) const {
        line.add(name + "_r", colour.x);
        line.add(name + "_g", colour.y);
        line.add(name + "_b", colour.z);
    }
    void operator()(const measure::PixelPosition& place) const {
        const auto text = [&](int value) { return place.x < 0 ? "" : std::to_string(value); };
        line.add(name + "_x", text(place.x));
        line.add(name + "_y", text(place.y));
    }
    void operator()(const measure::Summary& times) const {
        line.add(name + "_median", times.median);
        line.add(name + "_ci95_low", times.ci95.low);
        line.add(name + "_ci95_high", times.ci95.high);
        const InTable more(line, false);
        line.add(name + "_p05", times.p05);
        line.add(name + "_p95", times.p95);
        line.add(name + "_mad", times.mad);
        line.add(name + "_n", times.n);
        line.add(name + "_rounds", list_text(times.rounds));
        line.add(name + "_samples", list_text(times.samples));
    }
    void operator()(const std::vector<double>& list) const { line.add(name, list_text(list)); }
    void operator()(const std::vector<measure::Parts>& list) const {
        const InTable more(line, false);
        for (const measure::Parts& parts : list)
            for (const auto& [what, value] : parts.values)
                line.add(name + "_" + parts.name + "_" + std::string(what), value);
    }
};

void CsvLine::add(const std::string& name, const measure::Value& value) {
    std::visit(Adds{*this, name}, value);
}

/// Returns whether the report's table of rows has a column of this metric.
bool is_in_rows_table(const measure::Metric& quantity) {
    return std::ranges::any_of(quantity.columns, [](const measure::MetricColumn& column) {
        return column.table == measure::MetricTable::rows;
    });
}

/// Adds the metrics of a difference over one mask. `is_main` is true for the mask of which the
/// table shows all metrics of differences.
void add(CsvLine& line, const std::string& mask, const measure::Difference& error, bool is_main) {
    for (const measure::Metric& quantity : measure::difference_metrics()) {
        const InTable shown(line,
                            is_in_rows_table(quantity) && (is_main || quantity.each_mask_in_table));
        line.add(mask + "_" + std::string(quantity.name), measure::value_of(quantity, error));
    }
}

/// Adds the errors over all masks and over single mirrors. Each line has columns of `mirrors`
/// mirrors, even if its row has fewer.
void add_errors(CsvLine& line, const Comparison& comparison, const Row& row, std::size_t mirrors) {
    for (const measure::RowMask& mask : measure::masks())
        if (measure::has_columns(mask, comparison))
            add(line, std::string(mask.name), row.*mask.error, mask.title.empty());
    const InTable more(line, false);
    for (std::size_t i = 0; i < mirrors; ++i)
        add(line, "mirror_" + std::to_string(MirrorId::at(i).number()),
            i < row.error_per_mirror.size() ? row.error_per_mirror[i] : measure::Difference{},
            false);
}

void add_figures(CsvLine& line, const Comparison& comparison, const Row& row, std::size_t mirrors) {
    bool has_errors = false;
    for (const measure::Metric& quantity : measure::metrics()) {
        if (quantity.mask != "each") {
            std::string name(quantity.name);
            std::ranges::replace(name, '/', '_');
            const InTable shown(line, is_in_rows_table(quantity));
            line.add(name, measure::value_of(quantity, row));
        } else if (!std::exchange(has_errors, true)) {
            add_errors(line, comparison, row, mirrors);
        }
    }
}

/// Adds the errors over the mirrors in the drawn views. Adds no columns if no views were drawn.
void add_views(CsvLine& line, const Comparison& comparison, const Row& row) {
    if (comparison.views.empty()) return;
    for (const measure::Metric& quantity : measure::difference_metrics()) {
        if (!measure::is_number(quantity)) continue;
        const measure::OverViews over = measure::over_views(row, measure::masks().front(),
                                                            quantity);
        const std::string name = "views_" + std::string(quantity.name);
        line.add(name + "_median", over.median);
        line.add(name + "_low", over.ci95.low);
        line.add(name + "_high", over.ci95.high);
    }
    line.add("views", row.views.size());
    const measure::View* worst = row.worst ? &comparison.views.at(row.worst->view) : nullptr;
    line.add("worst_view", worst ? std::to_string(row.worst->view) : "");
    line.add("worst_view_camera", worst ? worst->camera.name : "");
    line.add("worst_view_time", worst ? worst->time : NAN);
}

void add_point(CsvLine& line, const std::string& name, const dvec3& point) {
    line.add(name + "_x", point.x);
    line.add(name + "_y", point.y);
    line.add(name + "_z", point.z);
}

/// Adds the fields that distinguish the rows of this run from those of other runs.
void add_identity(CsvLine& line, const Comparison& comparison, const Row& row) {
    line.add("scene", comparison.scene.name);
    line.add("device", comparison.device.name);
    line.add("driver", comparison.device.driver);
    line.add("date", comparison.date);
    const InTable more(line, false);
    line.add("plan", row.label);
    line.add("scene_hash", comparison.scene.hash);
    line.add("scene_triangles", comparison.scene.triangles);
    line.add("scene_mirrors", comparison.scene.mirrors);
    const measure::CameraFacts& camera = comparison.scene.camera;
    line.add("camera", camera.name);
    add_point(line, "camera_eye", camera.eye);
    add_point(line, "camera_target", camera.target);
    add_point(line, "camera_up", camera.up);
    line.add("camera_vertical_fov_degrees", camera.vertical_fov_degrees);
    line.add("time", comparison.time);
    line.add("width", comparison.width);
    line.add("height", comparison.height);
    line.add("ambient", comparison.ambient);
    line.add("exposure", comparison.exposure);
    line.add("frames", comparison.frames);
    line.add("warmup", comparison.warmup);
    line.add("rounds", comparison.rounds);
    line.add("load_start", comparison.load_start);
    line.add("load_end", comparison.load_end);
    line.add("timing", comparison.timing);
    line.add("together", int{comparison.together});
    line.add("reference", comparison.reference_label);
    line.add("device_type", comparison.device.type);
    line.add("threads", comparison.device.threads);
    line.add("api", comparison.device.api);
    line.add("version", comparison.version);
    line.add("commit", comparison.commit);
}

CsvLine line_of(const Comparison& comparison, const Row& row, std::size_t mirrors) {
    CsvLine line;
    line.add("technique", row.technique);
    line.add("label", row.label);
    line.add("settings", settings_text(row));
    line.add("model", row.model);
    const measure::PlaceRange places = measure::places_in_time(comparison, row);
    line.add("place_first", places.first);
    line.add("place_last", places.last);
    add_figures(line, comparison, row, mirrors);
    add_views(line, comparison, row);
    line.add("image", image_path(comparison, row.image + ".png"));
    line.add("on_front", int{measure::on_front(comparison, row)});
    line.add("is_reference", int{row.is_reference});
    add_identity(line, comparison, row);
    line.add("incomplete", incomplete_text(comparison));
    return line;
}

/// Ordered columns of all lines. A column that only some lines have comes after the column that
/// precedes it there.
class Columns {
public:
    explicit Columns(CsvColumns which) : which_(which) {}
    void add(const CsvLine& line) {
        std::size_t at = 0;
        for (const Field& field : line.fields) {
            if (which_ == CsvColumns::table && !field.in_table) continue;
            const auto found = std::ranges::find(names_, field.name);
            if (found != names_.end())
                at = static_cast<std::size_t>(found - names_.begin()) + 1;
            else
                names_.insert(names_.begin() + static_cast<std::ptrdiff_t>(at++), field.name);
        }
    }
    std::string header() const {
        std::vector<std::string> cells;
        for (const std::string& name : names_) cells.push_back(csv_field(name));
        return joined(cells, ",") + "\r\n";
    }
    std::string text_of(const CsvLine& line) const {
        std::unordered_map<std::string, std::string> fields;
        for (const Field& field : line.fields) fields.emplace(field.name, field.text);
        std::vector<std::string> cells;
        for (const std::string& name : names_) cells.push_back(csv_field(fields[name]));
        return joined(cells, ",") + "\r\n";
    }

private:
    CsvColumns which_;
    std::vector<std::string> names_;
};

} // namespace

std::string to_csv(const Comparison& comparison, CsvColumns which) {
    return to_csv(std::vector{&comparison}, which);
}

std::string to_csv(const std::vector<const Comparison*>& comparisons, CsvColumns which) {
    std::size_t mirrors = 0;
    for (const Comparison* comparison : comparisons)
        for (const Row& row : comparison->rows)
            mirrors = std::max(mirrors, row.error_per_mirror.size());
    std::vector<CsvLine> lines;
    Columns columns(which);
    for (const Comparison* comparison : comparisons) {
        // An empty row gives all columns of values without parts.
        columns.add(line_of(*comparison, Row{}, mirrors));
        for (const Row& row : comparison->rows) lines.push_back(line_of(*comparison, row, mirrors));
        if (comparison->complete || !comparison->rows.empty()) continue;
        lines.emplace_back(); // a line with only this field
        lines.back().add("incomplete", incomplete_text(*comparison));
    }
    for (const CsvLine& line : lines) columns.add(line);
    std::string csv = columns.header();
    for (const CsvLine& line : lines) csv += columns.text_of(line);
    return csv;
}

} // namespace catoptric::report
