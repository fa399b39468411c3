#include "measure/trade_map.hpp"

#include "measure/judge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace catoptric::measure {

namespace {

/// Returns the units of a kind in a frame at the point, on average.
double mean_count(const MapWork& work, WorkKind kind, const MapPoint& point) {
    const auto count = [kind](const WorkCounts& counts) {
        return static_cast<double>(counts[kind].value_or(0));
    };
    const double rest = count(work.rest), captures = std::max(count(work.drawn) - rest, 0.0);
    return rest * (grows_with_pixels(kind) ? point.pixels : 1) + captures / point.period;
}

std::vector<double> row_times(const DeviceCosts& costs, const std::vector<Row>& rows,
                              const std::vector<std::optional<MapWork>>& work,
                              const MapPoint& point) {
    std::vector<double> ms(rows.size(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (i < work.size() && work[i] && is_rankable(rows[i]))
            ms[i] = map_time(costs, *work[i], point).ms;
    return ms;
}

} // namespace

bool is_ray_work(WorkKind kind) { return kind <= WorkKind::triangle_lanes; }

bool is_raster_work(WorkKind kind) {
    return (kind >= WorkKind::shadow_lookups && kind <= WorkKind::search_lanes) ||
           (kind >= WorkKind::vertices && kind <= WorkKind::fragments) || kind == WorkKind::draws;
}

bool grows_with_pixels(WorkKind kind) {
    return kind != WorkKind::vertices && kind != WorkKind::primitives && kind != WorkKind::frames &&
           kind != WorkKind::passes && kind != WorkKind::draws && kind != WorkKind::dispatches;
}

PredictedTime map_time(const DeviceCosts& costs, const MapWork& work, const MapPoint& point) {
    const auto [ms, cheap, dear] = predict_by_rays(costs, [&](WorkKind kind) {
        return mean_count(work, kind, point) * (is_raster_work(kind) ? point.raster : 1);
    });
    return {ms, std::min({ms, cheap, dear}), std::max({ms, cheap, dear})};
}

std::vector<std::size_t> map_front(const DeviceCosts& costs, const std::vector<Row>& rows,
                                   const std::vector<std::optional<MapWork>>& work,
                                   const MapPoint& point) {
    return front_of_times(rows, row_times(costs, rows, work, point));
}

std::optional<std::size_t> map_best(const DeviceCosts& costs, const std::vector<Row>& rows,
                                    const std::vector<std::optional<MapWork>>& work,
                                    const MapPoint& point, double max_flip) {
    const std::vector<double> ms = row_times(costs, rows, work, point);
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (!std::isnan(ms[i]) && rows[i].error.flip <= max_flip && (!best || ms[i] < ms[*best]))
            best = i;
    return best;
}

} // namespace catoptric::measure
