// Metrics of a row's error split by cause.
#include "measure/causes.hpp"

#include "measure/light_edges.hpp"
#include "measure/metric.hpp"

#include <cmath>

namespace catoptric::measure {

namespace {

template <double Causes::*Figure>
MetricValue cause_value(const Row& row) {
    return row.causes ? (*row.causes).*Figure : NAN;
}

MetricValue cause_shares(const Row& row) {
    std::vector<MetricParts> list;
    if (!row.causes) return list;
    for (const CauseShare& cause : row.causes->list)
        list.push_back({"cause",
                        cause.name,
                        {{"share", cause.share},
                         {"share_first_order", cause.share_first_order},
                         {"share_mirror_in_mirror", cause.share_mirror_in_mirror},
                         {"share_per_mirror", cause.share_per_mirror},
                         {"squared_error", cause.squared_error},
                         {"alone", cause.alone},
                         {"alone_per_mirror", cause.alone_per_mirror}}});
    return list;
}

const RegisteredMetric kSquaredErrorMetric{
    {.name = "causes/squared_error",
     .help = "mean square difference of the row's picture, which the causes add up to",
     .mask = kMirrorMaskName,
     .better = BetterDirection::less,
     .order = 270,
     .get = cause_value<&Causes::squared_error>}};
const RegisteredMetric kErrorPerMirrorMetric{
    {.name = "causes/squared_error_per_mirror",
     .help = "mean square difference over the pixels of each mirror",
     .mask = kMirrorMaskName,
     .better = BetterDirection::less,
     .order = 271,
     .get = [](const Row& row) -> MetricValue {
         return row.causes ? row.causes->squared_error_per_mirror : std::vector<double>();
     }}};
const RegisteredMetric kUnexplainedErrorMetric{
    {.name = "causes/rest_rmse",
     .help = "rmse when all causes are removed: near 0 if no cause is missing",
     .mask = kMirrorMaskName,
     .order = 272,
     .get = cause_value<&Causes::rest_rmse>}};
const RegisteredMetric kErrorAtLightEdgesMetric{
    {.name = "causes/at_light_edges",
     .help = "share of the squared error in pixels that looked within a texel of a light's outline",
     .mask = kMirrorMaskName,
     .order = 273,
     .get = [](const Row& row) -> MetricValue {
         return row.causes && row.light_edges ? row.light_edges->share : NAN;
     }}};
const RegisteredMetric kCauseSharesMetric{
    {.name = "causes/list",
     .help =
         "each cause's share of the squared error (Shapley values for five of them, 1 in sum), and "
         "the decrease of the error when only this cause is removed",
     .mask = kMirrorMaskName,
     .order = 274,
     .get = cause_shares}};

} // namespace

} // namespace catoptric::measure
