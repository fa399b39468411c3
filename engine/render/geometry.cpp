#include "render/geometry.hpp"

#include "core/shader_math.hpp"
#include "scene/material_facts.hpp"
#include "scene/rough_reflectors.hpp"
#include "scene/transform.hpp"

#include <algorithm>
#include <utility>

namespace catoptric::render {

namespace {

/// Returns whether the triangle is clockwise as seen from the side of its normals. Mirrored objects
/// and badly written files have such triangles.
bool is_clockwise(const std::vector<shared::Vertex>& vertices, const uvec3& triangle) {
    const shared::Vertex &a = vertices[triangle.x], &b = vertices[triangle.y],
                         &c = vertices[triangle.z];
    return dot(glm::cross(b.position - a.position, c.position - a.position),
               a.normal + b.normal + c.normal) < 0;
}

void write_object_indices(FrameGeometry& geometry, const scene::Mesh& mesh,
                          const DrawRange& range) {
    std::size_t index = range.first_index;
    for (uvec3 triangle : mesh.triangles) {
        triangle += range.first_vertex;
        if (range.one_sided && !range.casts_shadow && is_clockwise(geometry.vertices, triangle))
            std::swap(triangle.y, triangle.z);
        for (int i = 0; i < 3; ++i) geometry.indices[index++] = triangle[i];
    }
}

/// Writes the vertices that all copies of a mesh share. Returns the object space of the mesh.
MeshSpace write_mesh_vertices(FrameGeometry& geometry, const scene::Mesh& mesh,
                              const DrawRange& range) {
    MeshSpace space = make_mesh_space(mesh);
    const dmat3 to_own(space.unit), normal_to_own(1);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const vec3 position(to_own * (mesh.positions[i] - space.middle));
        space.box.add(dvec3(position));
        geometry.vertices[range.first_vertex + i] = {
            position, vec3(scene::transform_normal(normal_to_own, dvec3(mesh.normals[i])))};
    }
    write_object_indices(geometry, mesh, range);
    return space;
}

/// Writes the vertices of a single object into its object space. Returns whether they changed.
bool write_own_vertices(FrameGeometry& geometry, const scene::Scene& now, const SceneUnits& space,
                        std::size_t index) {
    const scene::Object& object = now.objects[index];
    const scene::Mesh& mesh = now.meshes[object.mesh];
    DrawRange& range = geometry.ranges[index];
    range.own = make_object_space(now, object, space);
    // Transforms the mesh relative to the middle of the space.
    const dvec3 middle = make_mesh_space(mesh).middle;
    const dmat3 own_from_scene = glm::inverse(range.own->scene_from_own),
                turn = own_from_scene * space.scale * dmat3(object.world_from_object),
                normal_to_own = scene::normal_matrix(object.world_from_object);
    const dvec3 at_middle = own_from_scene * (space.to_scene(scene::transform_point(
                                                  object.world_from_object, middle)) -
                                              range.own->centre);
    Bounds<double> box;
    bool changed = false;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const vec3 position(turn * (mesh.positions[i] - middle) + at_middle);
        box.add(dvec3(position));
        const shared::Vertex vertex{
            position, vec3(scene::transform_normal(normal_to_own, dvec3(mesh.normals[i])))};
        shared::Vertex& kept = geometry.vertices[range.first_vertex + i];
        changed = changed || kept.position != vertex.position || kept.normal != vertex.normal;
        kept = vertex;
    }
    range.bounds = mesh.positions.empty() ? Bounds<float>() : scene_bounds(*range.own, box);
    return changed;
}

/// Writes the object's vertices in scene units.
void write_scene_vertices(FrameGeometry& geometry, const scene::Scene& now, const SceneUnits& space,
                          std::size_t index) {
    const dmat4& world_from_object = now.objects[index].world_from_object;
    const scene::Mesh& mesh = now.meshes[now.objects[index].mesh];
    const dmat3 normal_to_world = scene::normal_matrix(world_from_object);
    DrawRange& range = geometry.ranges[index];
    range.bounds = {};
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const vec3 position = space.to_scene_point(
            dvec3(world_from_object * dvec4(mesh.positions[i], 1)));
        range.bounds.add(position);
        geometry.vertices[range.first_vertex + i] = {
            position, vec3(scene::transform_normal(normal_to_world, dvec3(mesh.normals[i])))};
    }
}

/// Returns whether the material has a factor, other than those of glTF itself, that is not at its
/// default.
bool has_extra_factors(const scene::Material& material) {
    const scene::Material usual;
    return std::ranges::any_of(scene::kMaterialFactors, [&](const scene::MaterialFactor& factor) {
        return factor.extension != scene::kCoreFactors &&
               material.*factor.member != usual.*factor.member;
    });
}

/// Returns whether the visible surface has more than one constant colour and its emission.
bool has_varying_colour(const scene::Mesh& mesh, const scene::Material& material) {
    const bool throws_back = material.albedo != vec3(0) && material.reflectance != vec3(1);
    return !mesh.colours.empty() || material.albedo_texture || material.emission_texture ||
           material.normal_texture || material.unlit || scene::has_alpha_mask(material) ||
           has_extra_factors(material) ||
           (material.mirror ? throws_back || scene::is_visibly_emissive(material)
                            : scene::has_specular(material));
}

/// Returns whether a mirror shows nothing except reflections.
bool only_reflects(const scene::Mesh& mesh, const scene::Material& material) {
    if (scene::is_visibly_emissive(material)) return false;
    if (material.mirror) return material.albedo == vec3(0) || material.reflectance == vec3(1);
    return material.metallic == 1 && mesh.colours.empty() && !material.albedo_texture &&
           !material.roughness_texture && !material.unlit;
}

/// Returns the properties of an object that do not depend on its place.
DrawRange make_draw_range(const scene::Scene& now, const scene::Object& object) {
    const scene::Mesh& mesh = now.meshes[object.mesh];
    const scene::Material& material = now.materials[object.material];
    DrawRange range;
    range.index_count = static_cast<std::uint32_t>(3 * mesh.triangles.size());
    range.vertex_count = static_cast<std::uint32_t>(mesh.positions.size());
    range.mirror = scene::is_mirror(now, object);
    range.glass = scene::is_glass(material);
    range.casts_shadow = !range.glass && scene::emitted_radiance(material) == vec3(0);
    range.tints = range.glass && now.tints_glass_shadows;
    range.seen_by_camera = object.seen_by_camera;
    range.exact_sphere = object.sphere.has_value();
    range.one_sided = !range.mirror && !range.glass && scene::is_one_sided(material);
    range.varies = has_varying_colour(mesh, material);
    // A mirror reflects on both sides, even if its material is one-sided. The normals of solid
    // glass say which side is inside.
    range.turns = (range.glass ? material.two_sided && !material.solid
                               : material.two_sided || range.mirror) &&
                  (material.albedo != vec3(0) || range.varies);
    range.masked = scene::has_alpha_mask(material);
    range.blended = material.blended && !range.mirror;
    range.has_normal_texture = material.normal_texture.has_value();
    range.has_lobe = scene::may_reflect_by_lobe(now, object);
    range.rough = range.mirror && range.has_lobe;
    range.clear_coat = scene::has_clear_coat(material);
    if (range.rough && !range.glass && !material.roughness_texture && !range.clear_coat)
        range.lobe_alpha = f32::roughness_to_alpha(material.roughness);
    // Captures do not show lights without a surface, so a rough mirror shows their highlights
    // itself. The surface below a clear coat may be too rough for captures, and is then lit by
    // lights.
    range.lit = range.mirror && (range.clear_coat || !only_reflects(mesh, material) ||
                                 (range.has_lobe && !now.punctual.empty()));
    return range;
}

/// Assigns to each object its range of the vertex and index lists. Objects in scene units come
/// first. Copies that share a mesh have one common range.
void assign_geometry_ranges(FrameGeometry& geometry, const scene::Scene& now) {
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
}

/// Stores the attributes of every mesh that has them, once.
void assign_attribute_ranges(FrameGeometry& geometry, const scene::Scene& now) {
    std::vector<std::optional<std::uint32_t>> first_of(now.meshes.size());
    for (std::size_t i = 0; i < geometry.ranges.size(); ++i) {
        const scene::Mesh& mesh = now.meshes[now.objects[i].mesh];
        const auto& [uv, other_uv] = mesh.uv;
        if (!geometry.ranges[i].varies && !geometry.ranges[i].masked) continue;
        if (uv.empty() && other_uv.empty() && mesh.colours.empty()) continue;
        std::optional<std::uint32_t>& first = first_of[now.objects[i].mesh];
        if (!first) {
            first = static_cast<std::uint32_t>(geometry.attributes.size());
            for (std::size_t k = 0; k < mesh.positions.size(); ++k)
                geometry.attributes.push_back(
                    {vec4(uv.empty() ? vec2(0) : uv[k], other_uv.empty() ? vec2(0) : other_uv[k]),
                     mesh.colours.empty() ? vec4(1) : mesh.colours[k]});
        }
        geometry.ranges[i].first_attribute = first;
    }
}

} // namespace

FrameGeometry make_geometry(const scene::Scene& now, const SceneUnits& space, VertexSpaces spaces) {
    FrameGeometry geometry{.core = space.core, .spaces = spaces};
    const std::vector<bool> shared = spaces == VertexSpaces::object_space
                                         ? find_sharing_objects(now)
                                         : std::vector<bool>(now.objects.size());
    for (std::size_t i = 0; i < now.objects.size(); ++i) {
        DrawRange range = make_draw_range(now, now.objects[i]);
        range.storage = static_cast<std::uint32_t>(i);
        range.shares = shared[i];
        if (range.shares || (spaces == VertexSpaces::object_space &&
                             is_small_for_distance(now, now.objects[i], space)))
            range.own.emplace();
        geometry.ranges.push_back(range);
    }
    assign_geometry_ranges(geometry, now);
    assign_attribute_ranges(geometry, now);
    for (std::size_t i = 0; i < now.objects.size(); ++i) {
        const DrawRange& range = geometry.ranges[i];
        const std::size_t mesh = now.objects[i].mesh;
        if (range.shares && range.storage == i)
            geometry.mesh_spaces[mesh] = write_mesh_vertices(geometry, now.meshes[mesh], range);
        move_object(geometry, now, space, i);
    }
    return geometry;
}

/// Returns the radius of a sphere around the middle of the object's bounds that contains the
/// object.
float bounding_radius(const FrameGeometry& geometry, const DrawRange& range) {
    constexpr float kBoundingRadiusMargin = 1 + 0x1p-20f;
    if (range.bounds.empty()) return 0;
    if (range.own) return kBoundingRadiusMargin * length(range.bounds.extent()) / 2;
    const vec3 middle = range.bounds.centre();
    float squared = 0;
    for (std::uint32_t i = 0; i < range.vertex_count; ++i) {
        const vec3 from = geometry.vertices[range.first_vertex + i].position - middle;
        squared = std::max(squared, dot(from, from));
    }
    return kBoundingRadiusMargin * std::sqrt(squared);
}

bool needs_other_space(const FrameGeometry& geometry, const scene::Scene& now,
                       const SceneUnits& space, std::size_t object) {
    if (geometry.spaces == VertexSpaces::scene_space) return false;
    const DrawRange& range = geometry.ranges[object];
    if (range.shares) return !may_share_mesh(now, now.objects[object]);
    return range.own.has_value() != is_small_for_distance(now, now.objects[object], space);
}

bool move_object(FrameGeometry& geometry, const scene::Scene& now, const SceneUnits& space,
                 std::size_t index) {
    const scene::Object& object = now.objects[index];
    DrawRange& range = geometry.ranges[index];
    bool changed = !range.shares;
    if (range.shares) {
        const MeshSpace& mesh = geometry.mesh_spaces.at(object.mesh);
        range.own = make_object_space(mesh, object.world_from_object, space);
        range.bounds = scene_bounds(*range.own, mesh.box);
    } else if (range.own) {
        changed = write_own_vertices(geometry, now, space, index);
    } else {
        write_scene_vertices(geometry, now, space, index);
    }
    range.radius = bounding_radius(geometry, range);
    range.flipped = !(glm::determinant(dmat3(object.world_from_object)) > 0);
    check_object_distance(range.bounds, object.name);
    if (!range.shares) write_object_indices(geometry, now.meshes[object.mesh], range);
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
