#include "measure/work.hpp"

#include <array>
#include <string>

namespace catoptric::measure {

namespace {

/// Returns "work/" and the name of each kind. Metrics refer to these texts.
const std::array<std::string, kWorkKindCount>& work_metric_names() {
    static const std::array<std::string, kWorkKindCount> kWorkMetricNames = [] {
        std::array<std::string, kWorkKindCount> names;
        for (std::size_t i = 0; i < kWorkKindCount; ++i)
            names[i] = "work/" + std::string(kWorkKinds[i].name);
        return names;
    }();
    return kWorkMetricNames;
}

MetricValue count_value(const std::optional<std::uint64_t>& count) {
    return count ? MetricValue(static_cast<double>(*count)) : MetricValue();
}

} // namespace

std::vector<Metric> work_metrics() {
    std::vector<Metric> metrics;
    for (std::size_t i = 0; i < kWorkKindCount; ++i)
        metrics.push_back({.name = work_metric_names()[i],
                           .help = kWorkKinds[i].help,
                           .better = BetterDirection::less,
                           .order = 700 + static_cast<int>(i),
                           .get = Metric::FromStudy{}});
    metrics.push_back({.name = kWorkByPassName,
                       .help = "the same counts for each pass of the frame",
                       .order = 700 + static_cast<int>(kWorkKindCount),
                       .get = Metric::FromStudy{}});
    return metrics;
}

void set_work(Row& row, const std::vector<PassWork>& passes) {
    const WorkCounts sum = sum_work(passes);
    for (std::size_t i = 0; i < kWorkKindCount; ++i)
        set_study_metric(row, work_metric_names()[i], count_value(sum.values[i]));
    std::vector<MetricParts> list;
    for (const PassWork& pass : passes) {
        list.push_back({"pass", pass.name, {}});
        for (std::size_t i = 0; i < kWorkKindCount; ++i)
            if (pass.counts.values[i].value_or(0) > 0)
                list.back().values.emplace_back(kWorkKinds[i].name,
                                                count_value(pass.counts.values[i]));
    }
    set_study_metric(row, kWorkByPassName, std::move(list));
}

WorkCounts total_work(const Row& row) {
    WorkCounts counts;
    for (std::size_t i = 0; i < kWorkKindCount; ++i) {
        const MetricValue value = study_metric(row, work_metric_names()[i]);
        if (const double* number = std::get_if<double>(&value))
            counts.values[i] = static_cast<std::uint64_t>(*number);
    }
    return counts;
}

bool has_counted_work(const Row& row) {
    return !is_missing(study_metric(row, "work/" + std::string(kWorkKinds[0].name)));
}

} // namespace catoptric::measure
