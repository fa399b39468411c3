#include "sweep_groups.hpp"

#include "report/text.hpp"
#include "sweep_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace catoptric::cli {

namespace {

double median_of_sorted(const std::vector<double>& sorted) {
    const std::size_t half = sorted.size() / 2;
    return sorted.size() % 2 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
}

} // namespace

std::vector<SweepGroup> group_results(const std::filesystem::path& folder, const SweepPlan& plan) {
    std::vector<SweepGroup> groups;
    for (const SweepPiece& piece : plan.pieces) {
        const SweepJson &scene = piece.content["scene"], &options = piece.content["options"];
        const auto known = std::ranges::find_if(groups, [&](const SweepGroup& group) {
            return group.scene == scene && group.options == options;
        });
        SweepGroup& group = known != groups.end() ? *known : groups.emplace_back();
        group.scene = scene, group.options = options;
        group.labels = piece.content["techniques"].get<std::vector<std::string>>();
        (piece.is_timing() ? group.timing_pieces : group.picture_pieces).push_back(&piece);
        (piece.is_timing() ? group.timings : group.pictures)
            .push_back(read_sweep_result(folder, piece).value());
    }
    return groups;
}

SweepSummary summarise(std::vector<double> values) {
    std::erase_if(values, [](double value) { return std::isnan(value); });
    SweepSummary summary{.count = values.size()};
    if (values.empty()) return summary;
    std::ranges::sort(values);
    summary.mean = std::accumulate(values.begin(), values.end(), 0.0) /
                   static_cast<double>(values.size());
    summary.median = median_of_sorted(values);
    summary.least = values.front();
    summary.largest = values.back();
    summary.ci95 = measure::median_confidence_interval(values);
    return summary;
}

void CsvTable::add_line(const std::vector<std::string>& fields) {
    std::vector<std::string> escaped;
    for (const std::string& field : fields) escaped.push_back(report::escape_csv_field(field));
    text_ += fmt::format("{}\r\n", fmt::join(escaped, ","));
}

std::vector<std::string> list_axis_names(const std::vector<SweepGroup>& groups) {
    std::vector<std::string> names;
    for (const auto& [name, value] : groups.front().options.items())
        if (std::ranges::any_of(groups, [&](const SweepGroup& group) {
                return group.options.value(name, SweepJson()) != value;
            }))
            names.push_back(name);
    return names;
}

std::vector<std::string> make_scene_and_axis_fields(const SweepGroup& group,
                                                    const std::vector<std::string>& axes) {
    std::vector<std::string> fields{group.scene.get<std::string>()};
    for (const std::string& axis : axes) {
        const SweepJson& value = group.options[axis];
        fields.push_back(value.is_string() ? value.get<std::string>() : value.dump());
    }
    return fields;
}

std::vector<std::string> make_header(const std::vector<std::string>& axes,
                                     std::initializer_list<const char*> names) {
    std::vector<std::string> fields{"scene"};
    for (const std::string& axis : axes) fields.push_back("option_" + axis);
    fields.insert(fields.end(), names.begin(), names.end());
    return fields;
}

} // namespace catoptric::cli
