#include "require/frustum.hpp"

#include <algorithm>
#include <cmath>

namespace catoptric::require {

namespace {

dvec3 farthest_corner(const Bounds<double>& box, const dvec3& normal) {
    return {normal.x > 0 ? box.hi.x : box.lo.x, normal.y > 0 ? box.hi.y : box.lo.y,
            normal.z > 0 ? box.hi.z : box.lo.z};
}

} // namespace

PictureFrustum::PictureFrustum(const scene::Camera& camera, uvec2 size) : eye_(camera.eye) {
    forward_ = normalize(camera.target - camera.eye);
    const dvec3 right = normalize(cross(forward_, camera.up)), down = cross(forward_, right);
    const double aspect = static_cast<double>(size.x) / static_cast<double>(size.y);
    is_orthographic_ = camera.orthographic_height > 0;
    const double half = is_orthographic_ ? camera.orthographic_height / 2
                                         : std::tan(glm::radians(camera.vertical_fov_degrees) / 2);
    pixel_ = 2 * half / size.y;
    // A point is inside if it lies in front of the eye and |right| <= half * aspect. For a
    // perspective camera, this limit is multiplied by the depth.
    const dvec3 along = is_orthographic_ ? dvec3(0) : forward_;
    const double beyond = is_orthographic_ ? 1 : 0;
    planes_[0] = {forward_, 0};
    planes_[1] = {half * aspect * along + right, beyond * half * aspect};
    planes_[2] = {half * aspect * along - right, beyond * half * aspect};
    planes_[3] = {half * along + down, beyond * half};
    planes_[4] = {half * along - down, beyond * half};
}

bool PictureFrustum::may_contain_box(const Bounds<double>& box) const {
    return std::ranges::none_of(planes_, [&](const auto& plane) {
        return dot(plane.first, farthest_corner(box, plane.first) - eye_) < -plane.second;
    });
}

/// Clips the triangle by one plane after the other (Sutherland and Hodgman 1974).
bool PictureFrustum::may_contain_triangle(const std::array<dvec3, 3>& triangle,
                                          double margin) const {
    constexpr std::size_t kMaxClippedCorners = 3 + 5; // each plane adds at most one corner
    std::array<dvec3, kMaxClippedCorners> corners{triangle[0], triangle[1], triangle[2]}, kept;
    std::size_t count = 3;
    for (const auto& [normal, beyond] : planes_) {
        const double room = beyond + margin * length(normal);
        const auto inside = [&](const dvec3& p) { return dot(normal, p - eye_) + room; };
        std::size_t left = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const dvec3 &a = corners[i], &b = corners[(i + 1) % count];
            const double at_a = inside(a), at_b = inside(b);
            if (at_a >= 0) kept[left++] = a;
            if ((at_a >= 0) != (at_b >= 0)) kept[left++] = a + at_a / (at_a - at_b) * (b - a);
        }
        std::swap(corners, kept);
        count = left;
        if (count == 0) return false;
    }
    return true;
}

bool PictureFrustum::may_contain_ball(const dvec3& centre, double radius) const {
    return std::ranges::none_of(planes_, [&](const auto& plane) {
        return dot(plane.first, centre - eye_) + plane.second < -radius * length(plane.first);
    });
}

double PictureFrustum::pixel_angle(double distance) const {
    return is_orthographic_ ? pixel_ / distance : pixel_;
}

FaceBits faces_showing_box(const Bounds<double>& box) {
    FaceBits faces = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        // The face towards +a shows some of the box only if a point of the box has a >= |u| and a
        // >= |v|. Each of the four planes is tested separately.
        const double hi = box.hi[axis], lo = -box.lo[axis];
        const auto reaches = [&](double furthest) {
            return furthest >= 0 && furthest + box.hi[u] >= 0 && furthest - box.lo[u] >= 0 &&
                   furthest + box.hi[v] >= 0 && furthest - box.lo[v] >= 0;
        };
        if (reaches(hi)) faces |= static_cast<FaceBits>(1 << (2 * axis));
        if (reaches(lo)) faces |= static_cast<FaceBits>(2 << (2 * axis));
    }
    return faces;
}

FaceBits faces_showing_ball(const dvec3& centre, double radius) {
    FaceBits faces = 0;
    for (int face = 0; face < 6; ++face) {
        const double ahead = face % 2 == 0 ? centre[face / 2] : -centre[face / 2];
        const double aside = std::max(std::abs(centre[(face / 2 + 1) % 3]),
                                      std::abs(centre[(face / 2 + 2) % 3]));
        if (ahead - aside >= -std::sqrt(2.0) * radius) faces |= static_cast<FaceBits>(1 << face);
    }
    return faces;
}

FaceBits faces_showing_hull(const Bounds<double>& a, const Bounds<double>& b) {
    FaceBits faces = 0;
    for (int face = 0; face < 6; ++face) {
        dvec3 forward(0);
        forward[face / 2] = face % 2 == 0 ? 1 : -1;
        bool meets = true;
        for (int side = 0; side < 4 && meets; ++side) {
            dvec3 normal = forward;
            normal[(face / 2 + 1 + side / 2) % 3] = side % 2 == 0 ? 1 : -1;
            meets = dot(normal, farthest_corner(a, normal)) >= 0 ||
                    dot(normal, farthest_corner(b, normal)) >= 0;
        }
        if (meets) faces |= static_cast<FaceBits>(1 << face);
    }
    return faces;
}

FaceBits faces_in_front(const dvec3& normal, double sine) {
    FaceBits faces = 0;
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2;
        const double ahead = face % 2 == 0 ? normal[axis] : -normal[axis];
        // The largest product of the normal with directions of a face is the product with a corner
        // of the face, (1, +-1, +-1) with permuted axes.
        const double most = ahead + std::abs(normal[(axis + 1) % 3]) +
                            std::abs(normal[(axis + 2) % 3]);
        if (most > -sine * std::sqrt(3.0)) faces |= static_cast<FaceBits>(1 << face);
    }
    return faces;
}

} // namespace catoptric::require
