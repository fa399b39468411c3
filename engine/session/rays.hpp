#pragma once

#include "bvh/bvh.hpp"
#include "render/geometry.hpp"

#include <cstddef>

/// Traces rays on the CPU through the geometry that the device holds.
namespace catoptric::session {

/// Builds a BVH over all objects but `left_out`. `left_out` = number of objects: over all.
bvh::Bvh build_bvh_without(const render::FrameGeometry& geometry, std::size_t left_out);

/// Returns the camera's ray through the centre of a pixel. Pixels count row by row.
f32::Ray make_camera_ray(const shared::View& view, uvec2 size, std::size_t pixel);

} // namespace catoptric::session
