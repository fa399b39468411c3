#pragma once

#include "app/oracle.hpp"
#include "app/session.hpp"
#include "report/comparison.hpp"

#include <cstdint>
#include <vector>

namespace catoptric::app {

/// The row's error over the mirrors, split by where its mirrors looked. `row`: with its errors and
/// its plan; `truth`: what it was judged against; `hits`: of the same picture (measure/masks.hpp);
/// `lookup`: see Part::lookup, of the oracle's instant; `exposure`: stops. Costs nine rays a mirror
/// pixel.
measure::LightEdges light_edges_of(const report::Row& row, const Part& truth,
                                   const std::vector<std::uint32_t>& hits,
                                   const std::vector<vec4>& lookup, const Oracle& oracle,
                                   double exposure);

} // namespace catoptric::app
