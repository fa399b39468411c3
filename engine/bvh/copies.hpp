#pragma once

#include "bvh/bvh.hpp"

namespace catoptric::bvh {

/// Which triangles with the same corners and flags count as one where many lie in one place.
enum class Copies {
    of_object, ///< those of one object, as `build` does
    of_all     ///< those of all objects, but for kMasked and kSphere ones, which objects tell apart
};

/// As `build` of bvh/bvh.hpp. Of several copies the lowest number is kept, which is the one that a
/// ray meets. A tree that left out copies of all objects must not be refitted when one of these
/// moves.
Bvh build(std::span<const Triangle> triangles, const Bounds<float>& core, Copies copies,
          std::uint32_t leaf = kMaxLeaf, unsigned threads = 0);

} // namespace catoptric::bvh
