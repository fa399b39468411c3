#pragma once

#include "measure/costs.hpp"

#include <cstddef>
#include <optional>
#include <vector>

/// Times of rows at points of a map: on a device, with a picture of some size, and with some number
/// of frames between two drawings of the captures. engine/report/page/map.js computes the same.
namespace catoptric::measure {

/// A point of the map. The axes scale counts of one frame and costs of one device.
struct MapPoint {
    double pixels = 1; ///< pixels of the picture, as a multiple of the counted picture's
    double period = 1; ///< frames from one drawing of the captures to the next; infinite: at rest
    double raster = 1; ///< factor on the costs of raster work (is_raster_work)
};

/// Work of a row: of a frame that draws all captures, and of a frame at rest, which keeps them.
struct MapWork {
    WorkCounts drawn, rest;
};

/// Returns whether the cost of a kind belongs to rays, from camera_rays to triangle_lanes.
bool is_ray_work(WorkKind kind);
/// Returns whether units of fixed function or of look-ups do the work: vertices, primitives,
/// fragments, draws, and look-ups in shadow maps and captures with their searches.
bool is_raster_work(WorkKind kind);
/// Returns whether the work of a view grows with its pixels. Vertices, primitives, passes, draws,
/// dispatches and the frame itself do not.
bool grows_with_pixels(WorkKind kind);

/// Returns the sum over kinds of count times cost. What a frame that draws captures has beyond a
/// frame at rest is divided by the period; the rest grows with the pixels. `low` and `high` are the
/// times with cheap rays and dear other work, and the other way round, in order of size.
PredictedTime map_time(const DeviceCosts& costs, const MapWork& work, const MapPoint& point);

/// Returns the indices of the rows that no other beats in time and FLIP at the point, the fastest
/// first. `work` has an entry for each row; rows without one are left out.
std::vector<std::size_t> map_front(const DeviceCosts& costs, const std::vector<Row>& rows,
                                   const std::vector<std::optional<MapWork>>& work,
                                   const MapPoint& point);

/// Returns the fastest row with at most this FLIP over the mirrors; none if there is none.
std::optional<std::size_t> map_best(const DeviceCosts& costs, const std::vector<Row>& rows,
                                    const std::vector<std::optional<MapWork>>& work,
                                    const MapPoint& point, double max_flip);

} // namespace catoptric::measure
