#pragma once

#include "scene/scene.hpp"

namespace catoptric::scene {

/// Kind of surface of an object, independent of its material.
struct MirrorShape {
    enum class Kind { flat, sphere, convex, concave, other };
    Kind kind = Kind::other;
    bool is_closed = false; ///< every edge belongs to two triangles
    /// Sphere that fits the vertices, also of an open surface. `tolerance` is the largest distance
    /// of a vertex from this sphere, in radii. Facets may lie farther inside.
    std::optional<Sphere> fit;
    double tolerance = 0;
};

/// Returns the shape of the object's triangles in the world, at rest. Vertices at one place count
/// as one. O(n log n).
///   - Flat: all triangles lie in a plane and face one way, within 1e-4 of their extent.
///   - Sphere: closed; vertices within 1e-3 radii of the sphere, facets within .1 radii, normals
///     within .01 radian of the sphere's radii.
///   - Convex, concave: a part of a sphere, or at least 95 % of the edges' bending (angle times
///     length) goes that way, seen from the front.
MirrorShape classify_shape(const Scene& scene, const Object& object);

/// Sets Object::sphere of each mirror that classify_shape calls a sphere. Rays then intersect the
/// exact sphere. Mirrors that have a sphere keep it. A mirror that a rig stretches into an
/// ellipsoid at some time gets none, nor does glass, in which rays run inside. A mirror that is no
/// ball is rejected in O(vertices) at most.
void find_exact_spheres(Scene& scene);

/// Returns "flat", "sphere", "convex", "concave" or "other".
const char* shape_name(MirrorShape::Kind kind);

} // namespace catoptric::scene
