#pragma once

#include "reflect/captures.hpp"

/// The search of `pyramid`, which other techniques use as well.
namespace catoptric::reflect {

MirrorShading make_pyramid_shading(graph::Graph& graph, const render::FrameInputs& inputs,
                                   const KnobSettings& settings, const ShadingInputs& around);

} // namespace catoptric::reflect
