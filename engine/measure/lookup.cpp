#include "measure/lookup.hpp"

#include "measure/metric.hpp"
#include "measure/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace catoptric::measure {

namespace {

constexpr std::string_view kFirstOrder = "first_order";

template <double LookupError::*Figure>
Value figure(const Row& row) {
    return row.lookup ? (*row.lookup).*Figure : NAN;
}

const Registered kPixels{
    {.name = "lookup/pixels",
     .unit = "pixels",
     .help = "number of mirror pixels whose reflected ray meets no second mirror",
     .mask = kFirstOrder,
     .order = 260,
     .columns = {{"Pixels", Style::fixed, 0, MetricTable::lookup}},
     .get = [](const Row& row) -> Value {
         return row.lookup ? static_cast<double>(row.lookup->pixels) : NAN;
     }}};
const Registered kMean{{.name = "lookup/mean_degrees",
                        .unit = "degrees",
                        .help = "mean angle between the looked-up and the true direction",
                        .mask = kFirstOrder,
                        .better = Better::less,
                        .order = 261,
                        .columns = {{"Mean, degrees", Style::fixed, 3, MetricTable::lookup}},
                        .get = figure<&LookupError::mean_degrees>}};
const Registered kP95{
    {.name = "lookup/p95_degrees",
     .unit = "degrees",
     .help = "95th percentile of the angle between the looked-up and the true direction",
     .mask = kFirstOrder,
     .better = Better::less,
     .order = 262,
     .columns = {{"95 %", Style::fixed, 2, MetricTable::lookup}},
     .get = figure<&LookupError::p95_degrees>}};
const Registered kP99{
    {.name = "lookup/p99_degrees",
     .unit = "degrees",
     .help = "99th percentile of the angle between the looked-up and the true direction",
     .mask = kFirstOrder,
     .better = Better::less,
     .order = 263,
     .columns = {{"99 %", Style::fixed, 2, MetricTable::lookup}},
     .get = figure<&LookupError::p99_degrees>}};
const Registered kWrongObject{
    {.name = "lookup/wrong_object",
     .help = "share of the pixels whose look-up finds another object than the true one",
     .mask = kFirstOrder,
     .better = Better::less,
     .order = 264,
     .columns = {{"Wrong object, %", Style::percent, 2, MetricTable::lookup}},
     .get = figure<&LookupError::wrong_object>}};
const Registered kUnknown{{.name = "lookup/unknown",
                           .help = "share of the pixels whose search answers unknown",
                           .mask = kFirstOrder,
                           .better = Better::less,
                           .order = 265,
                           .columns = {{"Unknown, %", Style::percent, 2, MetricTable::lookup}},
                           .get = figure<&LookupError::unknown>}};
const Registered kMiss{{.name = "lookup/miss",
                        .help = "share of the pixels whose search answers miss",
                        .mask = kFirstOrder,
                        .order = 266,
                        .columns = {{"Miss, %", Style::percent, 2, MetricTable::lookup}},
                        .get = figure<&LookupError::miss>}};
const Registered kResidual{
    {.name = "lookup/p95_residual",
     .help = "95th percentile, over hits, of the relative distance between the point found and the "
             "captured surface",
     .mask = kFirstOrder,
     .better = Better::less,
     .order = 267,
     .get = figure<&LookupError::p95_residual>}};

} // namespace

LookupError lookup_error(std::span<const LookedUp> pixels) {
    LookupError error;
    error.pixels = pixels.size();
    if (pixels.empty()) return error;
    std::vector<double> angles;
    for (const LookedUp& pixel : pixels) angles.push_back(pixel.angle_degrees);
    const auto count = static_cast<double>(pixels.size());
    const auto share = [&](auto&& is) {
        return static_cast<double>(std::ranges::count_if(pixels, is)) / count;
    };
    error.mean_degrees = std::accumulate(angles.begin(), angles.end(), 0.0) / count;
    error.p95_degrees = percentile(angles, 0.95);
    error.p99_degrees = percentile(angles, 0.99);
    error.wrong_object = share([](const LookedUp& pixel) { return pixel.wrong_object; });
    error.unknown = share([](const LookedUp& pixel) { return pixel.state == 1; });
    error.miss = share([](const LookedUp& pixel) { return pixel.state == 2; });
    std::vector<double> residuals;
    for (const LookedUp& pixel : pixels)
        if (pixel.state == 0) residuals.push_back(pixel.residual);
    if (!residuals.empty()) error.p95_residual = percentile(std::move(residuals), 0.95);
    return error;
}

double angle_degrees(const dvec3& a, const dvec3& b) {
    return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

} // namespace catoptric::measure
