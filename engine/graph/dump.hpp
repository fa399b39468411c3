#pragma once

#include "graph/plan.hpp"

#include <string>

namespace catoptric::graph {

/// The plan for people: passes in order with what each reads and writes, what was culled and why,
/// which images share memory, scene_passes, bytes.
std::string to_text(const Graph& graph, const Plan& plan);
/// Graphviz: passes as boxes, images as ellipses, culled passes dashed.
std::string to_dot(const Graph& graph, const Plan& plan);
/// {"passes":
/// [{"name","tag","reads":[{"image","layers":[first,count],"use","previous"}],"writes":[...],"barriers":n}],
///  "culled": [{"name","reason"}], "images":
///  [{"name","format","size","layers","first","last","offset","bytes","alone"}], "scene_passes",
///  "bytes", "bytes_unshared"}
std::string to_json(const Graph& graph, const Plan& plan);

} // namespace catoptric::graph
