#pragma once

#include "core/math.hpp"
#include "graph/graph.hpp"

#include <optional>
#include <string>
#include <vector>

/// Box-filtered chains of images: each level is the mean over 2 x 2 texels of the level below.
namespace catoptric::render {

/// Layers of an image, and the levels that are computed from them.
struct BoxFilteredLayers {
    graph::ImageHandle unfiltered;
    /// Levels from 1 on, rgba16f: mip k has the size of mip k + 1 of the image.
    graph::ImageHandle levels;
    /// Pixels of the image that have a value; none: all. Levels then have a value in the texels
    /// over this area and in those beside them, where the area's outermost texels continue.
    std::optional<graph::PixelRectangle> area = {};
    /// Distances of what the image shows. The levels then hold the mean of 1 / distance in alpha.
    std::optional<graph::ImageHandle> distances = {};
};

/// Declares an image for the levels of a picture, from level 1 to the level of one texel.
graph::ImageHandle add_picture_levels(graph::Graph& graph, std::string name, uvec2 size);

/// Declares that the pass writes all mips. A storage image has one mip.
void declare_mip_writes(graph::PassBuilder& pass, const graph::ImageHandle& levels);

/// Declares the pass that computes these levels. Values are clamped to the largest half float.
void add_box_filter(graph::Graph& graph, const std::string& name,
                    const std::vector<BoxFilteredLayers>& filtered);

} // namespace catoptric::render
