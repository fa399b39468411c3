#pragma once

#include "reflect/captures.hpp"

/// The search of `pyramid`, for other rows that begin with it.
namespace catoptric::reflect {

Look look_through_pyramid(graph::Graph& graph, const render::FrameInputs& inputs,
                          const Settings& settings, const Surroundings& around);

} // namespace catoptric::reflect
