#pragma once

#include "require/model.hpp"

#include <array>

/// Visibility tests for a camera's picture and for the faces of a capture.
namespace catoptric::require {

/// The volume that a picture shows: in front of the eye and between the picture's four sides. An
/// orthographic picture also holds a box that lies only partly in front of the eye's plane.
class PictureFrustum {
public:
    PictureFrustum(const scene::Camera& camera, uvec2 size);

    const dvec3& eye() const { return eye_; }
    const dvec3& forward() const { return forward_; }
    bool is_orthographic() const { return is_orthographic_; }
    /// Returns whether the camera's view volume may contain a part of the box. Returns false if all
    /// corners of the box lie beyond one of the five planes that bound the view volume.
    bool may_contain_box(const Bounds<double>& box) const;
    /// Returns false if no point of the triangle is inside. The planes are moved outwards by
    /// `margin`, in world units.
    bool may_contain_triangle(const std::array<dvec3, 3>& triangle, double margin) const;
    /// Returns false if the ball is certainly outside.
    bool may_contain_ball(const dvec3& centre, double radius) const;
    /// Returns the angle between neighbouring pixels on the axis, in radians. In an orthographic
    /// picture, this is the angle of a pixel's width at `distance`.
    double pixel_angle(double distance) const;

private:
    dvec3 eye_, forward_;
    double pixel_ =
        0; ///< width of a pixel in world units: at distance 1, or anywhere if orthographic
    bool is_orthographic_ = false;
    /// The five planes of the view volume: inward normal, and the distance by which a box may lie
    /// beyond the plane through the eye.
    std::array<std::pair<dvec3, double>, 5> planes_;
};

/// Returns the faces of a capture at the origin that may show some of the box. Each face tests the
/// four planes between it and its neighbours. An empty box meets no face.
FaceBits faces_showing_box(const Bounds<double>& box);

/// Returns the faces that may show some of a ball.
FaceBits faces_showing_ball(const dvec3& centre, double radius);

/// Returns the faces that may show some of the hull of a and b.
FaceBits faces_showing_hull(const Bounds<double>& a, const Bounds<double>& b);

/// Returns the faces with at least one direction whose product with the normal is above -`sine`.
/// These faces may show what a viewer in front of the plane sees mirrored in it.
FaceBits faces_in_front(const dvec3& normal, double sine);

} // namespace catoptric::require
