#pragma once

#include "bvh/bvh.hpp"

namespace catoptric::bvh {

/// Among which triangles copies are looked for, if many triangles have one centre. Copies have
/// equal corners and flags.
enum class DuplicateTriangleSearchScope {
    within_object, ///< triangles of the same object, as in `build_bvh`
    across_objects ///< triangles of all objects, except kAlphaMaskedFlag, kTintsShadowFlag and
                   ///< kTriangleApproximatesSphereFlag ones, whose object matters
};

/// Builds a hierarchy as `build_bvh` of bvh/bvh.hpp does. Of several copies, the lowest number
/// stays, because that is the one that a ray hits. Do not refit a tree that left out copies across
/// objects once one of these objects moves.
Bvh build_bvh(std::span<const Triangle> triangles, const Bounds<float>& core,
              DuplicateTriangleSearchScope copies, std::uint32_t leaf = kMaxLeafTriangles,
              unsigned threads = 0);

} // namespace catoptric::bvh
