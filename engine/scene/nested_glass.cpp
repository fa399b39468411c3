#include "scene/nested_glass.hpp"

#include "scene/material_facts.hpp"
#include "scene/topology.hpp"
#include "scene/transform.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

namespace catoptric::scene {

namespace {

constexpr std::size_t kMaxTestedVertices = 16;

/// A solid body of glass: an object's number and the object's bounds in the world.
struct SolidGlassBody {
    std::size_t object = 0;
    Bounds<double> box;
};

std::vector<SolidGlassBody> list_solid_glass_bodies(const Scene& scene) {
    std::vector<SolidGlassBody> bodies;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const Material& material = scene.materials[scene.objects[i].material];
        if (!is_glass(material) || !material.solid) continue;
        const Bounds<double> box = bounds(scene, scene.objects[i]);
        if (!box.empty()) bodies.push_back({i, box});
    }
    std::ranges::sort(bodies, {}, [](const SolidGlassBody& body) { return body.box.lo.x; });
    return bodies;
}

bool do_bounds_overlap(const Bounds<double>& a, const Bounds<double>& b) {
    return all(lessThan(a.lo, b.hi)) && all(lessThan(b.lo, a.hi));
}

/// Returns how often the closed mesh's triangles wind around the origin, from the signed solid
/// angles of the triangles (Van Oosterom and Strackee 1983). `corner(v)`: position of vertex v.
template <typename Corner>
double compute_winding_number(const Mesh& mesh, Corner&& corner) {
    double angle = 0;
    for (const uvec3& t : mesh.triangles) {
        const dvec3 a = corner(t.x), b = corner(t.y), c = corner(t.z);
        const double x = length(a), y = length(b), z = length(c);
        angle += 2 * std::atan2(dot(a, cross(b, c)),
                                x * y * z + dot(a, b) * z + dot(b, c) * x + dot(c, a) * y);
    }
    return angle / (4 * std::numbers::pi);
}

/// Returns whether a tested vertex of the first body lies inside the second body. The winding
/// number is +-1 inside, 0 outside, and +-1/2 on a face.
bool is_vertex_inside(const Scene& scene, const SolidGlassBody& inner,
                      const SolidGlassBody& outer) {
    constexpr double kMinInsideWinding = .75;
    const Object& inner_object = scene.objects[inner.object];
    const Object& outer_object = scene.objects[outer.object];
    const std::vector<dvec3>& positions = scene.meshes[inner_object.mesh].positions;
    const Mesh& mesh = scene.meshes[outer_object.mesh];
    const dmat4 to_outer = glm::inverse(outer_object.world_from_object) *
                           inner_object.world_from_object;
    const std::size_t count = std::min(positions.size(), kMaxTestedVertices);
    for (std::size_t k = 0; k < count; ++k) {
        const dvec3& vertex = positions[k * positions.size() / count];
        const dvec3 world(inner_object.world_from_object * dvec4(vertex, 1));
        if (!(all(lessThan(outer.box.lo, world)) && all(lessThan(world, outer.box.hi)))) continue;
        const dvec3 point(to_outer * dvec4(vertex, 1));
        const double winding = compute_winding_number(
            mesh, [&](std::uint32_t v) { return mesh.positions[v] - point; });
        if (std::abs(winding) > kMinInsideWinding) return true;
    }
    return false;
}

} // namespace

std::set<std::size_t> find_nested_glass_materials(const Scene& scene) {
    const std::vector<SolidGlassBody> bodies = list_solid_glass_bodies(scene);
    std::map<std::size_t, bool> closed; // by mesh
    const auto is_closed = [&](const SolidGlassBody& body) {
        const std::size_t number = scene.objects[body.object].mesh;
        const auto [entry, is_new] = closed.try_emplace(number, false);
        const Mesh& mesh = scene.meshes[number];
        if (is_new) entry->second = is_closed_triangle_surface(mesh.positions, mesh.triangles);
        return entry->second;
    };
    std::set<std::size_t> materials;
    for (std::size_t i = 0; i < bodies.size(); ++i)
        for (std::size_t k = i + 1; k < bodies.size() && bodies[k].box.lo.x < bodies[i].box.hi.x;
             ++k) {
            const SolidGlassBody &a = bodies[i], &b = bodies[k];
            if (!do_bounds_overlap(a.box, b.box)) continue;
            const std::size_t of_a = scene.objects[a.object].material,
                              of_b = scene.objects[b.object].material;
            if (materials.contains(of_a) && materials.contains(of_b)) continue;
            if (!is_closed(a) || !is_closed(b)) continue;
            if (is_vertex_inside(scene, a, b) || is_vertex_inside(scene, b, a))
                materials.insert({of_a, of_b});
        }
    return materials;
}

} // namespace catoptric::scene
