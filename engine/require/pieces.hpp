#pragma once

#include "core/math.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// Finds which part of a capture's face changes when an object moves.
namespace catoptric::require {

/// A rectangle of a face. Coordinates are right and down divided by depth, from -1 to 1, along the
/// axes of f64::cube_direction.
struct FacePart {
    dvec2 low{-1}, high{1};
    bool operator==(const FacePart&) const = default;
    bool is_empty() const { return !(low.x <= high.x && low.y <= high.y); }
    bool is_whole() const { return *this == FacePart(); }
};
inline constexpr FacePart kEmptyFacePart{dvec2(1), dvec2(-1)};

FacePart intersect(const FacePart& a, const FacePart& b);
/// Returns the smallest rectangle that contains both rectangles.
FacePart unite(const FacePart& a, const FacePart& b);

/// Returns a rectangle of the capture's face that contains the projection of the convex hull of the
/// points. Points are relative to the capture's centre. O(points).
///
/// Consider a line through the centre. If no point lies to its left, nothing of the hull lies
/// there. The smallest slopes with this property bound the hull. Points ahead of the centre
/// determine these slopes. If points behind it rule out any such slope, the side is unbounded.
FacePart face_part_containing(int face, std::span<const dvec3> places);
/// Returns a rectangle of the capture's face that contains the projection of a box, or of the
/// convex hull of two boxes.
FacePart face_part_containing(int face, const Bounds<double>& box);
FacePart face_part_containing(int face, const Bounds<double>& a, const Bounds<double>& b);

/// A mover, or the shadow of a mover on an object, that a face may show.
struct MovingPart {
    std::uint64_t content_hash = 0; ///< equal hashes stand for equal looks
    FacePart part;
};

/// Largest number of pieces (moving objects and shadows) that are stored per face. If a face has
/// more pieces, none are stored for the capture.
inline constexpr std::size_t kMaxMovingParts = 64;

/// The pieces in each face of a capture.
struct MovingParts {
    std::array<std::vector<MovingPart>, 6> faces;
    void sort(); ///< sorts the pieces in the order that `find_changed_part`
                 ///< needs
};

/// Compares the moving objects and shadows (pieces) that a face shows in two frames. Returns a
/// rectangle that contains all pieces that only one of the two lists has. Both lists must be
/// sorted. O(pieces).
FacePart find_changed_part(std::span<const MovingPart> before, std::span<const MovingPart> after);

} // namespace catoptric::require
