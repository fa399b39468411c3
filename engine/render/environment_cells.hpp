#pragma once

#include "scene/scene.hpp"
#include "shared.h"

#include <vector>

namespace catoptric::render {

/// The part of an environment map that is brighter than its mean, for drawing directions
/// (shaders/lib/environment.glsl). A cell lies between the centres of four texels
/// (direction_to_environment_cell).
struct EnvironmentCells {
    /// One texel for each bright cell: the share of the entry of the alias table that belongs to
    /// the cell, the entry that has the rest, and the cell's number. Empty if no cell is brighter
    /// than the mean by a thousandth.
    std::vector<vec4> texels;
    float threshold =
        0;             ///< brightness (sum of the channels, without scale) from which a cell counts
    float density = 0; ///< factor of a cell's brightness above the threshold in its density
};

/// Costs O(n) in the texels. The environment has texels.
EnvironmentCells find_bright_cells(const scene::Environment& environment);

} // namespace catoptric::render
