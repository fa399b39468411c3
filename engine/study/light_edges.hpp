#pragma once

#include "report/comparison.hpp"
#include "session/session.hpp"
#include "study/compare_row.hpp"
#include "study/oracle.hpp"

#include <cstdint>
#include <vector>

namespace catoptric::study {

using namespace session;

/// Returns the row's error over the mirrors, split by whether its mirrors looked at the outline of
/// a light. `row`: has errors and a plan. `truth`: the reference picture. `hits`: first hits of the
/// reference picture (measure/masks.hpp). `lookup`: see TechniqueResult::lookup, at the instant of
/// `finder`. `exposure`: stops. Traces nine rays per mirror pixel.
measure::LightEdgeErrors split_at_light_edges(const report::Row& row,
                                              const ComparedReference& truth,
                                              const std::vector<std::uint32_t>& hits,
                                              const std::vector<vec4>& lookup,
                                              const TrueHitFinder& finder, double exposure);

} // namespace catoptric::study
