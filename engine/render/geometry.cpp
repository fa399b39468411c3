#include "render/geometry.hpp"

#include "scene/transform.hpp"

#include <utility>

namespace catoptric::render {

namespace {

/// Seen from where its normals point; what a mirrored object or a careless file gives.
bool runs_clockwise(const std::vector<shared::Vertex>& vertices, const uvec3& triangle) {
    const shared::Vertex &a = vertices[triangle.x], &b = vertices[triangle.y],
                         &c = vertices[triangle.z];
    return dot(glm::cross(b.position - a.position, c.position - a.position),
               a.normal + b.normal + c.normal) < 0;
}

} // namespace

Geometry make_geometry(const scene::Scene& now, const Space& space) {
    Geometry geometry{.core = space.core};
    std::size_t vertices = 0, indices = 0;
    for (const scene::Object& object : now.objects) {
        const scene::Mesh& mesh = now.meshes[object.mesh];
        const scene::Material& material = now.materials[object.material];
        DrawRange range;
        range.first_index = static_cast<std::uint32_t>(indices);
        range.index_count = static_cast<std::uint32_t>(3 * mesh.triangles.size());
        range.first_vertex = static_cast<std::uint32_t>(vertices);
        range.vertex_count = static_cast<std::uint32_t>(mesh.positions.size());
        range.mirror = material.mirror;
        range.casts_shadow = material.emission == vec3(0);
        range.seen_by_camera = object.seen_by_camera;
        range.exact_sphere = object.sphere.has_value();
        range.one_sided = scene::is_one_sided(material);
        geometry.ranges.push_back(range);
        vertices += range.vertex_count, indices += range.index_count;
    }
    geometry.vertices.resize(vertices);
    geometry.indices.resize(indices);
    for (std::size_t i = 0; i < now.objects.size(); ++i) move_object(geometry, now, space, i);
    return geometry;
}

void move_object(Geometry& geometry, const scene::Scene& now, const Space& space,
                 std::size_t object) {
    const dmat4& world_from_object = now.objects[object].world_from_object;
    const scene::Mesh& mesh = now.meshes[now.objects[object].mesh];
    const dmat3 normal_to_world = scene::normal_matrix(world_from_object);
    DrawRange& range = geometry.ranges[object];
    range.bounds = {};
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const vec3 position = space.point(dvec3(world_from_object * dvec4(mesh.positions[i], 1)));
        range.bounds.add(position);
        geometry.vertices[range.first_vertex + i] = {
            position, vec3(scene::world_normal(normal_to_world, dvec3(mesh.normals[i])))};
    }
    check_reach(range.bounds, now.objects[object].name);
    std::size_t index = range.first_index;
    for (uvec3 triangle : mesh.triangles) {
        triangle += range.first_vertex;
        if (range.one_sided && runs_clockwise(geometry.vertices, triangle))
            std::swap(triangle.y, triangle.z);
        for (int i = 0; i < 3; ++i) geometry.indices[index++] = triangle[i];
    }
}

float squared_distance(vec3 p, vec3 a, vec3 b, vec3 c) {
    const vec3 ab = b - a, ac = c - a, ap = p - a;
    const float d1 = dot(ab, ap), d2 = dot(ac, ap);
    const auto to = [&](vec3 closest) { return dot(p - closest, p - closest); };
    if (d1 <= 0 && d2 <= 0) return to(a);
    const vec3 bp = p - b;
    const float d3 = dot(ab, bp), d4 = dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return to(b);
    const float vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return to(a + ab * (d1 / (d1 - d3)));
    const vec3 cp = p - c;
    const float d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return to(c);
    const float vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return to(a + ac * (d2 / (d2 - d6)));
    const float va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
        return to(b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))));
    return to(a + ab * (vb / (va + vb + vc)) + ac * (vc / (va + vb + vc)));
}

} // namespace catoptric::render
