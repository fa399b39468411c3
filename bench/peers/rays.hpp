#pragma once

#include "whitted.hpp"

#include <span>

/// Rays of a list, each to what it meets first. No header of the engine: see whitted.hpp.
namespace peers {

struct Ray {
    Vector origin, direction; ///< direction of length 1
};

struct Met {
    /// No triangle; none yet, also where our walk gave up.
    static constexpr std::uint32_t kNothing = 0xffffffff, kUntraced = 0xfffffffe;
    float t = 0;
    std::uint32_t triangle = kUntraced;
};
static_assert(sizeof(Met) == 8); // as shaders/rays.comp writes it

/// In a tree of triangles. `width`: rays in a call of Embree's, 1, 8 or 16, of which the list has a
/// multiple of 16. `threads` take runs of 256 from one counter.
std::vector<Met> meet(RTCScene tree, std::span<const Ray> rays, int width, int threads);

} // namespace peers
