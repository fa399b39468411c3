#pragma once

#include "render/geometry.hpp"

#include <span>

namespace catoptric::render {

/// Texels that the edge of each mirror's cube needs for a camera at `eye` with a picture of so many
/// rows (render/footprint.hpp); 0 for a mirror that is not in it. `mirrors`: their objects;
/// `probes` in the same order. O(triangles of mirrors).
std::vector<double> find_face_needs(const Geometry& geometry, std::span<const std::size_t> mirrors,
                                    std::span<const shared::Probe> probes,
                                    const shared::View& camera, const dvec3& eye,
                                    std::uint32_t height);

} // namespace catoptric::render
