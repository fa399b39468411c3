#pragma once

#include "bvh/bvh.hpp"

namespace catoptric::bvh {

/// A tree in an object space and its placement: scene = centre + scene_from_own * own.
struct BvhInstance {
    const Bvh* tree = nullptr; ///< built without a core; several instances may share it
    dmat3 scene_from_own{1};   ///< invertible
    dvec3 centre{0};           ///< scene units
    std::uint32_t object = 0;
    std::uint32_t flags = 0; ///< replace the flags of its triangles
    std::uint32_t shift = 0; ///< added to the triangle numbers
    /// Radius of the exact sphere that replaces the mesh, object space; 0: no exact sphere.
    float radius = 0;
};

/// Returns the rounding error of each component when it becomes a float, itself rounded to float.
vec3 float_rounding_error(const dvec3& v);

/// Returns how much a matrix and its inverse together may amplify roundings: the largest row sum of
/// |m| |m^-1|. The value is 1 for a scale, at most 3 for a rotation and infinite for a singular
/// matrix.
double rounding_amplification(const dmat3& matrix);

/// Builds the tree of a scene in which some objects have an object space. The root has two
/// children: the flat tree, and a top-level tree with one instance in each leaf. A word with the
/// count kBvhInstanceMarker stands for an instance. Its index is the first of kBvhNodesPerInstance
/// nodes, the record of the instance (texels; w holds a word's bits, except for the radius):
///   0..2  rows of own_from_scene; w: root of the instance's tree, object, shift
///   3     centre; w: flags          7  rounding error of the centre as floats
///   4..6  columns of scene_from_own
///   8, 9  bounds lo, hi in object space; w of 9: radius
/// Texel 2 of the header holds the factor by which the walk widens boxes. The transform of a ray
/// into object space adds roundings relative to its distance, and the way back amplifies them.
/// Without instances, returns `flat` unchanged.
Bvh assemble_two_level(const Bvh& flat, std::span<const BvhInstance> instances);

} // namespace catoptric::bvh
