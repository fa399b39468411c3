#pragma once

#include "render/geometry.hpp"
#include "render/views.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace catoptric::session {

/// Returns the object that the ray through each pixel's centre meets first, row by row (-1: none).
/// The result equals that of tracing through a BVH, but no BVH is needed. Each triangle is tested
/// for the pixels of its bounds on the screen. Costs a projection per triangle, and 52 bytes per
/// pixel. Returns nothing if more than `most_tests` tests were needed, as for many large triangles
/// behind each other.
std::optional<std::vector<int>> find_first_objects(const render::FrameGeometry& geometry,
                                                   const shared::View& view, uvec2 size,
                                                   std::uint64_t most_tests);

} // namespace catoptric::session
