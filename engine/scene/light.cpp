#include "scene/light.hpp"

#include "scene/transform.hpp"

#include <array>
#include <cmath>
#include <map>
#include <numeric>

namespace catoptric::scene {

namespace {

/// Sets of vertices that triangles connect; each vertex starts alone.
class Islands {
public:
    explicit Islands(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), std::size_t(0));
    }
    std::size_t find(std::size_t vertex) {
        while (parent_[vertex] != vertex) vertex = parent_[vertex] = parent_[parent_[vertex]];
        return vertex;
    }
    void join(std::size_t a, std::size_t b) { parent_[find(a)] = find(b); }

private:
    std::vector<std::size_t> parent_;
};

/// For each vertex the first one at the identical position.
std::vector<std::size_t> first_at_position(const Mesh& mesh) {
    std::map<std::array<double, 3>, std::size_t> seen;
    std::vector<std::size_t> first(mesh.positions.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
        const dvec3& p = mesh.positions[i];
        first[i] = seen.try_emplace({p.x, p.y, p.z}, i).first->second;
    }
    return first;
}

struct Sums {
    dvec3 positions{0}, normals{0};
    double position_count = 0, normal_count = 0, area = 0;

    void add_position(const dvec3& position) { positions += position, position_count += 1; }
    void add_vertex(const dvec3& normal, double its_area) {
        normals += normal, normal_count += 1, area += its_area;
    }
};

/// The mean of float unit normals that cancel in truth is not zero but within their rounding,
/// 2^-24 for each component; 16 times that is still far below any real mean.
bool vanishes(const Sums& sums) {
    const double rounding = 16 * std::ldexp(1.0, -24);
    return !(glm::length(sums.normals) > rounding * sums.normal_count);
}

PointLight light_of(const Sums& sums, const Material& material) {
    return {.position = sums.positions / sums.position_count,
            .normal = material.two_sided || vanishes(sums) ? dvec3(0)
                                                           : glm::normalize(sums.normals),
            .area = sums.area,
            .emission = scene::light_of(material)};
}

double area_of(const std::vector<dvec3>& world, const uvec3& t) {
    return 0.5 * glm::length(glm::cross(world[t.y] - world[t.x], world[t.z] - world[t.x]));
}

/// The sums of each connected component, in the order of their first vertices; and which of them
/// each triangle with an area belongs to.
struct Components {
    std::vector<Sums> sums;
    std::vector<std::optional<std::size_t>> of_triangles;
};

Components components_of(const Mesh& mesh, const dmat4& world_from_object) {
    std::vector<dvec3> world;
    for (const dvec3& p : mesh.positions) world.push_back(transform_point(world_from_object, p));
    const std::vector<std::size_t> first = first_at_position(mesh);

    Islands islands(world.size());
    std::vector<double> area(world.size(), 0); // of the triangles that begin at the vertex
    std::vector<bool> used(world.size(), false);
    for (const uvec3& t : mesh.triangles) {
        const double triangle_area = area_of(world, t);
        if (!(triangle_area > 0)) continue;
        islands.join(first[t.x], first[t.y]);
        islands.join(first[t.x], first[t.z]);
        used[t.x] = used[t.y] = used[t.z] = true;
        area[t.x] += triangle_area;
    }

    const dmat3 normal_to_world = normal_matrix(world_from_object);
    std::map<std::size_t, std::size_t> index_of_root;
    Components components;
    std::vector<Sums>& sums = components.sums;
    std::vector<bool> counted(world.size(), false);
    for (std::size_t i = 0; i < world.size(); ++i) {
        if (!used[i]) continue;
        const std::size_t root = islands.find(first[i]);
        const std::size_t index = index_of_root.try_emplace(root, sums.size()).first->second;
        if (index == sums.size()) sums.emplace_back();
        const dvec3 normal = normalized_or_zero(normal_to_world * dvec3(mesh.normals[i]));
        sums[index].add_vertex(normal, area[i]);
        if (!counted[first[i]]) sums[index].add_position(world[i]);
        counted[first[i]] = true;
    }
    for (const uvec3& t : mesh.triangles)
        components.of_triangles.push_back(
            area_of(world, t) > 0 ? std::optional(index_of_root.at(islands.find(first[t.x])))
                                  : std::nullopt);
    return components;
}

PointLight light_of(const Punctual& punctual) {
    PointLight light{.position = dvec3(punctual.world_from_light[3]),
                     .area = 1,
                     .emission = punctual.intensity,
                     .range = punctual.range};
    if (punctual.kind == Punctual::Kind::point) return light;
    light.axis = -normalized_or_zero(dvec3(punctual.world_from_light[2]));
    light.directional = punctual.kind == Punctual::Kind::directional;
    if (light.directional) return light;
    light.cos_inner = punctual.cos_inner, light.cos_outer = punctual.cos_outer;
    return light;
}

} // namespace

std::vector<std::optional<std::size_t>> light_of_triangles(const Mesh& mesh,
                                                           const dmat4& world_from_object) {
    return components_of(mesh, world_from_object).of_triangles;
}

std::vector<PointLight> lights(const Scene& scene) {
    std::vector<PointLight> all;
    for (const Object& object : scene.objects) {
        const Material& material = scene.materials[object.material];
        if (scene::light_of(material) == vec3(0)) continue;
        const Mesh& mesh = scene.meshes[object.mesh];
        for (const Sums& sums : components_of(mesh, object.world_from_object).sums)
            all.push_back(light_of(sums, material));
    }
    for (const Punctual& punctual : scene.punctual) all.push_back(light_of(punctual));
    return all;
}

} // namespace catoptric::scene
