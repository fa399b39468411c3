#include "measure/metric.hpp"

#include "core/error.hpp"
#include "core/table.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace catoptric::measure {

namespace {

bool is_row_metric(const Metric& quantity) {
    return std::holds_alternative<Metric::RowMetricFunction>(quantity.get) ||
           std::holds_alternative<Metric::IsMetricOfStudy>(quantity.get);
}

std::vector<Metric> list_metrics_in_order() {
    std::vector<Metric> rows = sorted_rows<Metric>();
    for (const Metric& row : rows)
        check(std::ranges::count(rows, row.name, &Metric::name) == 1, Failure::internal,
              "two metrics have the name '", row.name, "'");
    return rows;
}

/// Returns the index of a metric among those that are computed from pictures.
std::size_t picture_metric_index(const Metric& quantity) {
    std::size_t index = 0;
    for (const Metric& row : list_metrics()) {
        if (row.name == quantity.name) break;
        index += std::holds_alternative<Metric::PictureMetricFunction>(row.get);
    }
    return index;
}

constexpr RowPixelMask kRowPixelMasks[] = {
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

RegisteredMetric::RegisteredMetric(Metric quantity) {
    if (!is_row_metric(quantity)) quantity.mask = "each";
    table_rows<Metric>().push_back(std::move(quantity));
}

const std::vector<Metric>& list_metrics() {
    static const std::vector<Metric> kRows = list_metrics_in_order();
    return kRows;
}

const std::vector<Metric>& list_difference_metrics() {
    static const std::vector<Metric> kRows = [] {
        std::vector<Metric> rows = list_metrics();
        std::erase_if(rows, is_row_metric);
        return rows;
    }();
    return kRows;
}

void set_row_metric_of_study(Row& row, const std::string& metric, MetricValue value) {
    if (!row.studied) row.studied = std::make_shared<Studied>();
    row.studied->values[metric] = std::move(value);
}

MetricValue find_row_metric_of_study(const Row& row, std::string_view metric) {
    if (!row.studied) return {};
    const auto found = row.studied->values.find(metric);
    return found == row.studied->values.end() ? MetricValue() : found->second;
}

MetricValue metric_value(const Metric& quantity, const Row& row) {
    check(is_row_metric(quantity), Failure::internal, "'", quantity.name,
          "' is no figure of a row");
    if (const auto* get = std::get_if<Metric::RowMetricFunction>(&quantity.get)) return (*get)(row);
    return find_row_metric_of_study(row, quantity.name);
}

MetricValue metric_value(const Metric& quantity, const Difference& difference) {
    check(!is_row_metric(quantity), Failure::internal, "'", quantity.name,
          "' is no figure of a difference");
    if (const auto* get = std::get_if<Metric::DifferenceMetricFunction>(&quantity.get))
        return (*get)(difference);
    const std::size_t index = picture_metric_index(quantity);
    return index < difference.others.size() ? difference.others[index] : NAN;
}

bool is_metric_shown(const Metric& quantity, const Comparison& comparison) {
    return quantity.study.empty() ||
           std::ranges::find(comparison.studies, quantity.study) != comparison.studies.end();
}

bool is_missing_value(const MetricValue& value) {
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
        bool operator()(const std::vector<NamedMetricValueParts>& list) const {
            return list.empty();
        }
    };
    return std::visit(MissingValueVisitor{}, value);
}

std::vector<double> compute_picture_metrics(const PicturePair& compared) {
    std::vector<double> figures;
    for (const Metric& quantity : list_metrics())
        if (const auto* get = std::get_if<Metric::PictureMetricFunction>(&quantity.get))
            figures.push_back((*get)(compared));
    return figures;
}

std::span<const RowPixelMask> list_row_masks() { return kRowPixelMasks; }

bool has_table_columns(const RowPixelMask& mask, const Comparison& comparison) {
    return !mask.only_where_some || std::ranges::any_of(comparison.rows, [&](const Row& row) {
        return (row.*mask.error).pixels > 0;
    });
}

} // namespace catoptric::measure
