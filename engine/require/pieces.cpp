#include "require/pieces.hpp"

#include "core/shader_math.hpp"
#include "require/wall.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

namespace catoptric::require {

namespace {

constexpr double kUnboundedSlope = std::numeric_limits<double>::infinity();

/// The least s in [-1, 1] with aside <= s * ahead for all points. It is 1 if no such s exists.
class HullSlope {
public:
    void add(double aside, double ahead) {
        if (ahead > 0)
            least_ = std::max(least_, aside / ahead);
        else if (ahead < 0)
            most_ = std::min(most_, aside / ahead);
        else if (aside > 0)
            most_ = -kUnboundedSlope;
    }
    double value() const { return least_ <= most_ ? std::clamp(least_, -1., 1.) : 1; }
    /// Returns whether the hull ahead lies entirely beyond the opposite edge of the face, at -1.
    bool is_outside() const { return least_ <= most_ && least_ < -1; }

private:
    double least_ = -kUnboundedSlope, most_ = kUnboundedSlope;
};

auto sort_key_of_piece(const FacePiece& piece) {
    const FacePart& part = piece.part;
    return std::tuple(piece.content_hash, part.low.x, part.low.y, part.high.x, part.high.y);
}

} // namespace

FacePart intersect_face_parts(const FacePart& a, const FacePart& b) {
    return {max(a.low, b.low), min(a.high, b.high)};
}

FacePart unite_face_parts(const FacePart& a, const FacePart& b) {
    if (a.empty()) return b;
    if (b.empty()) return a;
    return {min(a.low, b.low), max(a.high, b.high)};
}

FacePart face_part_containing(int face, std::span<const dvec3> places) {
    const dvec3 right = f64::cube_direction(face, dvec3(1, 0, 0)),
                down = f64::cube_direction(face, dvec3(0, 1, 0)),
                forward = f64::cube_direction(face, dvec3(0, 0, 1));
    std::array<HullSlope, 4> slopes; // right, left, down, up
    for (const dvec3& place : places) {
        const double ahead = dot(forward, place), x = dot(right, place), y = dot(down, place);
        slopes[0].add(x, ahead), slopes[1].add(-x, ahead);
        slopes[2].add(y, ahead), slopes[3].add(-y, ahead);
    }
    if (std::ranges::any_of(slopes, &HullSlope::is_outside)) return kEmptyFacePart;
    return {dvec2(-slopes[1].value(), -slopes[3].value()),
            dvec2(slopes[0].value(), slopes[2].value())};
}

FacePart face_part_containing(int face, const Bounds<double>& box) {
    return face_part_containing(face, list_box_corners(box));
}

FacePart face_part_containing(int face, const Bounds<double>& a, const Bounds<double>& b) {
    std::array<dvec3, 16> corners;
    std::ranges::copy(list_box_corners(b),
                      std::ranges::copy(list_box_corners(a), corners.begin()).out);
    return face_part_containing(face, corners);
}

void FacePieces::sort_pieces() {
    for (std::vector<FacePiece>& pieces : faces) std::ranges::sort(pieces, {}, sort_key_of_piece);
}

FacePart find_differing_part(std::span<const FacePiece> before, std::span<const FacePiece> after) {
    FacePart part = kEmptyFacePart;
    for (std::size_t i = 0, k = 0; i < before.size() || k < after.size();) {
        const bool ends = i == before.size() || k == after.size();
        if (!ends && sort_key_of_piece(before[i]) == sort_key_of_piece(after[k])) {
            ++i, ++k;
            continue;
        }
        const bool is_before = k == after.size() ||
                               (i < before.size() &&
                                sort_key_of_piece(before[i]) < sort_key_of_piece(after[k]));
        part = unite_face_parts(part, (is_before ? before[i++] : after[k++]).part);
    }
    return part;
}

} // namespace catoptric::require
