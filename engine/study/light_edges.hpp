#pragma once

#include "report/comparison.hpp"
#include "session/session.hpp"
#include "study/oracle.hpp"

#include <cstdint>
#include <vector>

namespace catoptric::app {

/// Returns the row's error over the mirrors, split by whether its mirrors looked at the outline of
/// a light. `row`: with its errors and its plan. `truth`: picture that the row was judged against.
/// `hits`: of the same picture (measure/masks.hpp). `lookup`: see Part::lookup, at the oracle's
/// instant. `exposure`: stops. Costs nine rays per mirror pixel.
measure::LightEdges light_edges_of(const report::Row& row, const Part& truth,
                                   const std::vector<std::uint32_t>& hits,
                                   const std::vector<vec4>& lookup, const Oracle& oracle,
                                   double exposure);

} // namespace catoptric::app
