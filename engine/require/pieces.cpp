#include "require/pieces.hpp"

#include "core/shader_math.hpp"
#include "require/wall.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

namespace catoptric::require {

namespace {

constexpr double kUnboundedSlope = std::numeric_limits<double>::infinity();

/// Finds the smallest slope s in [-1, 1] with aside <= s * ahead for all points. The result is 1 if
/// no such s exists.
class LeastSlope {
public:
    void add_point(double aside, double ahead) {
        if (ahead > 0)
            least_ = std::max(least_, aside / ahead);
        else if (ahead < 0)
            most_ = std::min(most_, aside / ahead);
        else if (aside > 0)
            most_ = -kUnboundedSlope;
    }
    double slope() const { return least_ <= most_ ? std::clamp(least_, -1., 1.) : 1; }
    /// Returns whether the whole hull lies beyond the opposite edge of the face (slope -1), and is
    /// therefore not visible in the face.
    bool is_beyond_face() const { return least_ <= most_ && least_ < -1; }

private:
    double least_ = -kUnboundedSlope, most_ = kUnboundedSlope;
};

auto sort_key(const MovingPart& piece) {
    const FacePart& part = piece.part;
    return std::tuple(piece.content_hash, part.low.x, part.low.y, part.high.x, part.high.y);
}

} // namespace

FacePart intersect(const FacePart& a, const FacePart& b) {
    return {max(a.low, b.low), min(a.high, b.high)};
}

FacePart unite(const FacePart& a, const FacePart& b) {
    if (a.is_empty()) return b;
    if (b.is_empty()) return a;
    return {min(a.low, b.low), max(a.high, b.high)};
}

FacePart face_part_containing(int face, std::span<const dvec3> places) {
    const dvec3 right = f64::cube_direction(face, dvec3(1, 0, 0)),
                down = f64::cube_direction(face, dvec3(0, 1, 0)),
                forward = f64::cube_direction(face, dvec3(0, 0, 1));
    std::array<LeastSlope, 4> slopes; // slopes to the right, left, down and up
    for (const dvec3& place : places) {
        const double ahead = dot(forward, place), x = dot(right, place), y = dot(down, place);
        slopes[0].add_point(x, ahead), slopes[1].add_point(-x, ahead);
        slopes[2].add_point(y, ahead), slopes[3].add_point(-y, ahead);
    }
    if (std::ranges::any_of(slopes, &LeastSlope::is_beyond_face)) return kEmptyFacePart;
    return {dvec2(-slopes[1].slope(), -slopes[3].slope()),
            dvec2(slopes[0].slope(), slopes[2].slope())};
}

FacePart face_part_containing(int face, const Bounds<double>& box) {
    return face_part_containing(face, box_corners(box));
}

FacePart face_part_containing(int face, const Bounds<double>& a, const Bounds<double>& b) {
    std::array<dvec3, 16> corners;
    std::ranges::copy(box_corners(b), std::ranges::copy(box_corners(a), corners.begin()).out);
    return face_part_containing(face, corners);
}

void MovingParts::sort() {
    for (std::vector<MovingPart>& pieces : faces) std::ranges::sort(pieces, {}, sort_key);
}

FacePart find_changed_part(std::span<const MovingPart> before, std::span<const MovingPart> after) {
    FacePart part = kEmptyFacePart;
    for (std::size_t i = 0, k = 0; i < before.size() || k < after.size();) {
        const bool ends = i == before.size() || k == after.size();
        if (!ends && sort_key(before[i]) == sort_key(after[k])) {
            ++i, ++k;
            continue;
        }
        const bool is_before = k == after.size() ||
                               (i < before.size() && sort_key(before[i]) < sort_key(after[k]));
        part = unite(part, (is_before ? before[i++] : after[k++]).part);
    }
    return part;
}

} // namespace catoptric::require
