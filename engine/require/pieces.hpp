#pragma once

#include "core/math.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// Which part of a capture's face it is that changes when something moves.
namespace catoptric::require {

/// A rectangle of a face: what lies right and down of its middle over what lies ahead, each from -1
/// to 1, along the axes of f64::cube_direction.
struct FacePart {
    dvec2 low{-1}, high{1};
    bool operator==(const FacePart&) const = default;
    bool empty() const { return !(low.x <= high.x && low.y <= high.y); }
    bool is_whole() const { return *this == FacePart(); }
};
inline constexpr FacePart kNoPart{dvec2(1), dvec2(-1)};

/// What lies in both.
FacePart common(const FacePart& a, const FacePart& b);
/// The smallest that holds both.
FacePart united(const FacePart& a, const FacePart& b);

/// Holds what the face shows of the hull of places, relative to the capture's centre. A line
/// through the centre that has none of the places to its left has nothing of their hull there, so
/// the smallest slopes with that property bound it; they are those of places ahead, unless what
/// lies behind says that there is none. O(places).
FacePart part_with(int face, std::span<const dvec3> places);
/// Of a box, and of the hull of two.
FacePart part_with(int face, const Bounds<double>& box);
FacePart part_with(int face, const Bounds<double>& a, const Bounds<double>& b);

/// A mover, or one's shadow on something, where a face may show it.
struct Piece {
    std::uint64_t content_hash = 0; ///< equal, and so is what it looks like
    FacePart part;
};

/// More of them in a face are not told apart.
inline constexpr std::size_t kMostPieces = 64;

/// Of a capture's faces.
struct Pieces {
    std::array<std::vector<Piece>, 6> faces;
    void sort(); ///< as `differing` wants them
};

/// Holds whatever only one of two states of a face has. Both sorted. O(pieces).
FacePart differing(std::span<const Piece> before, std::span<const Piece> after);

} // namespace catoptric::require
