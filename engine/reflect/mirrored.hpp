#pragma once

#include "reflect/plan.hpp"

/// What flat mirrors show that have views of their own.
namespace catoptric::reflect {

/// Declares a view for each mirror whose technique has such (Technique::mirrored_bounces) and that
/// the picture shows, and for those that these views show, and says in `looks`, which has one for
/// each mirror, how the picture shows them: black where there is no view. Other mirrors are drawn
/// in the views as `others` has it. Returns what was done otherwise than asked for, a sentence
/// each.
std::vector<std::string> add_mirrored(graph::Graph& graph, const render::FrameInputs& inputs,
                                      const Assignment& assignment,
                                      const render::Lighting& lighting, const render::Looks& others,
                                      render::Looks& looks);

} // namespace catoptric::reflect
