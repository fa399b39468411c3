#include "measure/metric.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace catoptric::measure {

namespace {

std::vector<Metric>& table() {
    static std::vector<Metric> rows; // filled while the program starts
    return rows;
}

bool is_of_row(const Metric& quantity) {
    return std::holds_alternative<Metric::RowFunction>(quantity.get) ||
           std::holds_alternative<Metric::OfStudy>(quantity.get);
}

std::vector<Metric> in_order() {
    std::vector<Metric> rows = table();
    std::ranges::sort(rows, {}, [](const Metric& row) { return std::pair(row.order, row.name); });
    for (const Metric& row : rows)
        check(std::ranges::count(rows, row.name, &Metric::name) == 1, Failure::internal,
              "the quantity '", row.name, "' is there twice");
    return rows;
}

/// Returns the index of a metric among those that are computed from pictures.
std::size_t index_of(const Metric& quantity) {
    std::size_t index = 0;
    for (const Metric& row : metrics()) {
        if (row.name == quantity.name) break;
        index += std::holds_alternative<Metric::PictureFunction>(row.get);
    }
    return index;
}

constexpr RowMask kMasks[] = {
    {"error", "mirrors", "", &Errors::error},
    {"error_first_order", "first_order", "first order", &Errors::error_first_order},
    {"error_mirror_in_mirror", "mirror_in_mirror", "mirror in mirror",
     &Errors::error_mirror_in_mirror},
    {"error_non_mirror", "non_mirror", "not a mirror", &Errors::error_non_mirror},
    {"error_all", "all", "all", &Errors::error_all},
    {"error_dielectrics", "dielectrics", "smooth dielectrics", &Errors::error_dielectrics, true},
};

} // namespace

Registered::Registered(Metric quantity) {
    if (!is_of_row(quantity)) quantity.mask = "each";
    table().push_back(std::move(quantity));
}

const std::vector<Metric>& metrics() {
    static const std::vector<Metric> kRows = in_order();
    return kRows;
}

const std::vector<Metric>& difference_metrics() {
    static const std::vector<Metric> kRows = [] {
        std::vector<Metric> rows = metrics();
        std::erase_if(rows, is_of_row);
        return rows;
    }();
    return kRows;
}

void set_studied(Row& row, const std::string& metric, Value value) {
    if (!row.studied) row.studied = std::make_shared<Studied>();
    row.studied->values[metric] = std::move(value);
}

Value studied(const Row& row, std::string_view metric) {
    if (!row.studied) return {};
    const auto found = row.studied->values.find(metric);
    return found == row.studied->values.end() ? Value() : found->second;
}

Value value_of(const Metric& quantity, const Row& row) {
    check(is_of_row(quantity), Failure::internal, "'", quantity.name, "' is no figure of a row");
    if (const auto* get = std::get_if<Metric::RowFunction>(&quantity.get)) return (*get)(row);
    return studied(row, quantity.name);
}

Value value_of(const Metric& quantity, const Difference& difference) {
    check(!is_of_row(quantity), Failure::internal, "'", quantity.name,
          "' is no figure of a difference");
    if (const auto* get = std::get_if<Metric::DifferenceFunction>(&quantity.get))
        return (*get)(difference);
    const std::size_t index = index_of(quantity);
    return index < difference.others.size() ? difference.others[index] : NAN;
}

bool is_shown(const Metric& quantity, const Comparison& comparison) {
    return quantity.study.empty() ||
           std::ranges::find(comparison.studies, quantity.study) != comparison.studies.end();
}

bool is_nothing(const Value& value) {
    struct Asks {
        bool operator()(std::monostate) const { return true; }
        bool operator()(bool) const { return false; }
        bool operator()(double number) const { return !std::isfinite(number); }
        bool operator()(const dvec3& colour) const {
            return !std::isfinite(colour.x + colour.y + colour.z);
        }
        bool operator()(const PixelPosition& place) const { return place.x < 0; }
        bool operator()(const Summary& times) const { return times.n == 0; }
        bool operator()(const std::vector<double>& list) const { return list.empty(); }
        bool operator()(const std::vector<Parts>& list) const { return list.empty(); }
    };
    return std::visit(Asks{}, value);
}

std::vector<double> other_figures(const Compared& compared) {
    std::vector<double> figures;
    for (const Metric& quantity : metrics())
        if (const auto* get = std::get_if<Metric::PictureFunction>(&quantity.get))
            figures.push_back((*get)(compared));
    return figures;
}

std::span<const RowMask> masks() { return kMasks; }

bool has_columns(const RowMask& mask, const Comparison& comparison) {
    return !mask.only_where_some || std::ranges::any_of(comparison.rows, [&](const Row& row) {
        return (row.*mask.error).pixels > 0;
    });
}

} // namespace catoptric::measure
