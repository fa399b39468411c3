#pragma once

#include "bvh/bvh.hpp"
#include "render/geometry.hpp"

#include <cstddef>

/// Rays on the CPU through what the device holds.
namespace catoptric::app {

/// Hierarchy over all objects but one; `left_out` = number of objects: over all.
bvh::Bvh hierarchy_without(const render::Geometry& geometry, std::size_t left_out);

/// The camera's ray through the middle of a pixel, counted row by row.
f32::Ray camera_ray(const shared::View& view, uvec2 size, std::size_t pixel);

} // namespace catoptric::app
