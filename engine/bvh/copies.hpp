#pragma once

#include "bvh/bvh.hpp"

namespace catoptric::bvh {

/// Among which triangles copies are looked for, if many triangles have one centre. Copies have
/// equal corners and flags.
enum class CopyScope {
    within_object, ///< triangles of the same object, as in `build`
    across_objects ///< triangles of all objects, except kAlphaMaskedFlag, kTintsShadowFlag and
                   ///< kStandsForSphereFlag ones, whose object matters
};

/// Builds a hierarchy as `build` of bvh/bvh.hpp does. Of several copies, the lowest number
/// stays, because that is the one that a ray hits. Do not refit a tree that left out copies across
/// objects once one of these objects moves.
Bvh build(std::span<const Triangle> triangles, const Bounds<float>& core, CopyScope copies,
          std::uint32_t leaf = kMaxLeafTriangles, unsigned threads = 0);

} // namespace catoptric::bvh
