#pragma once

#include "core/math.hpp"
#include "shared.h"

#include <span>
#include <vector>

/// Lists of structures as texels of four floats, in the layout that shaders/lib/bindings.glsl
/// reads. Each structure takes shared::k...Texels texels in sequence. Integers are stored as words
/// (bvh/words.hpp), because a device may flush the bits of a small integer as a denormal float.
namespace catoptric::render {

std::vector<vec4> to_texels(std::span<const shared::Surface> surfaces);
std::vector<vec4> to_texels(std::span<const shared::Probe> probes);

} // namespace catoptric::render
