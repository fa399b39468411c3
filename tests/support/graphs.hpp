#pragma once

#include "graph/plan.hpp"

/// Helpers that many tests of the render graph use.
namespace test {

inline constexpr catoptric::graph::ClearValue kBlackClearColour{};
inline void record_no_commands(catoptric::graph::PassCommands&) {}
/// Returns the plan of a graph whose images all have the bytes that
/// `default_sizer` states.
inline catoptric::graph::GraphPlan plan_test_graph(const catoptric::graph::Graph& graph) {
    return catoptric::graph::plan_graph(graph, {}, catoptric::graph::default_sizer());
}

} // namespace test
