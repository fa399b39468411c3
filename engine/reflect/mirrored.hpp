#pragma once

#include "reflect/plan.hpp"

/// Mirrored views for flat mirrors.
namespace catoptric::reflect {

/// Declares a mirrored view for each visible mirror whose technique has
/// Technique::mirrored_views, and views within these views.
///
/// `looks` receives the mirror shading of these mirrors in the picture, with one entry per mirror.
/// Mirrors without a view are black. `others` is the mirror shading of all other mirrors inside the
/// views. Returns notes, one sentence each, on views that differ from the request.
std::vector<std::string> add_mirrored_views(graph::Graph& graph, const render::FrameInputs& inputs,
                                            const TechniqueOfEachMirror& assignment,
                                            const render::ShadingLights& lighting,
                                            const render::ShaderOfEachMirror& others,
                                            render::ShaderOfEachMirror& looks);

} // namespace catoptric::reflect
