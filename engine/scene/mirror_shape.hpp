#pragma once

#include "scene/scene.hpp"

namespace catoptric::scene {

/// What kind of surface an object is, whatever it is made of.
struct Shape {
    enum class Kind { flat, sphere, convex, concave, other };
    Kind kind = Kind::other;
    bool is_closed = false; ///< every edge is one of two triangles
    /// Of a sphere, closed or not: the fit, and how far a vertex is from it at most, in radii. Its
    /// facets may lie farther inside.
    std::optional<Sphere> fit;
    double tolerance = 0;
};

/// Of the object's triangles in the world, at rest; vertices at one place are one. Flat: all lie in
/// a plane and face one way, within 1e-4 of their extent. Sphere: closed, vertices within 1e-3
/// radii of one, facets within .1 and normals within .01 radian of its radii. Convex, concave:
/// every edge bends that way, seen from the front. O(n log n).
Shape shape_of(const Scene& scene, const Object& object);

/// Gives each mirror that shape_of calls a sphere Object::sphere, by which rays are followed
/// exactly; those that have one keep it. Not a mirror that a rig moves, whose scale may change.
/// What is no ball is told in O(vertices) at most.
void find_spheres(Scene& scene);

/// "flat", "sphere", "convex", "concave" or "other".
const char* name_of(Shape::Kind kind);

} // namespace catoptric::scene
