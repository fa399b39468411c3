#pragma once

#include "require/model.hpp"

#include <array>

/// What a camera's picture and the faces of a capture can hold.
namespace catoptric::require {

/// The inside of a picture: before its eye and between its four sides. Of an orthographic one also
/// a box that stands before its eye's plane in part.
class Picture {
public:
    Picture(const scene::Camera& camera, uvec2 size);

    const dvec3& eye() const { return eye_; }
    const dvec3& forward() const { return forward_; }
    bool is_parallel() const { return is_parallel_; }
    /// False when the box is certainly outside: all of its corners beyond one of the five planes.
    bool may_hold(const Bounds<double>& box) const;
    /// Returns false when no place of the triangle is inside, with planes moved out by `margin`,
    /// world units.
    bool may_hold_triangle(const std::array<dvec3, 3>& triangle, double margin) const;
    /// Returns false when the ball is certainly outside.
    bool may_hold_ball(const dvec3& centre, double radius) const;
    /// Angle between neighbouring pixels on the axis; of an orthographic picture that of a pixel's
    /// width at `distance`.
    double pixel_angle(double distance) const;

private:
    dvec3 eye_, forward_;
    double pixel_ = 0; ///< width of one: at distance 1, or anywhere
    bool is_parallel_ = false;
    /// Inward normals with how far the box may lie beyond the plane through the eye.
    std::array<std::pair<dvec3, double>, 5> planes_;
};

/// The faces of a capture from the origin that may hold some of the box: for each the four planes
/// between it and its neighbours. Half of an empty box's infinities: none.
Faces faces_with(const Bounds<double>& box);

/// Those that may hold some of a ball.
Faces faces_with(const dvec3& centre, double radius);

/// Those that may hold some of hull(a, b).
Faces faces_with(const Bounds<double>& a, const Bounds<double>& b);

/// The faces, at least one direction of which has a positive product with the normal, or one that
/// is at most `sine` below zero: those that who stands before a plane may see mirrored in it.
Faces faces_before(const dvec3& normal, double sine);

} // namespace catoptric::require
