#pragma once

#include "bvh/bvh.hpp"

namespace catoptric::bvh {

/// Which triangles with equal corners and flags count as copies where many share a centre.
enum class CopyHandling {
    of_object, ///< triangles of the same object, as in `build_bvh`
    of_all     ///< triangles of all objects, except kMasked and kSphere ones, whose object matters
};

/// Builds a hierarchy as `build_bvh` of bvh/bvh.hpp does. Of several copies, the lowest number
/// stays, because that is the one that a ray hits. Do not refit a tree that left out copies across
/// objects once one of these objects moves.
Bvh build_bvh(std::span<const Triangle> triangles, const Bounds<float>& core, CopyHandling copies,
              std::uint32_t leaf = kMaxLeaf, unsigned threads = 0);

} // namespace catoptric::bvh
