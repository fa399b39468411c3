// rows.csv: RFC 4180, so lines end in CR LF. What is not there is empty.
#include "core/mirror_id.hpp"
#include "core/text.hpp"
#include "measure/judge.hpp"
#include "measure/quantity.hpp"
#include "measure/views.hpp"
#include "report/report.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace catoptric::report {

namespace {

std::string csv_field(const std::string& field) {
    std::string shown = printable(field, "\n");
    if (shown.find_first_of("\",\n") == std::string::npos) return shown;
    std::string result = "\"";
    for (const char c : shown) result += c == '"' ? "\"\"" : std::string(1, c);
    return result + "\"";
}

/// The shortest text that reads back as the same number.
std::string text_of(double value) {
    return std::isfinite(value) ? fmt::format("{}", value) : std::string();
}

/// A row's fields, each with its column's name.
class Line {
public:
    void add(std::string name, std::string field) {
        fields.emplace_back(std::move(name), std::move(field));
    }
    void add(std::string name, double value) { add(std::move(name), text_of(value)); }
    template <std::integral Number>
    void add(std::string name, Number value) {
        add(std::move(name), fmt::format("{}", value));
    }
    void add(const std::string& name, const measure::Value& value);

    std::vector<std::pair<std::string, std::string>> fields;
};

/// A list of numbers is one field with spaces between them.
std::string list_text(const std::vector<double>& list) {
    std::vector<std::string> texts;
    for (const double value : list) texts.push_back(text_of(value));
    return joined(texts, " ");
}

/// A value's fields: what has parts has a column for each.
struct Adds {
    Line& line;
    const std::string& name;

    void operator()(std::monostate) const { line.add(name, std::string()); }
    void operator()(bool mark) const { line.add(name, int{mark}); }
    void operator()(double value) const { line.add(name, value); }
    void operator()(const dvec3& colour) const {
        line.add(name + "_r", colour.x);
        line.add(name + "_g", colour.y);
        line.add(name + "_b", colour.z);
    }
    void operator()(const measure::Place& place) const {
        const auto text = [&](int value) { return place.x < 0 ? "" : std::to_string(value); };
        line.add(name + "_x", text(place.x));
        line.add(name + "_y", text(place.y));
    }
    void operator()(const measure::Summary& times) const {
        line.add(name + "_median", times.median);
        line.add(name + "_p05", times.p05);
        line.add(name + "_p95", times.p95);
        line.add(name + "_mad", times.mad);
        line.add(name + "_n", times.n);
        line.add(name + "_ci95_low", times.ci95.low);
        line.add(name + "_ci95_high", times.ci95.high);
        line.add(name + "_rounds", list_text(times.rounds));
        line.add(name + "_samples", list_text(times.samples));
    }
    void operator()(const std::vector<double>& list) const { line.add(name, list_text(list)); }
    void operator()(const std::vector<measure::Parts>& list) const {
        for (const measure::Parts& parts : list)
            for (const auto& [what, value] : parts.values)
                line.add(name + "_" + parts.name + "_" + std::string(what), value);
    }
};

void Line::add(const std::string& name, const measure::Value& value) {
    std::visit(Adds{*this, name}, value);
}

void add(Line& line, const std::string& mask, const measure::Difference& error) {
    for (const measure::Quantity& quantity : measure::difference_quantities())
        line.add(mask + "_" + std::string(quantity.name), measure::value_of(quantity, error));
}

/// `mirrors` columns of single mirrors, whatever the row has.
void add_errors(Line& line, const Row& row, std::size_t mirrors) {
    for (const measure::RowMask& mask : measure::masks())
        add(line, std::string(mask.name), row.*mask.error);
    for (std::size_t i = 0; i < mirrors; ++i)
        add(line, "mirror_" + std::to_string(MirrorId::at(i).number()),
            i < row.error_per_mirror.size() ? row.error_per_mirror[i] : measure::Difference{});
}

void add_figures(Line& line, const Row& row, std::size_t mirrors) {
    bool has_errors = false;
    for (const measure::Quantity& quantity : measure::quantities()) {
        if (quantity.mask != "each") {
            std::string name(quantity.name);
            std::ranges::replace(name, '/', '_');
            line.add(name, measure::value_of(quantity, row));
        } else if (!std::exchange(has_errors, true)) {
            add_errors(line, row, mirrors);
        }
    }
}

/// Errors over the mirrors, over the drawn views; no columns where none were drawn.
void add_views(Line& line, const Comparison& comparison, const Row& row) {
    if (comparison.views.empty()) return;
    for (const measure::Quantity& quantity : measure::difference_quantities()) {
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

void add_point(Line& line, const std::string& name, const dvec3& point) {
    line.add(name + "_x", point.x);
    line.add(name + "_y", point.y);
    line.add(name + "_z", point.z);
}

/// What tells this run's rows from those of others.
void add_identity(Line& line, const Comparison& comparison, const Row& row) {
    line.add("plan", row.label);
    line.add("scene", comparison.scene.name);
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
    line.add("device", comparison.device.name);
    line.add("device_type", comparison.device.type);
    line.add("threads", comparison.device.threads);
    line.add("driver", comparison.device.driver);
    line.add("api", comparison.device.api);
    line.add("version", comparison.version);
    line.add("commit", comparison.commit);
}

Line line_of(const Comparison& comparison, const Row& row, std::size_t mirrors) {
    Line line;
    line.add("technique", row.technique);
    line.add("label", row.label);
    line.add("settings", settings_text(row));
    line.add("model", row.model);
    add_figures(line, row, mirrors);
    add_views(line, comparison, row);
    line.add("image", image_path(comparison, row.image + ".png"));
    line.add("on_front", int{measure::on_front(comparison, row)});
    line.add("is_reference", int{row.is_reference});
    add_identity(line, comparison, row);
    line.add("incomplete", incomplete_text(comparison));
    return line;
}

/// Columns in the order of the lines' fields: one that only some lines have stands behind the one
/// that it stands behind there.
class Columns {
public:
    void add(const Line& line) {
        std::size_t at = 0;
        for (const auto& [name, field] : line.fields) {
            const auto found = std::ranges::find(names_, name);
            if (found != names_.end())
                at = static_cast<std::size_t>(found - names_.begin()) + 1;
            else
                names_.insert(names_.begin() + static_cast<std::ptrdiff_t>(at++), name);
        }
    }
    std::string header() const {
        std::vector<std::string> cells;
        for (const std::string& name : names_) cells.push_back(csv_field(name));
        return joined(cells, ",") + "\r\n";
    }
    std::string text_of(const Line& line) const {
        std::unordered_map<std::string, std::string> fields(line.fields.begin(), line.fields.end());
        std::vector<std::string> cells;
        for (const std::string& name : names_) cells.push_back(csv_field(fields[name]));
        return joined(cells, ",") + "\r\n";
    }

private:
    std::vector<std::string> names_;
};

} // namespace

std::string to_csv(const Comparison& comparison) { return to_csv(std::vector{&comparison}); }

std::string to_csv(const std::vector<const Comparison*>& comparisons) {
    std::size_t mirrors = 0;
    for (const Comparison* comparison : comparisons)
        for (const Row& row : comparison->rows)
            mirrors = std::max(mirrors, row.error_per_mirror.size());
    std::vector<Line> lines;
    Columns columns;
    for (const Comparison* comparison : comparisons) {
        columns.add(line_of(*comparison, Row{}, mirrors)); // every column without parts
        for (const Row& row : comparison->rows) lines.push_back(line_of(*comparison, row, mirrors));
        if (comparison->complete || !comparison->rows.empty()) continue;
        lines.emplace_back(); // one that says nothing else
        lines.back().add("incomplete", incomplete_text(*comparison));
    }
    for (const Line& line : lines) columns.add(line);
    std::string csv = columns.header();
    for (const Line& line : lines) csv += columns.text_of(line);
    return csv;
}

} // namespace catoptric::report
