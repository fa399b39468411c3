#pragma once

#include "bvh/bvh.hpp"

namespace catoptric::bvh {

/// A tree in a space of its own, and where it stands: scene = centre + scene_from_own * own.
struct Instance {
    const Bvh* tree = nullptr; ///< built without a core; may be shared
    dmat3 scene_from_own{1};   ///< invertible
    dvec3 centre{0};           ///< scene units
    std::uint32_t object = 0;
    std::uint32_t flags = 0; ///< in place of those of its triangles
    std::uint32_t shift = 0; ///< added to the numbers of its triangles
    float radius = 0;        ///< own units, of the exact sphere it stands for; 0: none
};

/// What each number lacks once it is rounded to a float, itself rounded.
vec3 low_part(const dvec3& v);

/// How much a matrix and its inverse together may stretch roundings: the largest sum of a row of
/// |m| |m^-1|; 1 for a scale, at most 3 for a turn, infinite without an inverse.
double stretch(const dmat3& matrix);

/// The tree of a scene in which some things have a space of their own, to be walked as one: the
/// root has the flat tree and a tree over the instances, with one in a leaf. A word with the count
/// kBvhEnters stands for an instance; its index is the node at which kBvhRecordNodes nodes say
/// where it stands (texels; w is a word's bits but for the radius):
///   0..2  rows of own_from_scene; root of its tree, object, shift
///   3     centre; flags             7  what the centre lacks as a sum of two floats
///   4..6  columns of scene_from_own
///   8, 9  own bounds lo, hi; w of 9: radius
/// Texel 2 of the header says how many times wider boxes are: a ray is turned into own units with
/// roundings relative to its distance, and stretched ones come back.
/// Without instances: `flat` as it is.
Bvh assemble(const Bvh& flat, std::span<const Instance> instances);

} // namespace catoptric::bvh
