#include "import/obj_text.hpp"

#include <algorithm>

namespace catoptric::scene::obj {

namespace {

using glm::dvec2;

/// Projects a polygon's corners to two dimensions, along the axis in which its normal is longest.
/// The axes are ordered so that the result runs counter-clockwise.
std::vector<dvec2> project_to_plane(std::span<const Corner> polygon,
                                    const std::vector<dvec3>& positions) {
    const auto at = [&](std::size_t i) { return positions[polygon[i % polygon.size()].position]; };
    dvec3 normal(0); // Newell's normal: twice the projected area, for each axis
    for (std::size_t i = 0; i < polygon.size(); ++i)
        normal += glm::cross(at(i) - at(0), at(i + 1) - at(0));
    const dvec3 size = glm::abs(normal);
    const int axis = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    if (normal[axis] < 0) std::swap(u, v);
    std::vector<dvec2> points;
    for (std::size_t i = 0; i < polygon.size(); ++i) points.emplace_back(at(i)[u], at(i)[v]);
    return points;
}

/// Returns twice the signed area of the triangle a, b, c. It is above 0 if they turn left.
double twice_signed_area(const dvec2& a, const dvec2& b, const dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Triangulates by clipping ears: convex corners whose triangle holds no reflex corner (notch).
class EarClipper {
public:
    EarClipper(const std::vector<dvec2>& points, LimitedSum& comparisons, const Line& line)
        : points_(points), comparisons_(comparisons), line_(line), next_(points.size()),
          previous_(points.size()), left_(points.size()) {
        for (std::size_t i = 0; i < left_; ++i) {
            next_[i] = (i + 1) % left_, previous_[i] = (i + left_ - 1) % left_;
            if (is_reflex(i)) notches_.push_back(i);
        }
    }
    bool is_convex() const { return notches_.empty(); }

    /// Calls `body` with the three corners of each triangle.
    template <typename Body>
    void for_each_ear(Body&& body) {
        // `refused` counts corners in a row that are no ears. If none is left in a polygon that
        // crosses itself, any corner is clipped.
        std::size_t corner = 0, refused = 0;
        while (left_ >= 3) {
            const std::size_t before = previous_[corner], after = next_[corner];
            if (refused < left_ && !is_ear(corner)) {
                corner = after, ++refused;
                continue;
            }
            body(before, corner, after);
            next_[before] = after, previous_[after] = before;
            --left_, refused = 0;
            std::erase_if(notches_, [&](std::size_t i) {
                return i == corner || ((i == before || i == after) && !is_reflex(i));
            });
            comparisons_.add(notches_.size(), *line_.file, ":", line_.number);
            corner = after;
        }
    }

private:
    bool is_reflex(std::size_t i) const {
        return twice_signed_area(points_[previous_[i]], points_[i], points_[next_[i]]) < 0;
    }
    bool is_ear(std::size_t i) {
        comparisons_.add(notches_.size() + 1, *line_.file, ":", line_.number);
        const dvec2 &a = points_[previous_[i]], &b = points_[i], &c = points_[next_[i]];
        if (!(twice_signed_area(a, b, c) > 0)) return false;
        return std::ranges::none_of(notches_, [&](std::size_t k) {
            const dvec2& p = points_[k];
            if (p == a || p == b || p == c) return false;
            return twice_signed_area(a, b, p) >= 0 && twice_signed_area(b, c, p) >= 0 &&
                   twice_signed_area(c, a, p) >= 0;
        });
    }

    const std::vector<dvec2>& points_;
    LimitedSum& comparisons_;
    const Line& line_;
    std::vector<std::size_t> next_, previous_, notches_;
    std::size_t left_;
};

} // namespace

void triangulate(std::span<const Corner> polygon, const std::vector<dvec3>& positions,
                 LimitedSum& comparisons, const Line& line, std::vector<Corner>& triangles) {
    const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
        triangles.insert(triangles.end(), {polygon[a], polygon[b], polygon[c]});
    };
    if (polygon.size() == 3) return add(0, 1, 2);
    const std::vector<dvec2> points = project_to_plane(polygon, positions);
    EarClipper ears(points, comparisons, line);
    if (!ears.is_convex()) return ears.for_each_ear(add);
    const auto apart = [&](std::size_t a, std::size_t b) {
        return glm::distance(positions[polygon[a].position], positions[polygon[b].position]);
    };
    if (polygon.size() == 4 && !(apart(0, 2) < apart(1, 3))) return add(0, 1, 3), add(1, 2, 3);
    for (std::size_t i = 2; i < polygon.size(); ++i) add(0, i - 1, i);
}

} // namespace catoptric::scene::obj
