#pragma once

#include "bvh/closest_hit.hpp"
#include "scene/material_facts.hpp"
#include "scene/shapes.hpp"
#include "scene/transform.hpp"
#include "support/numbers.hpp"
#include "support/scenes.hpp"

#include <cmath>
#include <vector>

/// Random halls with partitions and mirrors, made from a seed, and rays through a scene.
namespace test {

/// Returns the transform that rotates by `angle` about `axis` and then moves the origin to `at`.
inline dmat4 make_rotation_about_axis(dvec3 axis, double angle, dvec3 at) {
    const dvec3 x = glm::normalize(
                    cross(axis, std::abs(axis.x) < .5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0))),
                y = cross(axis, x);
    const dmat3 basis(x, y, axis),
        turn(dvec3(std::cos(angle), std::sin(angle), 0),
             dvec3(-std::sin(angle), std::cos(angle), 0), dvec3(0, 0, 1));
    dmat4 place(basis * turn * glm::transpose(basis));
    place[3] = dvec4(at, 1);
    return place;
}

/// Returns a random hall of 16 x 12 x 20 with `mirrors` mirrors: balls, blocks and panels in random
/// orientations. The hall has as many objects that are no mirrors, a lamp under the ceiling, and a
/// point light.
///
/// Up to three partitions cross the hall. A partition is whole, has a gap at a side, or is seen
/// only from its front.
inline scene::Scene make_random_hall(std::uint64_t seed, int mirrors) {
    RandomNumbers numbers(seed);
    scene::Scene scene{.name = "hall"};
    const std::size_t white = add_material(scene, {.name = "white", .albedo = vec3(.7f)}),
                      front = add_material(scene, {.albedo = vec3(.5f), .front_only = true}),
                      mirror = add_material(scene, {.name = "mirror", .mirror = true}),
                      lamp = add_material(scene, {.name = "lamp", .emission = vec3(9)});
    for (int face = 0; face < 6; ++face)
        add_mesh(scene, make_box_wall(face, {-8, -6, -10}, {8, 6, 10}), white);
    for (int i = 0; i < 3; ++i) {
        const double z = -5. + 5. * i + numbers.random_number_between(-1, 1),
                     tilt = numbers.random_number_between(-.5f, .5f);
        const double to = numbers.random_integer_below(2) == 0
                              ? 8
                              : numbers.random_number_between(0, 6);
        if (numbers.random_integer_below(4) == 0) continue;
        add_quad(scene, "partition", numbers.random_integer_below(3) == 0 ? front : white,
                 {-8, -6, z}, {to, -6, z + tilt}, {to, 6, z + tilt}, {-8, 6, z});
        scene.objects.back().seen_by_camera = numbers.random_integer_below(6) != 0;
    }
    const auto place = [&] {
        return dvec3(numbers.random_number_between(-7, 7), numbers.random_number_between(-5, 5),
                     numbers.random_number_between(-9, 9));
    };
    for (int i = 0; i < 2 * mirrors; ++i) {
        const std::size_t material = i < mirrors ? mirror : white;
        const double size = numbers.random_number_between(.2f, .9f);
        const auto kind = numbers.random_integer_below(3);
        if (kind == 0) {
            add_ball(scene, "ball", material, place(), size, 2);
            continue;
        }
        if (kind == 1)
            add_mesh(scene, scene::box("block", dvec3(-size), dvec3(size)), material);
        else
            add_quad(scene, "panel", material, {-size, -size, 0}, {size, -size, 0}, {size, size, 0},
                     {-size, size, 0});
        const dvec3 axis(numbers.random_unit_direction());
        const double angle = numbers.random_integer_below(2) == 0
                                 ? 0
                                 : numbers.random_number_between(0, 6);
        scene.objects.back().world_from_object = make_rotation_about_axis(axis, angle, place());
    }
    add_quad(scene, "lamp", lamp, {-1, 5.9, -1}, {1, 5.9, -1}, {1, 5.9, 1}, {-1, 5.9, 1});
    scene::PunctualLight bare{.name = "bare", .intensity = vec3(5)};
    bare.world_from_light[3] = dvec4(place(), 1);
    scene.punctual.push_back(bare);
    scene.cameras.push_back(
        {.eye = place(),
         .target = place(),
         .vertical_fov_degrees = numbers.random_number_between(20, 80),
         .orthographic_height = numbers.random_integer_below(4) == 0 ? 8. : 0.});
    return scene;
}

/// Finds the objects that rays meet in a scene at an instant, in double precision.
class ObjectRayCaster {
public:
    explicit ObjectRayCaster(const scene::Scene& now) {
        for (std::size_t i = 0; i < now.objects.size(); ++i) add_object_triangles(now, i);
        tree_ = bvh::build(triangles_);
    }
    struct RayCasterObjectHit {
        std::size_t object = 0;
        double t = 0;
        bool operator==(const RayCasterObjectHit&) const = default;
    };
    /// Returns the first object that a ray meets, except object `but`. Pass the number of objects
    /// as `but` to exclude none. `skipped`: flags of triangles that the ray ignores.
    std::optional<RayCasterObjectHit> find_first_object(dvec3 from, const dvec3& direction,
                                                        std::size_t but,
                                                        std::uint32_t skipped) const {
        double passed = 0;
        for (;;) {
            const auto hit = bvh::find_closest_hit<double>(
                tree_, {from, direction, 0}, std::numeric_limits<double>::infinity(), skipped);
            if (!hit) return std::nullopt;
            if (hit->object != but) return RayCasterObjectHit{hit->object, passed + hit->t};
            const double step = hit->t * (1 + 1e-9) + 1e-9;
            passed += step, from += step * direction;
        }
    }
    /// Returns whether an object that casts shadows lies between the place and the light.
    bool is_in_shadow(const dvec3& place, const dvec3& light) const {
        const dvec3 way = light - place;
        const auto hit = bvh::find_closest_hit<double>(tree_, {place + 1e-6 * way, way, 0}, 1.,
                                                       bvh::kCastsNoShadowFlag);
        return hit.has_value();
    }
    /// Returns a random place on the object's surface.
    dvec3 random_point_on_object(std::size_t object, RandomNumbers& numbers) const {
        const auto [first, count] = ranges_[object];
        const bvh::Triangle& t = triangles_[first + numbers.random_integer_below(count)];
        const vec3 w = numbers.random_barycentric_weights();
        return dvec3(w.x * t.a + w.y * t.b + w.z * t.c);
    }

private:
    void add_object_triangles(const scene::Scene& now, std::size_t index) {
        const scene::Object& object = now.objects[index];
        const scene::Material& material = now.materials[object.material];
        const scene::Mesh& mesh = now.meshes[object.mesh];
        std::uint32_t flags = 0;
        if (!object.seen_by_camera) flags |= bvh::kHiddenFromCameraFlag;
        if (scene::emitted_radiance(material) != vec3(0)) flags |= bvh::kCastsNoShadowFlag;
        if (!scene::is_mirror(now, object) && scene::is_one_sided(material))
            flags |= bvh::kOneSidedFlag;
        ranges_.emplace_back(triangles_.size(), mesh.triangles.size());
        const auto at = [&](std::uint32_t vertex) {
            return vec3(scene::transform_point(object.world_from_object, mesh.positions[vertex]));
        };
        for (const uvec3& t : mesh.triangles)
            triangles_.push_back(
                {at(t.x), at(t.y), at(t.z), static_cast<std::uint32_t>(index), flags});
    }

    std::vector<bvh::Triangle> triangles_;
    /// First triangle and number of triangles of each object.
    std::vector<std::pair<std::size_t, std::size_t>> ranges_;
    bvh::Bvh tree_;
};

} // namespace test
