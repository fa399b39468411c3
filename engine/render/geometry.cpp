#include "render/geometry.hpp"

#include "bvh/two_level.hpp"
#include "scene/transform.hpp"

#include <algorithm>
#include <cmath>
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

/// A float turns a ray into a space by a matrix that stretches no more than this.
constexpr double kWorstStretch = 64;

double largest(const dvec3& v) { return std::max({v.x, v.y, v.z}); }

/// The power of two that makes `size` about 1.
double unit_of(double size) { return std::exp2(-std::ceil(std::log2(size))); }

bool is_small(const scene::Scene& now, const scene::Object& object, const Space& space) {
    const Bounds<double> box = scene::bounds(now, object);
    if (box.empty()) return false;
    const double size = largest(box.extent()) * space.scale,
                 distance = largest(
                     glm::max(glm::abs(space.place(box.lo)), glm::abs(space.place(box.hi))));
    return size > 0 && size < kSmallPart * distance;
}

Bounds<double> mesh_bounds(const scene::Mesh& mesh) {
    Bounds<double> box;
    for (const dvec3& position : mesh.positions) box.add(position);
    return box;
}

/// Middle and unit of the mesh's space, in the mesh's own units.
std::pair<dvec3, double> mesh_space(const scene::Mesh& mesh) {
    const Bounds<double> box = mesh_bounds(mesh);
    return {box.centre(), unit_of(largest(box.extent()))};
}

/// By object, whether its mesh is one whose copies are too many.
std::vector<bool> shared_meshes(const scene::Scene& now) {
    std::vector<std::uint64_t> uses(now.meshes.size());
    for (const scene::Object& object : now.objects) ++uses[object.mesh];
    std::uint64_t copied = 0;
    std::vector<bool> shared(now.meshes.size());
    for (std::size_t i = 0; i < uses.size(); ++i) {
        const std::uint64_t triangles = now.meshes[i].triangles.size();
        shared[i] = uses[i] > 1 && triangles > 0 &&
                    copied + (uses[i] - 1) * triangles > kMostCopied;
        if (!shared[i] && uses[i] > 1) copied += (uses[i] - 1) * triangles;
    }
    return shared;
}

bool can_share(const scene::Scene& now, const scene::Object& object) {
    if (scene::is_one_sided(now.materials[object.material])) return false;
    const scene::Mesh& mesh = now.meshes[object.mesh];
    return largest(mesh_bounds(mesh).extent()) > 0 &&
           bvh::stretch(dmat3(object.world_from_object)) <= kWorstStretch;
}

/// Of a mesh that others share: the mesh's axes, its bounds' middle.
OwnSpace space_of_mesh(const scene::Scene& now, const scene::Object& object, const Space& space) {
    const auto [middle, unit] = mesh_space(now.meshes[object.mesh]);
    OwnSpace own;
    own.scene_from_own = dmat3(object.world_from_object) * (space.scale / unit);
    own.centre = space.place(scene::transform_point(object.world_from_object, middle));
    const dmat3 inverse = glm::inverse(own.scene_from_own);
    own.least = 1 / std::sqrt(dot(inverse[0], inverse[0]) + dot(inverse[1], inverse[1]) +
                              dot(inverse[2], inverse[2]));
    return own;
}

/// Of a single object: the world's axes, so that nothing turns on its way; the middle is that of
/// its exact sphere or of its bounds.
OwnSpace space_of_object(const scene::Scene& now, const scene::Object& object, const Space& space) {
    const Bounds<double> box = scene::bounds(now, object);
    const double unit = unit_of(largest(box.extent())); // own units in one of the world
    OwnSpace own;
    own.scene_from_own = dmat3(space.scale / unit);
    own.centre = space.place(object.sphere ? object.sphere->centre : box.centre());
    own.least = space.scale / unit;
    if (object.sphere) own.radius = static_cast<float>(object.sphere->radius * unit);
    return own;
}

/// Where a range's bounds are, with the roundings of what becomes float.
Bounds<float> scene_bounds(const OwnSpace& own, const Bounds<double>& box) {
    constexpr double kRoundings = 0x1p-22;
    Bounds<double> result;
    for (int corner = 0; corner < 8; ++corner)
        result.add(own.centre + own.scene_from_own * dvec3((corner & 1 ? box.lo : box.hi).x,
                                                           (corner & 2 ? box.lo : box.hi).y,
                                                           (corner & 4 ? box.lo : box.hi).z));
    const dvec3 pad = kRoundings * glm::max(glm::abs(result.lo), glm::abs(result.hi));
    return {vec3(result.lo - pad), vec3(result.hi + pad)};
}

/// The object's vertices in its own space.
bool move_own(Geometry& geometry, const scene::Scene& now, const Space& space, std::size_t index) {
    const scene::Object& object = now.objects[index];
    const scene::Mesh& mesh = now.meshes[object.mesh];
    DrawRange& range = geometry.ranges[index];
    range.own = range.shares ? space_of_mesh(now, object, space)
                             : space_of_object(now, object, space);
    const auto [middle, unit] = mesh_space(mesh);
    // The turned mesh relative to the space's middle; by itself where the mesh's space is shared.
    const dmat3 turn = range.shares ? dmat3(unit)
                                    : glm::inverse(range.own->scene_from_own) * space.scale *
                                          dmat3(object.world_from_object);
    const dvec3 at_middle = range.shares ? dvec3(0)
                                         : glm::inverse(range.own->scene_from_own) *
                                               (space.place(scene::transform_point(
                                                    object.world_from_object, middle)) -
                                                range.own->centre);
    const dmat3 normal_to_own = range.shares ? dmat3(1)
                                             : scene::normal_matrix(object.world_from_object);
    Bounds<double> box;
    bool changed = false;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const vec3 position(turn * (mesh.positions[i] - middle) + at_middle);
        box.add(dvec3(position));
        const shared::Vertex vertex{
            position, vec3(scene::world_normal(normal_to_own, dvec3(mesh.normals[i])))};
        shared::Vertex& kept = geometry.vertices[range.first_vertex + i];
        changed = changed || kept.position != vertex.position || kept.normal != vertex.normal;
        kept = vertex;
    }
    range.bounds = mesh.positions.empty() ? Bounds<float>() : scene_bounds(*range.own, box);
    return changed;
}

} // namespace

Geometry make_geometry(const scene::Scene& now, const Space& space, Spaces spaces) {
    Geometry geometry{.core = space.core, .spaces = spaces};
    const std::vector<bool> shared = shared_meshes(now);
    for (const scene::Object& object : now.objects) {
        const scene::Mesh& mesh = now.meshes[object.mesh];
        const scene::Material& material = now.materials[object.material];
        DrawRange range;
        range.index_count = static_cast<std::uint32_t>(3 * mesh.triangles.size());
        range.vertex_count = static_cast<std::uint32_t>(mesh.positions.size());
        range.mirror = material.mirror;
        range.casts_shadow = material.emission == vec3(0);
        range.seen_by_camera = object.seen_by_camera;
        range.exact_sphere = object.sphere.has_value();
        range.one_sided = scene::is_one_sided(material);
        range.storage = static_cast<std::uint32_t>(geometry.ranges.size());
        if (spaces == Spaces::own) {
            range.shares = shared[object.mesh] && can_share(now, object);
            if (range.shares || is_small(now, object, space)) range.own.emplace();
        }
        geometry.ranges.push_back(range);
    }
    std::uint32_t vertices = 0, indices = 0;
    const auto store = [&](DrawRange& range) {
        range.first_index = indices, range.first_vertex = vertices;
        vertices += range.vertex_count, indices += range.index_count;
    };
    for (DrawRange& range : geometry.ranges)
        if (!range.own) store(range);
    geometry.flat_indices = indices;
    std::vector<std::optional<std::uint32_t>> first_with(now.meshes.size());
    for (std::size_t i = 0; i < geometry.ranges.size(); ++i) {
        DrawRange& range = geometry.ranges[i];
        if (!range.own) continue;
        std::optional<std::uint32_t>& first = first_with[now.objects[i].mesh];
        if (range.shares && first) {
            range.storage = *first;
            range.first_index = geometry.ranges[*first].first_index;
            range.first_vertex = geometry.ranges[*first].first_vertex;
            continue;
        }
        if (range.shares) first = range.storage;
        store(range);
    }
    geometry.vertices.resize(vertices);
    geometry.indices.resize(indices);
    for (std::size_t i = 0; i < now.objects.size(); ++i) move_object(geometry, now, space, i);
    return geometry;
}

bool changes_space(const Geometry& geometry, const scene::Scene& now, const Space& space,
                   std::size_t object) {
    if (geometry.spaces == Spaces::one) return false;
    const DrawRange& range = geometry.ranges[object];
    if (range.shares) return !can_share(now, now.objects[object]);
    return range.own.has_value() != is_small(now, now.objects[object], space);
}

bool move_object(Geometry& geometry, const scene::Scene& now, const Space& space,
                 std::size_t object) {
    const dmat4& world_from_object = now.objects[object].world_from_object;
    const scene::Mesh& mesh = now.meshes[now.objects[object].mesh];
    const dmat3 normal_to_world = scene::normal_matrix(world_from_object);
    DrawRange& range = geometry.ranges[object];
    bool changed = true;
    if (range.own) {
        changed = move_own(geometry, now, space, object);
    } else {
        range.bounds = {};
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            const vec3 position = space.point(
                dvec3(world_from_object * dvec4(mesh.positions[i], 1)));
            range.bounds.add(position);
            geometry.vertices[range.first_vertex + i] = {
                position, vec3(scene::world_normal(normal_to_world, dvec3(mesh.normals[i])))};
        }
    }
    check_reach(range.bounds, now.objects[object].name);
    std::size_t index = range.first_index;
    for (uvec3 triangle : mesh.triangles) {
        triangle += range.first_vertex;
        if (range.one_sided && runs_clockwise(geometry.vertices, triangle))
            std::swap(triangle.y, triangle.z);
        for (int i = 0; i < 3; ++i) geometry.indices[index++] = triangle[i];
    }
    return changed;
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
