#pragma once

#include "measure/costs.hpp"

#include <string>
#include <vector>

namespace catoptric::measure {

/// Fits the costs of a device to few rows. Rows that hardly contain a kind of work say little of
/// its cost, so costs start from those of `typical`, a similar device: first each group of kinds
/// (rays, shading and look-ups, raster work, commands) is scaled by one factor, then each cost
/// moves from there as far as the rows support it (ridge regression of relative errors). How firmly
/// a cost is held is what predicts each row best from the others. Kinds that `typical` lacks get no
/// cost. FitQuality is as in fit_costs, over the same rows. Throws `usage` for fewer than 8
/// samples, and for a time that is not positive.
DeviceCosts calibrate_costs(std::string device, std::vector<TimedWork> samples,
                            const DeviceCosts& typical);

} // namespace catoptric::measure
