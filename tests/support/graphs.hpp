#pragma once

#include "graph/plan.hpp"

/// Helpers that many tests of the render graph use.
namespace test {

inline constexpr catoptric::graph::Clear kBlack{};
inline void nothing(catoptric::graph::Commands&) {}
/// Returns the plan of a graph whose images all have the bytes that `plain_sizer` states.
inline catoptric::graph::GraphPlan planned(const catoptric::graph::Graph& graph) {
    return catoptric::graph::plan(graph, {}, catoptric::graph::plain_sizer());
}

} // namespace test
