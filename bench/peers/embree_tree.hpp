#pragma once

#include "embree_scene.hpp"

namespace peers {

/// Returns the cost, as bvh::sah_cost defines cost, of the binary tree that Embree's
/// builder makes of the triangles. The builder uses our costs of nodes and triangles and our
/// largest leaf size. With RTC_BUILD_QUALITY_HIGH the builder also splits triangles.
double compute_embree_bvh_sah_cost(const EmbreeDevice& device,
                                   std::span<const catoptric::bvh::Triangle> triangles,
                                   RTCBuildQuality quality);

} // namespace peers
