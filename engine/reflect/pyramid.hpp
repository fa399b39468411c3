#pragma once

#include "reflect/captures.hpp"

/// The search of `pyramid`, which other techniques use as well.
namespace catoptric::reflect {

MirrorShading shading_with_pyramid(graph::Graph& graph, const render::FrameInputs& inputs,
                                   const Settings& settings, const MirrorInputs& around);

} // namespace catoptric::reflect
