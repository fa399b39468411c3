#include "sweep_groups.hpp"

#include "report/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

namespace catoptric::cli {

namespace {

double median_of_sorted(const std::vector<double>& sorted) {
    const std::size_t half = sorted.size() / 2;
    return sorted.size() % 2 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
}

/// Returns the instant of a piece's view, seconds; 0 for a piece without a view.
double find_instant(const SweepPiece& piece) {
    const SweepJson& view = piece.content["view"];
    return view.is_null() ? 0.0 : view["time"].get<double>();
}

/// Returns the mean of the values over the views of each instant. Views of one instant resemble
/// each other, so they count as one sample.
std::vector<double> average_instants(const SweepGroup& group, const std::vector<double>& values) {
    std::map<double, std::vector<double>> instants;
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!std::isnan(values[i]))
            instants[find_instant(*group.picture_pieces[i])].push_back(values[i]);
    std::vector<double> means;
    for (const auto& [instant, list] : instants)
        means.push_back(std::accumulate(list.begin(), list.end(), 0.0) /
                        static_cast<double>(list.size()));
    return means;
}

} // namespace

std::vector<SweepGroup> read_groups(const std::filesystem::path& folder, const SweepPlan& plan) {
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
            .push_back(read_result(folder, piece).value());
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
    summary.ci95 = measure::median_interval(values);
    return summary;
}

std::vector<double> metric_values(const SweepGroup& group, std::size_t row,
                                  const std::string& metric) {
    std::vector<double> values;
    for (const SweepJson& result : group.pictures) {
        const SweepJson value = result["rows"].at(row).at("error").value(metric, SweepJson());
        values.push_back(value.is_number() ? value.get<double>() : NAN);
    }
    return values;
}

std::size_t count_instants(const SweepGroup& group) {
    std::set<double> instants;
    for (const SweepPiece* piece : group.picture_pieces) instants.insert(find_instant(*piece));
    return instants.size();
}

bool has_dependent_views(const SweepGroup& group) {
    const std::size_t instants = count_instants(group);
    return instants > 1 && instants < group.pictures.size();
}

SweepSummary summarise_metric(const SweepGroup& group, const std::vector<double>& values) {
    SweepSummary summary = summarise(values);
    if (has_dependent_views(group))
        summary.ci95 = measure::median_interval(average_instants(group, values));
    return summary;
}

void CsvTable::add_line(const std::vector<std::string>& fields) {
    std::vector<std::string> escaped;
    for (const std::string& field : fields) escaped.push_back(report::escape_csv(field));
    text_ += fmt::format("{}\r\n", fmt::join(escaped, ","));
}

std::vector<std::string> axis_names(const std::vector<SweepGroup>& groups) {
    std::vector<std::string> names;
    for (const auto& [name, value] : groups.front().options.items())
        if (std::ranges::any_of(groups, [&](const SweepGroup& group) {
                return group.options.value(name, SweepJson()) != value;
            }))
            names.push_back(name);
    return names;
}

std::vector<std::string> group_fields(const SweepGroup& group,
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
