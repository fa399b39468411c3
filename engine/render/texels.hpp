#pragma once

#include "core/math.hpp"
#include "shared.h"

#include <span>
#include <vector>

/// Lists of structures as texels of four floats, as shaders/lib/bindings.glsl reads them: of each
/// structure shared::k...Texels, one after the other. Numbers are words (bvh/words.hpp), since a
/// device may take a small one's bits for a number too small to keep.
namespace catoptric::render {

std::vector<vec4> texels_of(std::span<const shared::Surface> surfaces);
std::vector<vec4> texels_of(std::span<const shared::Probe> probes);

} // namespace catoptric::render
