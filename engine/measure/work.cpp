#include "measure/work.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace catoptric::measure {

namespace {

/// Returns "work/" and the name of each kind. Metrics refer to these texts.
const std::array<std::string, kWorkKindCount>& list_metric_names() {
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
        metrics.push_back({.name = list_metric_names()[i],
                           .help = kWorkKinds[i].help,
                           .better = BetterDirection::less,
                           .order = 700 + static_cast<int>(i),
                           .get = Metric::IsStudyMetric{}});
    metrics.push_back({.name = kWorkByPassMetric,
                       .help = "the same counts for each pass of the frame",
                       .order = 700 + static_cast<int>(kWorkKindCount),
                       .get = Metric::IsStudyMetric{}});
    return metrics;
}

void set_row_work(Row& row, const std::vector<PassWork>& passes) {
    const WorkCounts sum = sum_work_of_passes(passes);
    for (std::size_t i = 0; i < kWorkKindCount; ++i)
        set_study_metric(row, list_metric_names()[i], count_to_metric_value(sum.values[i]));
    std::vector<MetricValueParts> list;
    for (const PassWork& pass : passes) {
        list.push_back({"pass", pass.name, {}});
        for (std::size_t i = 0; i < kWorkKindCount; ++i)
            if (pass.counts.values[i].value_or(0) > 0)
                list.back().values.emplace_back(kWorkKinds[i].name,
                                                count_to_metric_value(pass.counts.values[i]));
    }
    set_study_metric(row, kWorkByPassMetric, std::move(list));
}

WorkCounts total_work_of_row(const Row& row) {
    WorkCounts counts;
    for (std::size_t i = 0; i < kWorkKindCount; ++i) {
        const MetricValue value = find_study_metric(row, list_metric_names()[i]);
        if (const double* number = std::get_if<double>(&value))
            counts.values[i] = static_cast<std::uint64_t>(*number);
    }
    return counts;
}

bool has_counted_work(const Row& row) {
    return !is_missing_value(find_study_metric(row, "work/" + std::string(kWorkKinds[0].name)));
}

} // namespace catoptric::measure
