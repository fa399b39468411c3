#pragma once

#include "report/comparison.hpp"
#include "session/session.hpp"
#include "study/compare_row.hpp"
#include "study/oracle.hpp"

#include <cstdint>
#include <vector>

namespace catoptric::app {

/// Returns the row's error over the mirrors, split by whether its mirrors looked at the outline of
/// a light. `row`: with its errors and its plan. `truth`: picture that the row was judged against.
/// `hits`: of the same picture (measure/masks.hpp). `lookup`: see TechniqueResult::lookup, at the
/// oracle's instant. `exposure`: stops. Costs nine rays per mirror pixel.
measure::LightEdgeErrors split_error_at_light_edges(const report::Row& row,
                                                    const ComparedReference& truth,
                                                    const std::vector<std::uint32_t>& hits,
                                                    const std::vector<vec4>& lookup,
                                                    const TrueHitFinder& oracle, double exposure);

} // namespace catoptric::app
