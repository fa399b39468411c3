#include "scene/repair.hpp"

#include "core/error.hpp"
#include "core/text.hpp"
#include "scene/scene_core.hpp"
#include "scene/transform.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <unordered_map>

namespace catoptric::scene {

namespace {

/// Range of lengths whose squares are finite, non-zero doubles.
constexpr double kMaxEdgeLength = 1e150, kMinEdgeLength = 1e-150;

bool is_in_range(const dvec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}) <= kMaxEdgeLength &&
           is_finite(v);
}

/// Returns a vector along the normal, of any length; zero if the triangle has no area. Edges are
/// scaled first, so that no size of a triangle over- or underflows.
dvec3 normal_direction(const dvec3& a, const dvec3& b, const dvec3& c) {
    const auto scaled = [](const dvec3& edge) {
        const double size = std::max({std::abs(edge.x), std::abs(edge.y), std::abs(edge.z)});
        return size >= kMinEdgeLength ? edge / size : dvec3(0);
    };
    return glm::cross(scaled(b - a), scaled(c - a));
}

dvec3 triangle_normal(const Mesh& mesh, const uvec3& t) {
    const auto& p = mesh.positions;
    return normalized_or_zero(normal_direction(p[t.x], p[t.y], p[t.z]));
}

std::size_t drop_degenerate_triangles(Mesh& mesh) {
    return std::erase_if(mesh.triangles,
                         [&](const uvec3& t) { return triangle_normal(mesh, t) == dvec3(0); });
}

/// Appends a copy of a vertex's element. A list without elements stays empty.
template <typename Value>
void repeat_element(std::vector<Value>& list, std::uint32_t vertex) {
    if (!list.empty()) list.push_back(Value(list[vertex]));
}

template <typename Value>
void keep_used(std::vector<Value>& list, std::size_t to, std::size_t from) {
    if (!list.empty()) list[to] = list[from];
}

template <typename Value>
void shorten(std::vector<Value>& list, std::size_t count) {
    if (!list.empty()) list.resize(count);
}

/// Gives every corner without a normal a vertex of its own, with the triangle's normal.
void add_missing_normals(Mesh& mesh) {
    mesh.normals.resize(mesh.positions.size(), vec3(0));
    for (vec3& normal : mesh.normals) normal = vec3(normalized_or_zero(dvec3(normal)));
    const std::size_t missing = count_missing_normals(mesh);
    mesh.positions.reserve(mesh.positions.size() + missing);
    mesh.normals.reserve(mesh.normals.size() + missing);
    for (uvec3& triangle : mesh.triangles) {
        const vec3 geometric(triangle_normal(mesh, triangle));
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t vertex = triangle[corner];
            if (mesh.normals[vertex] != vec3(0)) continue;
            triangle[corner] = static_cast<std::uint32_t>(mesh.positions.size());
            const dvec3 position = mesh.positions[vertex];
            mesh.positions.push_back(position);
            mesh.normals.push_back(geometric);
            repeat_element(mesh.uv[0], vertex), repeat_element(mesh.uv[1], vertex),
                repeat_element(mesh.colours, vertex);
        }
    }
}

void drop_unused_vertices(Mesh& mesh) {
    std::vector<std::uint32_t> renamed(mesh.positions.size(), 0);
    for (const uvec3& t : mesh.triangles) renamed[t.x] = renamed[t.y] = renamed[t.z] = 1;
    std::uint32_t kept = 0;
    for (std::size_t i = 0; i < renamed.size(); ++i) {
        if (renamed[i] == 0) continue;
        mesh.positions[kept] = mesh.positions[i];
        mesh.normals[kept] = mesh.normals[i];
        keep_used(mesh.uv[0], kept, i), keep_used(mesh.uv[1], kept, i),
            keep_used(mesh.colours, kept, i);
        renamed[i] = kept++;
    }
    mesh.positions.resize(kept);
    mesh.normals.resize(kept);
    shorten(mesh.uv[0], kept), shorten(mesh.uv[1], kept), shorten(mesh.colours, kept);
    for (uvec3& t : mesh.triangles) t = {renamed[t.x], renamed[t.y], renamed[t.z]};
}

bool has_surface_area(const Scene& scene, const Object& object) {
    const Mesh& mesh = scene.meshes[object.mesh];
    const auto world = [&](std::uint32_t i) {
        return transform_point(object.world_from_object, mesh.positions[i]);
    };
    return std::ranges::any_of(mesh.triangles, [&](const uvec3& t) {
        return normal_direction(world(t.x), world(t.y), world(t.z)) != dvec3(0);
    });
}

/// Largest alpha of a texture, by its image.
class LargestAlphas {
public:
    double largest_alpha(const std::optional<Texture>& texture) {
        if (!texture) return 1;
        const auto [entry, is_new] = of_.try_emplace(texture->image.get(), 0.0);
        if (is_new)
            for (const std::uint32_t texel : texture->image->texels)
                entry->second = std::max(entry->second, double(texel >> 24) / 255);
        return entry->second;
    }

private:
    std::unordered_map<const Image*, double> of_;
};

/// Returns whether a surface can be seen at all. Blended and cut-out surfaces can have no alpha.
bool can_be_seen(const Scene& scene, const Object& object, LargestAlphas& alphas) {
    const Material& material = scene.materials[object.material];
    if (!material.blended && material.alpha_cutoff <= 0) return true;
    double alpha = material.alpha * alphas.largest_alpha(material.albedo_texture);
    const std::vector<vec4>& colours = scene.meshes[object.mesh].colours;
    if (!colours.empty())
        alpha *= double{std::ranges::max(colours, {}, [](const vec4& c) { return c.w; }).w};
    return material.blended ? alpha > 0 : alpha >= double{material.alpha_cutoff};
}

} // namespace

std::size_t count_missing_normals(const Mesh& mesh) {
    std::size_t count = 0;
    for (const uvec3& triangle : mesh.triangles)
        for (int corner = 0; corner < 3; ++corner)
            count += normalized_or_zero(dvec3(mesh.normals[triangle[corner]])) == dvec3(0);
    return count;
}

std::size_t repair_mesh(Mesh& mesh) {
    const std::size_t dropped = drop_degenerate_triangles(mesh);
    add_missing_normals(mesh);
    drop_unused_vertices(mesh);
    return dropped;
}

bool is_valid_radiance(const vec3& emission) {
    return is_finite(emission) && glm::all(glm::greaterThanEqual(emission, vec3(0)));
}

void finish_scene(Scene& scene, const std::string& file, LoaderNotes& notes,
                  std::vector<UnsupportedFeature> unsupported) {
    for (const Object& object : scene.objects)
        for (const dvec3& position : scene.meshes[object.mesh].positions)
            check(is_in_range(transform_point(object.world_from_object, position)),
                  Failure::bad_data, file, ": object ", quote(object.name),
                  ": wanted finite world coordinates up to 1e150, found an overflow");
    std::erase_if(scene.objects, [&](const Object& object) {
        if (has_surface_area(scene, object)) return false;
        notes.add("objects that have no triangle with an area, left out", quote(object.name));
        return true;
    });
    for (const std::string& name : remove_distant_objects(scene))
        notes.add("objects farther away than floats reach, left out", quote(name));
    LargestAlphas alphas;
    for (const Object& object : scene.objects)
        if (!can_be_seen(scene, object, alphas))
            notes.add("objects of which nothing can be seen, because their alpha is 0 or below "
                      "the cutoff",
                      quote(object.name) + ", of material " +
                          quote(scene.materials[object.material].name));
    const auto lines = std::ranges::find(unsupported, "points-lines", &UnsupportedFeature::id);
    check(!scene.objects.empty(), Failure::bad_data, file,
          ": wanted at least one triangle with an area, found none",
          lines == unsupported.end() ? "" : ", only points or lines, which are not drawn");
    scene.unsupported = std::move(unsupported);
    scene.warnings = notes.lines(file);
}

} // namespace catoptric::scene
