#pragma once

#include "reflect/captures.hpp"

/// The bounds that `reflect/pyramid.frag` searches in, for other rows that search with it.
namespace catoptric::reflect {

/// All levels of all faces, one layer a face: a dispatch a level. To be bound as "bounds".
graph::Image add_pyramid(graph::Graph& graph, const render::FrameInputs& inputs,
                         const Feedback& captured);

} // namespace catoptric::reflect
