#include "measure/work.hpp"

#include <array>
#include <string>

namespace catoptric::measure {

namespace {

/// Returns "work/" and the name of each kind. Metrics refer to these texts.
const std::array<std::string, kWorkKindCount>& list_work_metric_names() {
    static const std::array<std::string, kWorkKindCount> kWorkMetricNames = [] {
        std::array<std::string, kWorkKindCount> names;
        for (std::size_t i = 0; i < kWorkKindCount; ++i)
            names[i] = "work/" + std::string(kWorkKinds[i].name);
        return names;
    }();
    return kWorkMetricNames;
}

MetricValue count_to_metric_value(const std::optional<std::uint64_t>& count) {
    return count ? MetricValue(static_cast<double>(*count)) : MetricValue();
}

} // namespace

std::vector<Metric> list_work_metrics() {
    std::vector<Metric> metrics;
    for (std::size_t i = 0; i < kWorkKindCount; ++i)
        metrics.push_back({.name = list_work_metric_names()[i],
                           .help = kWorkKinds[i].help,
                           .better = BetterDirection::less,
                           .order = 700 + static_cast<int>(i),
                           .get = Metric::IsMetricOfStudy{}});
    metrics.push_back({.name = kWorkByPassMetricName,
                       .help = "the same counts for each pass of the frame",
                       .order = 700 + static_cast<int>(kWorkKindCount),
                       .get = Metric::IsMetricOfStudy{}});
    return metrics;
}

void set_row_work(Row& row, const std::vector<PassWork>& passes) {
    const WorkCounts sum = sum_work(passes);
    for (std::size_t i = 0; i < kWorkKindCount; ++i)
        set_row_metric_of_study(row, list_work_metric_names()[i],
                                count_to_metric_value(sum.values[i]));
    std::vector<NamedMetricValueParts> list;
    for (const PassWork& pass : passes) {
        list.push_back({"pass", pass.name, {}});
        for (std::size_t i = 0; i < kWorkKindCount; ++i)
            if (pass.counts.values[i].value_or(0) > 0)
                list.back().values.emplace_back(kWorkKinds[i].name,
                                                count_to_metric_value(pass.counts.values[i]));
    }
    set_row_metric_of_study(row, kWorkByPassMetricName, std::move(list));
}

WorkCounts total_work_counts_of_row(const Row& row) {
    WorkCounts counts;
    for (std::size_t i = 0; i < kWorkKindCount; ++i) {
        const MetricValue value = find_row_metric_of_study(row, list_work_metric_names()[i]);
        if (const double* number = std::get_if<double>(&value))
            counts.values[i] = static_cast<std::uint64_t>(*number);
    }
    return counts;
}

bool has_counted_work(const Row& row) {
    return !is_missing_value(
        find_row_metric_of_study(row, "work/" + std::string(kWorkKinds[0].name)));
}

} // namespace catoptric::measure
