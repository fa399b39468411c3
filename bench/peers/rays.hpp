#pragma once

#include "whitted.hpp"

#include <span>

/// Traces a list of rays, each to its first hit, with Embree. This header includes no header of the
/// engine, for the reason given in whitted.hpp.
namespace peers {

struct Ray {
    PeerVector3 origin, direction; ///< the direction has length 1
};

/// The first hit of a ray.
struct FirstRayHit {
    /// Values of `triangle` without a hit. kNoTriangle: the ray meets no triangle. kUntraced: the
    /// ray was not traced, or our walk stopped at its step limit.
    static constexpr std::uint32_t kNoTriangle = 0xffffffff, kUntraced = 0xfffffffe;
    float t = 0;
    std::uint32_t triangle = kUntraced;
};
static_assert(sizeof(FirstRayHit) == 8); // shaders/rays.comp writes two words

/// Returns the first hits of rays in Embree's tree of triangles. Each call to Embree traces `width`
/// rays: 1, 8 or 16. The number of rays must be a multiple of 16. Each of `threads` threads takes
/// runs of 256 rays from a shared counter.
std::vector<FirstRayHit> find_closest_hits_of_rays(RTCScene tree, std::span<const Ray> rays,
                                                   int width, int threads);

} // namespace peers
