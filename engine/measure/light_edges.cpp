#include "measure/light_edges.hpp"

#include "measure/halves.hpp"
#include "measure/metric.hpp"

#include <algorithm>
#include <cmath>

namespace catoptric::measure {

namespace {

constexpr int kOrderAfterRmse = 104; // order of columns that stand beside rmse

template <double LightEdgeErrors::*Figure>
MetricValue light_edge_value(const Row& row) {
    return row.light_edges ? (*row.light_edges).*Figure : NAN;
}

const RegisteredMetric kLightEdgeRmseMetric{
    {.name = "light_edges/rmse",
     .help = "part of the rmse from pixels that looked within a texel of a light's outline; the "
             "squares of this part and of rest_rmse add up to that of rmse",
     .mask = kMirrorMaskName,
     .better = BetterDirection::less,
     .order = 255,
     .columns = {{.title = "rmse, light edges", .order = kOrderAfterRmse}},
     .get = light_edge_value<&LightEdgeErrors::rmse>}};
const RegisteredMetric kRemainingRmseMetric{
    {.name = "light_edges/rest_rmse",
     .help = "part of the rmse from all other pixels",
     .mask = kMirrorMaskName,
     .better = BetterDirection::less,
     .order = 256,
     .columns = {{.title = "rmse, rest", .order = kOrderAfterRmse}},
     .get = light_edge_value<&LightEdgeErrors::rest_rmse>}};
const RegisteredMetric kLightEdgeShareMetric{
    {.name = "light_edges/share",
     .help = "share of the squared error in pixels that looked within a texel "
             "of a light's outline",
     .mask = kMirrorMaskName,
     .order = 257,
     .get = light_edge_value<&LightEdgeErrors::share>}};
const RegisteredMetric kLightEdgePixelsMetric{
    {.name = "light_edges/pixels",
     .help = "share of the pixels that looked within a texel of a light's outline",
     .mask = kMirrorMaskName,
     .order = 258,
     .get = light_edge_value<&LightEdgeErrors::pixels>}};

struct SquaredErrorSum {
    /// Finite pixels, and the mean square of a channel times their number. An estimate against a
    /// reference with noise may be negative.
    double pixels = 0, squares = 0;
};

SquaredErrorSum squared_error_sum(const Difference& error) {
    const auto judged = static_cast<double>(error.pixels - error.nonfinite);
    return {judged, judged > 0 ? error.rmse * std::abs(error.rmse) * judged : 0};
}

} // namespace

LightEdgeErrors split_by_light_edges(const Difference& there, const Difference& elsewhere) {
    const SquaredErrorSum edges = squared_error_sum(there), rest = squared_error_sum(elsewhere);
    const double pixels = edges.pixels + rest.pixels, squares = edges.squares + rest.squares;
    if (!(pixels > 0)) return {};
    return {edges.pixels / pixels, squares > 0 ? std::clamp(edges.squares / squares, 0.0, 1.0) : 0,
            signed_sqrt(edges.squares / pixels), signed_sqrt(rest.squares / pixels)};
}

} // namespace catoptric::measure
