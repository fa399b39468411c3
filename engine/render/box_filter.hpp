#pragma once

#include "graph/graph.hpp"

#include <string>
#include <vector>

/// Box-filtered chains of images: each level is the mean over 2 x 2 texels of the level below.
namespace catoptric::render {

/// Layers of an image, and the levels that are computed from them.
struct BoxFilteredLayers {
    graph::ImageHandle unfiltered;
    /// Levels from 1 on, rgba16f: mip k has the size of mip k + 1 of the image.
    graph::ImageHandle levels;
};

/// Declares that the pass writes all mips. A storage image has one mip.
void declare_writes_of_all_mips(graph::PassBuilder& pass, const graph::ImageHandle& levels);

/// Declares the pass that computes these levels. Values are clamped to the largest half float.
void add_box_filter_pass(graph::Graph& graph, const std::string& name,
                         const std::vector<BoxFilteredLayers>& filtered);

} // namespace catoptric::render
