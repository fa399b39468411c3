// Writes the part of a report on errors against a noisy reference.
#include "measure/halves.hpp"
#include "measure/metric.hpp"
#include "report/report_part.hpp"
#include "report/tables.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace catoptric::report {

namespace {

/// Returns a squared error with two significant digits, or words for a negative estimate.
std::string format_squared_error(double square) {
    if (!std::isfinite(square)) return std::string(kEmptyCell);
    return square < 0 ? std::string(kBelowNoise) : fmt::format("{:.2e}", square);
}

/// Returns the entry of a row's list `noise` for the mask of mirrors.
const measure::MetricParts* find_mirror_noise(const measure::MetricValue& value) {
    const auto* list = std::get_if<std::vector<measure::MetricParts>>(&value);
    if (list == nullptr) return nullptr;
    const auto found = std::ranges::find(*list, measure::row_masks().front().name,
                                         &measure::MetricParts::name);
    return found == list->end() ? nullptr : &*found;
}

double find_part(const measure::MetricParts& parts, std::string_view name) {
    for (const auto& [what, value] : parts.values)
        if (const auto* number = std::get_if<double>(&value); what == name && number != nullptr)
            return *number;
    return NAN;
}

std::string format_noise_interval(const measure::MetricParts& parts) {
    for (const auto& [what, value] : parts.values)
        if (const auto* list = std::get_if<std::vector<double>>(&value); list != nullptr)
            return fmt::format("{:.2e} to {:.2e}", list->front(), list->back());
    return std::string(kEmptyCell);
}

ReportTable noise_table(const Comparison& comparison) {
    ReportTable table{
        "Errors against a reference with noise",
        {text_column("Row"), "Squared error", "Deviation", text_column("95 %"), "Not clamped",
         "Crossing, %", "FLIP", "Floor", text_column("Verdict")},
        "Over the mirrors. Squared error: the mean of (x - A)(x - B) over pixels and channels, where "
        "x is the row and A and B are the independent halves of the reference; unbiased, and "
        "negative where the error is below the noise. Deviation: standard deviation of this "
        "estimate by the noise alone. 95 %: by bootstrap over tiles of 16x16 "
        "pixels. Not clamped: the same without clamping to [0,1]. Crossing: pixels in which one "
        "half exceeds 1 and the other does not, which clamping biases. FLIP: the mean of FLIP "
        "against A and against B. Floor: FLIP between A and B."};
    for (const Row& row : comparison.rows) {
        const measure::MetricValue value = measure::study_metric(row, measure::kNoiseMetricName);
        const measure::MetricParts* noise = find_mirror_noise(value);
        if (noise == nullptr) continue;
        const double square = find_part(*noise, "squared_error");
        const bool hidden = measure::is_below_noise(row.error) || square < 0;
        table.rows.push_back({row.label, format_squared_error(square),
                              format_squared_error(find_part(*noise, "deviation")),
                              format_noise_interval(*noise),
                              format_squared_error(find_part(*noise, "squared_error_unclamped")),
                              format_fixed(100 * find_part(*noise, "crossing"), 2),
                              format_error(row.error.flip), format_error(row.error.flip_floor),
                              hidden ? std::string(kBelowNoise) : "above the noise"});
    }
    return table;
}

const RegisteredPart kNoisePart{
    {.name = "noise",
     .order = 50,
     .tables = [](const Comparison& comparison) { return std::vector{noise_table(comparison)}; },
     .look = "noise"}};

} // namespace

measure::Interval find_rmse_interval(const Row& row) {
    const measure::MetricValue value = measure::study_metric(row, measure::kNoiseMetricName);
    const measure::MetricParts* noise = find_mirror_noise(value);
    if (noise == nullptr) return {};
    for (const auto& [what, part] : noise->values)
        if (const auto* ends = std::get_if<std::vector<double>>(&part); what == "ci95" && ends)
            return {measure::signed_sqrt(ends->front()), measure::signed_sqrt(ends->back())};
    return {};
}

} // namespace catoptric::report
