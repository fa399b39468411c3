// rows.csv: RFC 4180, so lines end in CR LF. What is not there is empty.
#include "core/text.hpp"
#include "report/report.hpp"
#include "report/rows.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace catoptric::report {

namespace {

std::string quoted(const std::string& field) {
    std::string shown = printable(field, "\n");
    if (shown.find_first_of("\",\n") == std::string::npos) return shown;
    std::string result = "\"";
    for (const char c : shown) result += c == '"' ? "\"\"" : std::string(1, c);
    return result + "\"";
}

/// Header and rows grow together: each field comes with its name.
class Line {
public:
    void add(std::string name, const std::string& field) {
        names.push_back(std::move(name));
        fields.push_back(quoted(field));
    }
    /// The shortest text that reads back as the same number.
    void add(std::string name, double value) {
        add(std::move(name), std::isfinite(value) ? fmt::format("{}", value) : std::string());
    }
    template <std::integral Value>
    void add(std::string name, Value value) {
        add(std::move(name), fmt::format("{}", value));
    }
    std::vector<std::string> names, fields;
};

void add(Line& line, const std::string& name, const measure::Summary& summary) {
    line.add(name + "_median", summary.median);
    line.add(name + "_p05", summary.p05);
    line.add(name + "_p95", summary.p95);
    line.add(name + "_mad", summary.mad);
    line.add(name + "_n", summary.n);
}

void add(Line& line, const std::string& mask, const measure::Difference& error) {
    line.add(mask + "_pixels", error.pixels);
    line.add(mask + "_nonfinite", error.nonfinite);
    line.add(mask + "_rmse", error.rmse);
    line.add(mask + "_mae", error.mae);
    line.add(mask + "_flip", error.flip);
    line.add(mask + "_psnr", error.psnr.value_or(NAN));
    line.add(mask + "_p99", error.p99);
    line.add(mask + "_max", error.max);
    line.add(mask + "_off", error.off);
    line.add(mask + "_longest_line", error.longest_line);
}

void add(Line& line, const std::string& name, const measure::Mean& mean) {
    line.add(name + "_r", mean.rgb.x);
    line.add(name + "_g", mean.rgb.y);
    line.add(name + "_b", mean.rgb.z);
}

void add(Line& line, const std::optional<Rays>& rays) {
    const auto count = [&](std::uint64_t Rays::*kind) {
        return rays ? std::to_string((*rays).*kind) : std::string();
    };
    line.add("rays_primary", count(&Rays::primary));
    line.add("rays_mirror", count(&Rays::mirror));
    line.add("rays_shadow", count(&Rays::shadow));
}

/// `mirrors` columns of single mirrors, whatever the row has.
Line line_of(const Comparison& comparison, const Row& row, std::size_t mirrors) {
    Line line;
    line.add("technique", row.technique);
    line.add("label", row.label);
    line.add("settings", settings_text(row));
    line.add("model", row.model);
    line.add("scene_passes", row.scene_passes);
    line.add("scene_draws", row.scene_draws);
    add(line, "gpu_ms", row.gpu_ms);
    add(line, "cpu_record_ms", row.cpu_record_ms);
    add(line, "wall_ms", row.wall_ms);
    add(line, "mirrors", row.error);
    add(line, "first_order", row.error_first_order);
    add(line, "mirror_in_mirror", row.error_mirror_in_mirror);
    add(line, "non_mirror", row.error_non_mirror);
    add(line, "all", row.error_all);
    for (std::size_t i = 0; i < mirrors; ++i)
        add(line, "mirror_" + std::to_string(i + 1),
            i < row.error_per_mirror.size() ? row.error_per_mirror[i] : measure::Difference{});
    line.add("memory_bytes", row.memory_bytes);
    line.add("traced_fraction", row.traced_fraction.value_or(NAN));
    add(line, row.rays);
    add(line, "mean", row.mean);
    add(line, "mean_clamped", row.mean_clamped);
    line.add("image", "images/" + row.image + ".png");
    line.add("on_front", int{on_front(comparison, row)});
    line.add("failed", int{failed(row)});
    line.add("is_reference", int{row.is_reference});
    line.add("incomplete", incomplete_text(comparison));
    return line;
}

} // namespace

std::string to_csv(const Comparison& comparison) {
    std::size_t mirrors = 0;
    for (const Row& row : comparison.rows) mirrors = std::max(mirrors, row.error_per_mirror.size());
    std::string csv = joined(line_of(comparison, Row{}, mirrors).names, ",") + "\r\n";
    for (const Row& row : comparison.rows)
        csv += joined(line_of(comparison, row, mirrors).fields, ",") + "\r\n";
    if (!comparison.complete && comparison.rows.empty()) { // a line that says nothing else
        Line line = line_of(comparison, Row{}, mirrors);
        std::fill(line.fields.begin(), line.fields.end() - 1, "");
        csv += joined(line.fields, ",") + "\r\n";
    }
    return csv;
}

} // namespace catoptric::report
