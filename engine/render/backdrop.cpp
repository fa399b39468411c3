#include "render/backdrop.hpp"

#include "core/shader_math.hpp"
#include <algorithm>

namespace catoptric::render {

namespace {

constexpr std::uint32_t kMaxBackdropTriangles =
    64; ///< the most triangles of an object that is tested
constexpr std::size_t kMaxBackdropTests = 1
                                          << 22; ///< the most tests of boxes and vertices, in total
/// Tolerance for points behind a triangle's plane, as a fraction of the triangle's largest
/// coordinate: sixteen rounding errors. The tolerance does not depend on the extent of the scene,
/// because the height of a small object may be tiny compared with it.
constexpr double kCoplanarTolerance = 0x1p-20;

struct BackdropPlane {
    dvec3 normal; ///< unit length, towards the light
    double at;
    double room; ///< points up to this far behind the plane count as in it
    double distance_behind(const dvec3& point) const { return at - dot(normal, point); }
};

/// Returns how far the farthest corner of the box lies behind the plane.
double max_distance_behind(const BackdropPlane& plane, const Bounds<float>& box) {
    const dvec3 corner(plane.normal.x < 0 ? box.hi.x : box.lo.x,
                       plane.normal.y < 0 ? box.hi.y : box.lo.y,
                       plane.normal.z < 0 ? box.hi.z : box.lo.z);
    return plane.distance_behind(corner);
}

class BackdropSearch {
public:
    BackdropSearch(const FrameGeometry& geometry, const shared::Light& light)
        : geometry_(geometry), light_(light) {}

    bool is_backdrop(const DrawRange& range) {
        if (range.own || range.index_count > 3 * kMaxBackdropTriangles) return false;
        for (std::uint32_t k = 0; k < range.index_count; k += 3)
            if (!is_all_in_front(range.first_index + k)) return false;
        return true;
    }

private:
    /// Returns whether all geometry lies on the light's side of the triangle's plane.
    bool is_all_in_front(std::uint32_t first_index) {
        const auto corner = [&](std::uint32_t j) {
            return dvec3(geometry_.vertices[geometry_.indices[first_index + j]].position);
        };
        const dvec3 across = cross(corner(1) - corner(0), corner(2) - corner(0));
        const double size = length(across);
        if (!(size > 0)) return true; // a triangle without area casts no shadow
        BackdropPlane plane{across / size, 0, 0};
        plane.at = dot(plane.normal, corner(0));
        for (std::uint32_t j = 0; j < 3; ++j)
            plane.room = std::max(plane.room, kCoplanarTolerance * f64::largest_vector_component(
                                                                       glm::abs(corner(j))));
        const double height = light_.kind == shared::kLightKindDirectional
                                  ? -dot(plane.normal, dvec3(light_.forward))
                                  : -plane.distance_behind(dvec3(light_.position));
        if (height == 0) return true; // edge-on to the light, so it casts no shadow
        if (height < 0) plane = {-plane.normal, -plane.at, plane.room};
        return std::ranges::all_of(geometry_.ranges, [&](const DrawRange& other) {
            return ++looks_ < kMaxBackdropTests &&
                   (max_distance_behind(plane, other.bounds) <= plane.room ||
                    vertices_in_front(plane, other));
        });
    }

    bool vertices_in_front(const BackdropPlane& plane, const DrawRange& range) {
        looks_ += range.index_count;
        if (range.own || looks_ >= kMaxBackdropTests) return false;
        for (std::uint32_t k = 0; k < range.index_count; ++k) {
            const auto& vertex = geometry_.vertices[geometry_.indices[range.first_index + k]];
            if (!(plane.distance_behind(dvec3(vertex.position)) <= plane.room)) return false;
        }
        return true;
    }

    const FrameGeometry& geometry_;
    const shared::Light& light_;
    std::size_t looks_ = 0;
};

} // namespace

std::vector<std::uint8_t> find_backdrops(const FrameGeometry& geometry,
                                         const shared::Light& light) {
    BackdropSearch search(geometry, light);
    std::vector<std::uint8_t> backdrops;
    for (const DrawRange& range : geometry.ranges)
        backdrops.push_back(range.casts_shadow && search.is_backdrop(range) ? 1 : 0);
    return backdrops;
}

} // namespace catoptric::render
