#pragma once

#include "render/geometry.hpp"

#include <span>

namespace catoptric::render {

/// Returns, for each mirror, the texels that the edge of its cube needs (render/footprint.hpp). The
/// camera is at `eye` and draws a picture of `height` rows. A mirror outside the picture needs 0. A
/// rough mirror needs no more than its lobe does, unless a texture varies its roughness.
/// `mirrors`: object indices; `probes` in the same order. Costs O(triangles of mirrors).
std::vector<double> find_needed_edges(const FrameGeometry& geometry,
                                      std::span<const std::size_t> mirrors,
                                      std::span<const shared::Probe> probes,
                                      const shared::View& camera, const dvec3& eye,
                                      std::uint32_t height);

} // namespace catoptric::render
