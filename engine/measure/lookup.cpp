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

template <double LookupSummary::*Figure>
MetricValue lookup_value(const Row& row) {
    return row.lookup ? (*row.lookup).*Figure : NAN;
}

const RegisteredMetric kLookupPixelsMetric{
    {.name = "lookup/pixels",
     .unit = "pixels",
     .help = "number of mirror pixels whose reflected ray meets no second mirror",
     .mask = kFirstOrderMaskName,
     .order = 260,
     .columns = {{"Pixels", ValueFormat::fixed, 0, TableKind::lookup}},
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
     .columns = {{"Mean, degrees", ValueFormat::fixed, 3, TableKind::lookup}},
     .get = lookup_value<&LookupSummary::mean_degrees>}};
const RegisteredMetric kAnglePercentile95Metric{
    {.name = "lookup/p95_degrees",
     .unit = "degrees",
     .help = "95th percentile of the angle between the looked-up and the true direction",
     .mask = kFirstOrderMaskName,
     .better = BetterDirection::less,
     .order = 262,
     .columns = {{"95 %", ValueFormat::fixed, 2, TableKind::lookup}},
     .get = lookup_value<&LookupSummary::p95_degrees>}};
const RegisteredMetric kAnglePercentile99Metric{
    {.name = "lookup/p99_degrees",
     .unit = "degrees",
     .help = "99th percentile of the angle between the looked-up and the true direction",
     .mask = kFirstOrderMaskName,
     .better = BetterDirection::less,
     .order = 263,
     .columns = {{"99 %", ValueFormat::fixed, 2, TableKind::lookup}},
     .get = lookup_value<&LookupSummary::p99_degrees>}};
const RegisteredMetric kWrongObjectMetric{
    {.name = "lookup/wrong_object",
     .help = "share of the pixels whose look-up finds another object than the true one",
     .mask = kFirstOrderMaskName,
     .better = BetterDirection::less,
     .order = 264,
     .columns = {{"Wrong object, %", ValueFormat::percent, 2, TableKind::lookup}},
     .get = lookup_value<&LookupSummary::wrong_object>}};
const RegisteredMetric kUnknownLookupsMetric{
    {.name = "lookup/unknown",
     .help = "share of the pixels whose search answers unknown",
     .mask = kFirstOrderMaskName,
     .better = BetterDirection::less,
     .order = 265,
     .columns = {{"Unknown, %", ValueFormat::percent, 2, TableKind::lookup}},
     .get = lookup_value<&LookupSummary::unknown>}};
const RegisteredMetric kMissedLookupsMetric{
    {.name = "lookup/miss",
     .help = "share of the pixels whose search answers miss",
     .mask = kFirstOrderMaskName,
     .order = 266,
     .columns = {{"Miss, %", ValueFormat::percent, 2, TableKind::lookup}},
     .get = lookup_value<&LookupSummary::miss>}};
const RegisteredMetric kLookupResidualMetric{
    {.name = "lookup/p95_residual",
     .help = "95th percentile, over hits, of the relative distance between the point found and the "
             "captured surface",
     .mask = kFirstOrderMaskName,
     .better = BetterDirection::less,
     .order = 267,
     .get = lookup_value<&LookupSummary::p95_residual>}};

} // namespace

LookupSummary summarise_lookups(std::span<const LookupError> pixels) {
    LookupSummary error;
    error.pixels = pixels.size();
    if (pixels.empty()) return error;
    std::vector<double> angles;
    for (const LookupError& pixel : pixels) angles.push_back(pixel.angle_degrees);
    const auto count = static_cast<double>(pixels.size());
    const auto share = [&](auto&& is) {
        return static_cast<double>(std::ranges::count_if(pixels, is)) / count;
    };
    error.mean_degrees = std::accumulate(angles.begin(), angles.end(), 0.0) / count;
    error.p95_degrees = percentile(angles, 0.95);
    error.p99_degrees = percentile(angles, 0.99);
    error.wrong_object = share([](const LookupError& pixel) { return pixel.wrong_object; });
    error.unknown = share([](const LookupError& pixel) { return pixel.state == 1; });
    error.miss = share([](const LookupError& pixel) { return pixel.state == 2; });
    std::vector<double> residuals;
    for (const LookupError& pixel : pixels)
        if (pixel.state == 0) residuals.push_back(pixel.residual);
    if (!residuals.empty()) error.p95_residual = percentile(std::move(residuals), 0.95);
    return error;
}

double angle_between_degrees(const dvec3& a, const dvec3& b) {
    return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

} // namespace catoptric::measure
