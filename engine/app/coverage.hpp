#pragma once

#include "render/geometry.hpp"
#include "render/views.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace catoptric::app {

/// Returns the object that the ray through each pixel's centre meets first, row by row (-1: none),
/// as the walk of a tree does, without one: each triangle is tested for the pixels of its bounds
/// on the screen. Costs a projection for each triangle, and 32 bytes a pixel. None where that
/// would take more than `most_tests` tests, as many large triangles behind each other do.
std::optional<std::vector<int>> objects_covering(const render::Geometry& geometry,
                                                 const shared::View& view, uvec2 size,
                                                 std::uint64_t most_tests);

} // namespace catoptric::app
