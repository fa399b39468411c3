#pragma once

#include "bvh/bvh.hpp"
#include "bvh/words.hpp"

#include <array>
#include <optional>
#include <type_traits>

/// The CPU version of the ray traversal in shaders/lib/trace.glsl: the same algorithm over the same
/// arrays, in float or double.
namespace catoptric::bvh {

template <typename Real>
using Vec3 = glm::vec<3, Real>;
template <typename Real>
using Ray = std::conditional_t<std::is_same_v<Real, float>, f32::Ray, f64::Ray>;

/// The first intersection of a ray. If triangles tie at the same t, the lowest original number
/// wins.
template <typename Real>
struct RayHit {
    Real t = 0;
    Vec3<Real> barycentric{0};  ///< weights of a, b, c
    std::uint32_t triangle = 0; ///< original number
    std::uint32_t object = 0;
    std::uint32_t place = 0; ///< index of the triangle in Bvh::triangles
    /// Record of the instance in whose object space the triangle lies; 0: none.
    std::uint32_t inside = 0;
    friend bool operator==(const RayHit&, const RayHit&) = default;
};

/// Counters of node visits and triangle tests.
struct TraversalCounters {
    std::size_t nodes = 0;
    std::size_t triangles = 0;
    std::size_t total() const { return nodes + triangles; }
};

namespace detail {

using f32::hits_back_face, f64::hits_back_face;
using f32::intersect_sphere_robustly, f64::intersect_sphere_robustly;
using f32::intersect_triangle_watertight, f64::intersect_triangle_watertight;
using f32::make_box_ray, f64::make_box_ray;
using f32::make_ray_shear, f64::make_ray_shear;
using f32::transform_ray_to_object_space, f64::transform_ray_to_object_space;

template <typename Real>
Vec3<Real> read_xyz(const vec4& texel) {
    return Vec3<Real>(vec3(texel));
}

template <typename Real>
using InstancePlacement =
    std::conditional_t<std::is_same_v<Real, float>, f32::ObjectPlacement, f64::ObjectPlacement>;

/// Returns the position and axes that an instance's record stores (see tlas.hpp).
template <typename Real>
InstancePlacement<Real> read_placement(const Bvh& bvh, std::uint32_t record) {
    const vec4* texel = &bvh.nodes[4 * std::size_t{record}];
    return {read_xyz<Real>(texel[0]), read_xyz<Real>(texel[1]), read_xyz<Real>(texel[2]),
            read_xyz<Real>(texel[4]), read_xyz<Real>(texel[5]), read_xyz<Real>(texel[6]),
            read_xyz<Real>(texel[3]), read_xyz<Real>(texel[7])};
}

/// The closest hit that the traversal has found, and the state that a triangle test needs.
template <typename Real>
struct ClosestHitSearch {
    const Bvh& bvh;
    Ray<Real> ray; ///< the ray in the coordinates of the tree that is traversed at the moment
    Real t_max;    ///< exclusive; shrinks to the closest hit
    std::uint32_t skipped_flags;
    std::optional<RayHit<Real>> best{};
    decltype(make_ray_shear(Vec3<Real>{})) shear = make_ray_shear(ray.direction);
    std::uint32_t record = 0;

    /// Continues the traversal in the tree of an instance's record, or returns to the tree above
    /// (record 0).
    void enter(std::uint32_t into, const Ray<Real>& as_it_sees_it) {
        record = into, ray = as_it_sees_it;
        shear = make_ray_shear(ray.direction);
    }

    void test_triangle(std::uint32_t place) {
        const vec4* texel = &bvh.triangles[3 * std::size_t{place}];
        const vec4* of = &bvh.nodes[4 * std::size_t{record}];
        const std::uint32_t triangle = unpack_number(texel[1].w) +
                                       (record ? unpack_number(of[2].w) : 0);
        const std::uint32_t flags = unpack_number(record ? of[3].w : texel[2].w);
        const std::uint32_t skips = flags & skipped_flags;
        if ((skips & ~f32::kBvhOneSided) != 0 || triangle + 1 == ray.leaves) return;
        if (skips != 0 && hits_back_face(read_xyz<Real>(texel[0]), read_xyz<Real>(texel[1]),
                                         read_xyz<Real>(texel[2]), ray.direction))
            return;
        Real t;
        Vec3<Real> weights;
        if ((flags & f32::kBvhSpherePrimitive) != 0) {
            if (!intersect_sphere_robustly(read_xyz<Real>(texel[0]), Real{texel[1].x}, ray,
                                           Real{f32::kLargestFloat}, t))
                return;
            weights = {1, 0, 0};
        } else if (!intersect_triangle_watertight(
                       read_xyz<Real>(texel[0]), read_xyz<Real>(texel[1]), read_xyz<Real>(texel[2]),
                       ray.origin, shear, t, weights)) {
            return;
        }
        if (t < t_max || (best && t == t_max && triangle < best->triangle)) {
            t_max = t;
            best = RayHit<Real>{t,        normalise(weights),
                                triangle, unpack_number((record ? of[1] : texel[0]).w),
                                place,    record};
        }
    }

    static Vec3<Real> normalise(const Vec3<Real>& weights) {
        return weights / (weights.x + weights.y + weights.z);
    }
};

template <typename Real>
bool can_hit(const Bvh& bvh, const Ray<Real>& ray, Real t_max) {
    return is_valid_ray(ray) && t_max > 0 && !bvh.triangles.empty();
}

template <typename Real>
auto tree_box_ray(const Bvh& bvh, const Ray<Real>& ray) {
    const vec4* header = bvh.nodes.data();
    const Real times = header[2].x > 0 ? Real{header[2].x} : Real{1};
    return make_box_ray(ray, read_xyz<Real>(header[0]), read_xyz<Real>(header[1]), times);
}

template <typename Real>
std::optional<RayHit<Real>> find_hit(const Bvh& bvh, const Ray<Real>& ray, const Vec3<Real>& low,
                                     Real t_max, std::uint32_t skipped_flags, bool any,
                                     TraversalCounters* steps) {
    if (!can_hit(bvh, ray, t_max)) return {};
    ClosestHitSearch<Real> search{bvh, ray, t_max, skipped_flags};
    auto boxes = tree_box_ray<Real>(bvh, ray);
    std::array<std::uint32_t, f32::kBvhMaxStack> stack;
    std::size_t waiting = 0;
    TraversalCounters count;
    std::uint32_t child = float_to_bits(bvh.nodes[3].x);
    const std::uint32_t others = float_to_bits(bvh.nodes[3].y);
    if (others != f32::kBvhEmptyChild && (skipped_flags & kCastsNoShadowFlag) == 0)
        stack[waiting++] = others;
    while (child != f32::kBvhEmptyChild) {
        if (f32::is_bvh_word_inner_node(child)) {
            ++count.nodes;
            const vec4* node = &bvh.nodes[4 * std::size_t{f32::bvh_word_index(child)}];
            Real near_0, near_1;
            const bool meets_0 = intersect_box_slabs(
                read_xyz<Real>(node[0]), read_xyz<Real>(node[1]), boxes, search.t_max, near_0);
            const bool meets_1 = intersect_box_slabs(
                read_xyz<Real>(node[2]), read_xyz<Real>(node[3]), boxes, search.t_max, near_1);
            const bool second_first = meets_1 && (!meets_0 || near_1 < near_0);
            const std::uint32_t first = float_to_bits(node[second_first ? 1 : 0].w);
            const std::uint32_t second = float_to_bits(node[second_first ? 0 : 1].w);
            if (meets_0 && meets_1) stack.at(waiting++) = second;
            if (meets_0 || meets_1) {
                child = first;
                continue;
            }
        } else if (child == f32::kBvhReturnFromInstance) {
            ++count.nodes;
            search.enter(0, ray);
            boxes = tree_box_ray<Real>(bvh, ray);
        } else if (f32::bvh_word_triangle_count(child) == f32::kBvhInstanceMarker) {
            ++count.nodes;
            const std::uint32_t record = f32::bvh_word_index(child);
            const vec4* texel = &bvh.nodes[4 * std::size_t{record}];
            search.enter(
                record, transform_ray_to_object_space(read_placement<Real>(bvh, record), ray, low));
            boxes = make_box_ray(search.ray, read_xyz<Real>(texel[8]), read_xyz<Real>(texel[9]),
                                 Real{1});
            stack.at(waiting++) = f32::kBvhReturnFromInstance;
            child = float_to_bits(texel[0].w);
            continue;
        } else {
            for (std::uint32_t i = 0; i < f32::bvh_word_triangle_count(child); ++i) {
                ++count.triangles;
                search.test_triangle(f32::bvh_word_index(child) + i);
                if (any && search.best) break;
            }
            if (any && search.best) break;
        }
        child = waiting > 0 ? stack[--waiting] : f32::kBvhEmptyChild;
    }
    if (steps != nullptr) *steps = count;
    return search.best;
}

} // namespace detail

/// Returns the first triangle that the ray meets at a t in (0, t_max). A ray that is not finite
/// misses. Skips triangles that have a flag of `skipped`; kOneSidedFlag skips hits from behind
/// only. A ray never hits the triangle that it leaves. `low`: the rounding error of the ray's
/// origin, so that origin + low is the exact start.
template <typename Real>
std::optional<RayHit<Real>>
find_closest_hit(const Bvh& bvh, const Ray<Real>& ray, Real t_max, std::uint32_t skipped = 0,
                 TraversalCounters* steps = nullptr, const Vec3<Real>& low = Vec3<Real>(0)) {
    return detail::find_hit<Real>(bvh, ray, low, t_max, skipped, false, steps);
}

/// Returns whether the ray meets any triangle at a t in (0, t_max).
template <typename Real>
bool has_any_hit(const Bvh& bvh, const Ray<Real>& ray, Real t_max, std::uint32_t skipped = 0,
                 TraversalCounters* steps = nullptr, const Vec3<Real>& low = Vec3<Real>(0)) {
    return detail::find_hit<Real>(bvh, ray, low, t_max, skipped, true, steps).has_value();
}

/// Returns the same as `find_closest_hit`, by testing every triangle. Valid only for hierarchies
/// without instances.
template <typename Real>
std::optional<RayHit<Real>> brute_force_hit(const Bvh& bvh, const Ray<Real>& ray, Real t_max,
                                            std::uint32_t skipped = 0) {
    if (!detail::can_hit(bvh, ray, t_max)) return {};
    detail::ClosestHitSearch<Real> search{bvh, ray, t_max, skipped};
    for (std::uint32_t i = 0; i < count_triangles(bvh); ++i) search.test_triangle(i);
    return search.best;
}

} // namespace catoptric::bvh
