#pragma once

#include "embree_scene.hpp"

namespace peers {

/// What bvh::cost says of the binary tree that Embree's builder of this quality makes of the same
/// triangles, told our costs of nodes and triangles and the size of our leaves. RTC_BUILD_QUALITY_
/// HIGH splits triangles, too.
double embree_cost(const EmbreeDevice& device, std::span<const catoptric::bvh::Triangle> triangles,
                   RTCBuildQuality quality);

} // namespace peers
