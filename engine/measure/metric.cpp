#include "measure/metric.hpp"

#include "core/error.hpp"
#include "core/table.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace catoptric::measure {

namespace {

bool is_row_metric(const Metric& metric) {
    return std::holds_alternative<Metric::RowMetricFunction>(metric.get) ||
           std::holds_alternative<Metric::FromStudy>(metric.get);
}

std::vector<Metric> sorted_metrics() {
    std::vector<Metric> rows = sorted_rows<Metric>();
    for (const Metric& row : rows)
        check(std::ranges::count(rows, row.name, &Metric::name) == 1, Failure::internal,
              "two metrics have the name '", row.name, "'");
    return rows;
}

/// Returns the index of a metric among those that are computed from pictures.
std::size_t picture_metric_index(const Metric& metric) {
    std::size_t index = 0;
    for (const Metric& row : metrics()) {
        if (row.name == metric.name) break;
        index += std::holds_alternative<Metric::PictureMetricFunction>(row.get);
    }
    return index;
}

constexpr RowMask kRowMasks[] = {
    {"error", "mirrors", "", &Errors::error},
    {"error_first_order", "first_order", "first order", &Errors::error_first_order},
    {"error_mirror_in_mirror", "mirror_in_mirror", "mirror in mirror",
     &Errors::error_mirror_in_mirror},
    {"error_non_mirror", "non_mirror", "not a mirror", &Errors::error_non_mirror},
    {"error_all", "all", "all", &Errors::error_all},
    {"error_dielectrics", "dielectrics", "smooth dielectrics", &Errors::error_dielectrics, true},
    {"error_rough", "rough", "rough surfaces", &Errors::error_rough, true},
};

} // namespace

RegisteredMetric::RegisteredMetric(Metric metric) {
    if (!is_row_metric(metric)) metric.mask = "each";
    table_rows<Metric>().push_back(std::move(metric));
}

const std::vector<Metric>& metrics() {
    static const std::vector<Metric> kRows = sorted_metrics();
    return kRows;
}

const std::vector<Metric>& difference_metrics() {
    static const std::vector<Metric> kRows = [] {
        std::vector<Metric> rows = metrics();
        std::erase_if(rows, is_row_metric);
        return rows;
    }();
    return kRows;
}

void set_study_metric(Row& row, const std::string& metric, MetricValue value) {
    if (!row.studied) row.studied = std::make_shared<Studied>();
    row.studied->values[metric] = std::move(value);
}

MetricValue study_metric(const Row& row, std::string_view metric) {
    if (!row.studied) return {};
    const auto found = row.studied->values.find(metric);
    return found == row.studied->values.end() ? MetricValue() : found->second;
}

MetricValue metric_value(const Metric& metric, const Row& row) {
    check(is_row_metric(metric), Failure::internal, "'", metric.name, "' is no figure of a row");
    if (const auto* get = std::get_if<Metric::RowMetricFunction>(&metric.get)) return (*get)(row);
    return study_metric(row, metric.name);
}

MetricValue metric_value(const Metric& metric, const Difference& difference) {
    check(!is_row_metric(metric), Failure::internal, "'", metric.name,
          "' is no figure of a difference");
    if (const auto* get = std::get_if<Metric::DifferenceFunction>(&metric.get))
        return (*get)(difference);
    const std::size_t index = picture_metric_index(metric);
    return index < difference.others.size() ? difference.others[index] : NAN;
}

bool is_shown(const Metric& metric, const Comparison& comparison) {
    return metric.study.empty() ||
           std::ranges::find(comparison.studies, metric.study) != comparison.studies.end();
}

bool is_missing(const MetricValue& value) {
    struct MissingValueVisitor {
        bool operator()(std::monostate) const { return true; }
        bool operator()(bool) const { return false; }
        bool operator()(double number) const { return !std::isfinite(number); }
        bool operator()(const dvec3& colour) const {
            return !std::isfinite(colour.x + colour.y + colour.z);
        }
        bool operator()(const PixelPosition& place) const { return place.x < 0; }
        bool operator()(const SampleSummary& times) const { return times.n == 0; }
        bool operator()(const std::vector<double>& list) const { return list.empty(); }
        bool operator()(const std::vector<MetricParts>& list) const { return list.empty(); }
    };
    return std::visit(MissingValueVisitor{}, value);
}

std::vector<double> picture_metrics(const PicturePair& compared) {
    std::vector<double> figures;
    for (const Metric& metric : metrics())
        if (const auto* get = std::get_if<Metric::PictureMetricFunction>(&metric.get))
            figures.push_back((*get)(compared));
    return figures;
}

std::span<const RowMask> row_masks() { return kRowMasks; }

bool has_table_columns(const RowMask& mask, const Comparison& comparison) {
    return !mask.only_where_some || std::ranges::any_of(comparison.rows, [&](const Row& row) {
        return (row.*mask.error).pixels > 0;
    });
}

} // namespace catoptric::measure
