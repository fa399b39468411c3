#pragma once

#include "bvh/closest_hit.hpp"
#include "bvh/tlas.hpp"
#include "support/kernel_shapes.hpp"

/// A random scene with instances in object space, and random rays through it. Both come from a
/// seed.
namespace test {

/// A ray with `low`, the rounding error of its origin as floats.
struct InstanceSceneRay {
    f32::Ray ray;
    vec3 low{0};
    float t_max = std::numeric_limits<float>::infinity();
};

/// Returns the place and axes that the record of an instance stores (bvh/tlas.hpp).
inline f32::ObjectPlacement make_placement_of_instance(const bvh::BvhInstance& instance) {
    const dmat3 to = instance.scene_from_own, back = glm::transpose(glm::inverse(to));
    return {vec3(back[0]),         vec3(back[1]),
            vec3(back[2]),         vec3(to[0]),
            vec3(to[1]),           vec3(to[2]),
            vec3(instance.centre), bvh::float_rounding_error(instance.centre)};
}

/// Returns a random rotation after a scale of each axis. The scale squeezes the second axis and
/// mirrors the third.
inline dmat3 random_scaled_rotation(RandomNumbers& numbers, double size, double squeeze) {
    const dvec3 x(numbers.random_unit_direction()),
        y = glm::normalize(cross(x, dvec3(numbers.random_unit_direction())));
    return dmat3(x, y, cross(x, y)) * dmat3(size, 0, 0, 0, size * squeeze, 0, 0, 0, -size);
}

/// A random scene of 60 instances among 40 triangles. The instances are balls and tori with sizes
/// of 1e-6 to 1, which are rotated, squeezed and mirrored.
class RandomInstanceScene {
public:
    explicit RandomInstanceScene(std::uint64_t seed) : numbers_(seed) {
        for (int i = 0; i < 40; ++i) {
            const vec3 a = numbers_.random_point_in_cube();
            room_.push_back({a, a + numbers_.random_point_in_cube(),
                             a + numbers_.random_point_in_cube(), 0, random_triangle_flags()});
        }
        auto next = static_cast<std::uint32_t>(room_.size());
        for (std::uint32_t k = 0; k < 60; ++k) {
            const double size = std::pow(10., numbers_.random_number_between(-6, 0)),
                         squeeze = numbers_.random_number_between(.1f, 1);
            const dmat3 to = random_scaled_rotation(numbers_, size, squeeze);
            const dvec3 fine = 1e-9 * dvec3(numbers_.random_point_in_cube());
            things_.push_back({nullptr, to, dvec3(numbers_.random_point_in_cube()) + fine, k + 1,
                               random_triangle_flags(), next});
            next += static_cast<std::uint32_t>(triangles_of_instance(k).size());
        }
    }

    const std::vector<bvh::BvhInstance>& list_instances() const { return things_; }
    std::vector<bvh::BvhInstance>& list_instances() { return things_; }

    /// Returns the tree of the scene, with scene lengths multiplied by `scene` and lengths in
    /// object space multiplied by `own`. Both factors are powers of two. The objects keep their
    /// places relative to each other.
    bvh::Bvh build_scene_bvh(float scene = 1, float own = 1) const {
        const bvh::Bvh trees[]{bvh::build(scale_triangles(shapes_[0], own)),
                               bvh::build(scale_triangles(shapes_[1], own))};
        std::vector<bvh::BvhInstance> placed = things_;
        for (std::size_t k = 0; k < placed.size(); ++k) {
            placed[k].tree = &trees[k % 2];
            placed[k].scene_from_own *= double{scene} / double{own};
            placed[k].centre *= double{scene};
            placed[k].radius *= own;
        }
        return bvh::assemble_two_level(bvh::build(scale_triangles(room_, scene)), placed);
    }

    /// Returns random rays of four kinds in turn: anywhere; from near an instance to a point on it;
    /// from a triangle of an instance; from anywhere to the centre of an instance. A quarter of the
    /// rays have a finite t_max.
    std::vector<InstanceSceneRay> make_random_rays(std::size_t count) {
        std::vector<InstanceSceneRay> rays(count);
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t k = numbers_.random_integer_below(things_.size());
            rays[i] = i % 4 == 1   ? random_ray_near_instance(k)
                      : i % 4 == 2 ? random_ray_from_triangle(k)
                                   : draw_random_ray();
            if (i % 4 == 3) rays[i].ray.direction = vec3(things_[k].centre) - rays[i].ray.origin;
            if (numbers_.random_word() % 4 == 0)
                rays[i].t_max = numbers_.random_number_between(0, 2);
        }
        return rays;
    }

private:
    using Triangles = std::vector<bvh::Triangle>;

    const Triangles& triangles_of_instance(std::size_t thing) const { return shapes_[thing % 2]; }
    std::uint32_t random_triangle_flags() {
        constexpr std::uint32_t kTestedTriangleFlags[]{0, 0, bvh::kHiddenFromCameraFlag,
                                                       bvh::kOneSidedFlag};
        return kTestedTriangleFlags[numbers_.random_integer_below(4)];
    }
    static Triangles scale_triangles(Triangles triangles, float times) {
        for (bvh::Triangle& t : triangles) t.a *= times, t.b *= times, t.c *= times;
        return triangles;
    }
    InstanceSceneRay draw_random_ray() {
        const vec3 origin = 2.0f * numbers_.random_point_in_cube();
        return {{origin, numbers_.random_unit_direction(), 0}};
    }
    InstanceSceneRay random_ray_near_instance(std::size_t thing) {
        const f32::ObjectPlacement place = make_placement_of_instance(things_[thing]);
        const bvh::Triangle& aim = triangles_of_instance(
            thing)[numbers_.random_integer_below(triangles_of_instance(thing).size())];
        const vec3 from = 2.0f * numbers_.random_point_in_cube(),
                   at = aim.a + numbers_.random_unit_fraction() * (aim.b - aim.a);
        InstanceSceneRay result;
        result.ray = {
            add_offset_to_object_centre(place, rotate_to_scene_offset(place, from), result.low),
            rotate_to_scene_offset(place, at - from), 0};
        return result;
    }
    InstanceSceneRay random_ray_from_triangle(std::size_t thing) {
        const f32::ObjectPlacement place = make_placement_of_instance(things_[thing]);
        const std::size_t number = numbers_.random_integer_below(
            triangles_of_instance(thing).size());
        const bvh::Triangle& t = triangles_of_instance(thing)[number];
        const vec3 w = numbers_.random_barycentric_weights(),
                   own = w.x * t.a + w.y * t.b + w.z * t.c;
        InstanceSceneRay result;
        result.ray = {
            add_offset_to_object_centre(place, rotate_to_scene_offset(place, own), result.low),
            numbers_.random_unit_direction(),
            things_[thing].shift + static_cast<std::uint32_t>(number) + 1};
        return result;
    }

    RandomNumbers numbers_;
    Triangles room_;
    Triangles shapes_[2]{*make_placed_triangles(scene::ball("ball", 2), .5, dvec3(0)),
                         *make_placed_triangles(make_closed_torus().mesh, .3, dvec3(0))};
    std::vector<bvh::BvhInstance> things_;
};

/// Returns the ray with its origin multiplied by `scene`. If `direction` is true, the
/// direction is multiplied as well and t stays the same.
inline InstanceSceneRay scale_ray_of_scene(InstanceSceneRay ray, float scene, bool direction) {
    ray.ray.origin *= scene, ray.low *= scene;
    if (direction)
        ray.ray.direction *= scene;
    else
        ray.t_max *= scene;
    return ray;
}

} // namespace test
