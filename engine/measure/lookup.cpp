#include "measure/lookup.hpp"

#include "measure/metric.hpp"
#include "measure/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace catoptric::measure {

namespace {

constexpr std::string_view kFirstOrderMaskName = "first_order";

template <double LookupErrorSummary::*Figure>
MetricValue lookup_error_metric_of_row(const Row& row) {
    return row.lookup ? (*row.lookup).*Figure : NAN;
}

const RegisteredMetric kLookupPixelsMetric{
    {.name = "lookup/pixels",
     .unit = "pixels",
     .help = "number of mirror pixels whose reflected ray meets no second mirror",
     .mask = kFirstOrderMaskName,
     .order = 260,
     .columns = {{"Pixels", MetricValueFormat::fixed, 0, MetricTableKind::lookup}},
     .get = [](const Row& row) -> MetricValue {
         return row.lookup ? static_cast<double>(row.lookup->pixels) : NAN;
     }}};
const RegisteredMetric kMeanAngleMetric{
    {.name = "lookup/mean_degrees",
     .unit = "degrees",
     .help = "mean angle between the looked-up and the true direction",
     .mask = kFirstOrderMaskName,
     .better = BetterDirection::less,
     .order = 261,
     .columns = {{"Mean, degrees", MetricValueFormat::fixed, 3, MetricTableKind::lookup}},
     .get = lookup_error_metric_of_row<&LookupErrorSummary::mean_degrees>}};
const RegisteredMetric kAnglePercentile95Metric{
    {.name = "lookup/p95_degrees",
     .unit = "degrees",
     .help = "95th percentile of the angle between the looked-up and the true direction",
     .mask = kFirstOrderMaskName,
     .better = BetterDirection::less,
     .order = 262,
     .columns = {{"95 %", MetricValueFormat::fixed, 2, MetricTableKind::lookup}},
     .get = lookup_error_metric_of_row<&LookupErrorSummary::p95_degrees>}};
const RegisteredMetric kAnglePercentile99Metric{
    {.name = "lookup/p99_degrees",
     .unit = "degrees",
     .help = "99th percentile of the angle between the looked-up and the true direction",
     .mask = kFirstOrderMaskName,
     .better = BetterDirection::less,
     .order = 263,
     .columns = {{"99 %", MetricValueFormat::fixed, 2, MetricTableKind::lookup}},
     .get = lookup_error_metric_of_row<&LookupErrorSummary::p99_degrees>}};
const RegisteredMetric kWrongObjectMetric{
    {.name = "lookup/wrong_object",
     .help = "share of the pixels whose look-up finds another object than the true one",
     .mask = kFirstOrderMaskName,
     .better = BetterDirection::less,
     .order = 264,
     .columns = {{"Wrong object, %", MetricValueFormat::percent, 2, MetricTableKind::lookup}},
     .get = lookup_error_metric_of_row<&LookupErrorSummary::wrong_object>}};
const RegisteredMetric kUnknownLookupsMetric{
    {.name = "lookup/unknown",
     .help = "share of the pixels whose search answers unknown",
     .mask = kFirstOrderMaskName,
     .better = BetterDirection::less,
     .order = 265,
     .columns = {{"Unknown, %", MetricValueFormat::percent, 2, MetricTableKind::lookup}},
     .get = lookup_error_metric_of_row<&LookupErrorSummary::unknown>}};
const RegisteredMetric kMissedLookupsMetric{
    {.name = "lookup/miss",
     .help = "share of the pixels whose search answers miss",
     .mask = kFirstOrderMaskName,
     .order = 266,
     .columns = {{"Miss, %", MetricValueFormat::percent, 2, MetricTableKind::lookup}},
     .get = lookup_error_metric_of_row<&LookupErrorSummary::miss>}};
const RegisteredMetric kLookupResidualMetric{
    {.name = "lookup/p95_residual",
     .help = "95th percentile, over hits, of the relative distance between the point found and the "
             "captured surface",
     .mask = kFirstOrderMaskName,
     .better = BetterDirection::less,
     .order = 267,
     .get = lookup_error_metric_of_row<&LookupErrorSummary::p95_residual>}};

} // namespace

LookupErrorSummary summarise_lookup_errors(std::span<const LookupDirectionError> pixels) {
    LookupErrorSummary error;
    error.pixels = pixels.size();
    if (pixels.empty()) return error;
    std::vector<double> angles;
    for (const LookupDirectionError& pixel : pixels) angles.push_back(pixel.angle_degrees);
    const auto count = static_cast<double>(pixels.size());
    const auto share = [&](auto&& is) {
        return static_cast<double>(std::ranges::count_if(pixels, is)) / count;
    };
    error.mean_degrees = std::accumulate(angles.begin(), angles.end(), 0.0) / count;
    error.p95_degrees = compute_percentile(angles, 0.95);
    error.p99_degrees = compute_percentile(angles, 0.99);
    error.wrong_object = share(
        [](const LookupDirectionError& pixel) { return pixel.wrong_object; });
    error.unknown = share([](const LookupDirectionError& pixel) { return pixel.state == 1; });
    error.miss = share([](const LookupDirectionError& pixel) { return pixel.state == 2; });
    std::vector<double> residuals;
    for (const LookupDirectionError& pixel : pixels)
        if (pixel.state == 0) residuals.push_back(pixel.residual);
    if (!residuals.empty()) error.p95_residual = compute_percentile(std::move(residuals), 0.95);
    return error;
}

double angle_between_degrees(const dvec3& a, const dvec3& b) {
    return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

} // namespace catoptric::measure
