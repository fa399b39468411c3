#include "scene/light.hpp"

#include "scene/light_kind.hpp"
#include "scene/material_facts.hpp"
#include "scene/topology.hpp"
#include "scene/transform.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

namespace catoptric::scene {

namespace {

/// Sets of vertices that triangles connect. At first, each vertex is a set of its own.
class VertexSets {
public:
    explicit VertexSets(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), std::size_t(0));
    }
    std::size_t root(std::size_t vertex) {
        while (parent_[vertex] != vertex) vertex = parent_[vertex] = parent_[parent_[vertex]];
        return vertex;
    }
    void join(std::size_t a, std::size_t b) { parent_[root(a)] = root(b); }

private:
    std::vector<std::size_t> parent_;
};

struct ComponentSums {
    dvec3 positions{0}, normals{0};
    double position_count = 0, normal_count = 0, area = 0;
    dmat3 facets{0};  ///< outer products of the facets' unit normals, times their areas
    dmat3 moments{0}; ///< integral over the area: outer products of points minus the mean position
    bool closed = true;

    void add_position(const dvec3& position) { positions += position, position_count += 1; }
    void add_vertex(const dvec3& normal, double its_area) {
        normals += normal, normal_count += 1, area += its_area;
    }
    dvec3 mean_position() const { return positions / position_count; }
    /// Adds a triangle to `moments`. Call it after all positions are added. The mean outer product
    /// of a triangle's points is that of its corners and of their sum, divided by 12.
    void add_triangle(const std::array<dvec3, 3>& corners, double triangle_area) {
        dvec3 sum(0);
        dmat3 products(0);
        for (const dvec3& corner : corners) {
            const dvec3 arm = corner - mean_position();
            sum += arm, products += glm::outerProduct(arm, arm);
        }
        moments += triangle_area / 12 * (products + glm::outerProduct(sum, sum));
    }
};

/// Returns whether the mean normal is zero. The mean of float unit normals that should cancel
/// differs from zero by their rounding, 2^-24 for each component. The limit is 16 times this
/// rounding, still far below any real mean.
bool has_no_normal(const ComponentSums& sums) {
    const double rounding = 16 * std::ldexp(1.0, -24);
    return !(glm::length(sums.normals) > rounding * sums.normal_count);
}

/// Rotates the columns of `axes` until the symmetric `matrix` is diagonal along them (Jacobi 1846).
void diagonalise(dmat3& matrix, dmat3& axes) {
    constexpr int kJacobiSweeps =
        12; // each sweep squares the error; a float's precision takes four
    for (int turn = 0; turn < 3 * kJacobiSweeps; ++turn) {
        const int i = turn % 3, j = (i + 1) % 3;
        if (matrix[i][j] == 0) continue;
        const double angle = std::atan2(2 * matrix[i][j], matrix[j][j] - matrix[i][i]) / 2;
        dmat3 rotation(1);
        rotation[i][i] = rotation[j][j] = std::cos(angle);
        rotation[j][i] = std::sin(angle), rotation[i][j] = -rotation[j][i];
        matrix = glm::transpose(rotation) * matrix * rotation;
        matrix[i][j] = matrix[j][i] = 0;
        axes = axes * rotation;
    }
}

/// Returns the mean over all directions of the length of `cosines * direction`.
double mean_projected_length(const dvec3& cosines) {
    constexpr int kDirectionStepsPerOctant = 64; // steps across an octant, in each direction
    double sum = 0;
    for (int i = 0; i < kDirectionStepsPerOctant; ++i)
        for (int j = 0; j < kDirectionStepsPerOctant; ++j) {
            const double z = (i + .5) / kDirectionStepsPerOctant,
                         turn = (j + .5) / kDirectionStepsPerOctant * std::numbers::pi / 2;
            const double flat = std::sqrt(1 - z * z);
            sum += glm::length(cosines * dvec3(flat * std::cos(turn), flat * std::sin(turn), z));
        }
    return sum / (kDirectionStepsPerOctant * kDirectionStepsPerOctant);
}

/// Sets `axes` and `cosines` of an open two-sided lamp. The mean |cosine| of its facets to a
/// direction d is near the root of their mean square cosine, a quadratic form of d. The root is
/// exact for a board. For a tube and a ball it is the true mean times a constant. The constant
/// follows from the mean over all directions, which is a half for any surface.
void set_two_sided_axes(PointLight& light, const ComponentSums& sums) {
    dmat3 squares = sums.facets / sums.area;
    light.axes = dmat3(1);
    diagonalise(squares, light.axes);
    dvec3 cosines(squares[0][0], squares[1][1], squares[2][2]);
    cosines = glm::sqrt(glm::max(cosines, 0.0));
    // The axis with the largest cosine comes last, because shadow maps look along it.
    const int last = cosines.x >= cosines.y && cosines.x >= cosines.z ? 0
                     : cosines.y >= cosines.z                         ? 1
                                                                      : 2;
    const int first = (last + 1) % 3, second = (last + 2) % 3;
    light.axes = dmat3(light.axes[first], light.axes[second], light.axes[last]);
    cosines = {cosines[first], cosines[second], cosines[last]};
    light.cosines = cosines * (.5 / mean_projected_length(cosines));
}

/// Returns PointLight::half_axes. An even spread over [-a, a] has the variance a^2 / 3.
dmat3 find_half_axes(const ComponentSums& sums) {
    dmat3 variances = sums.moments / sums.area, axes(1);
    diagonalise(variances, axes);
    std::array<int, 3> order{0, 1, 2};
    std::ranges::stable_sort(order, std::ranges::greater(),
                             [&](int axis) { return variances[axis][axis]; });
    // A closed lamp shows an outline. A sphere of radius r has the variance r^2 / 3 along each
    // axis, and its outline r^2 / 4. A thin box has the variances of its outline.
    const double smallest = variances[order[2]][order[2]],
                 hidden = sums.closed ? .25 * std::max(smallest, 0.0) : 0;
    dmat3 half_axes(0);
    for (int i = 0; i < 3; ++i)
        half_axes[i] = axes[order[i]] *
                       std::sqrt(3 * std::max(variances[order[i]][order[i]] - hidden, 0.0));
    return half_axes;
}

PointLight make_point_light(const ComponentSums& sums, const Material& material) {
    PointLight light{.position = sums.mean_position(),
                     .area = sums.area,
                     .is_lamp = true,
                     .closed = sums.closed,
                     .half_axes = find_half_axes(sums),
                     .emission = scene::emitted_radiance(material)};
    if (light.closed) return light;
    if (material.two_sided)
        set_two_sided_axes(light, sums);
    else if (!has_no_normal(sums))
        light.normal = glm::normalize(sums.normals);
    return light;
}

dvec3 edge_product(const std::vector<dvec3>& world, const uvec3& t) {
    return glm::cross(world[t.y] - world[t.x], world[t.z] - world[t.x]);
}

double triangle_area(const std::vector<dvec3>& world, const uvec3& t) {
    return 0.5 * glm::length(edge_product(world, t));
}

/// Sums of each connected component, in the order of their first vertices, and the component of
/// each triangle with an area.
struct MeshComponents {
    std::vector<ComponentSums> sums;
    std::vector<std::optional<std::size_t>> of_triangles;
};

MeshComponents find_components(const Mesh& mesh, const dmat4& world_from_object) {
    std::vector<dvec3> world;
    for (const dvec3& p : mesh.positions) world.push_back(transform_point(world_from_object, p));
    const std::vector<std::size_t> first = weld_vertices(mesh.positions);

    VertexSets islands(world.size());
    // Area of the triangles whose first corner is the vertex.
    std::vector<double> area(world.size(), 0);
    std::vector<dmat3> facets(world.size(), dmat3(0));
    std::vector<bool> used(world.size(), false);
    std::vector<TriangleCorners> corners;
    for (const uvec3& t : mesh.triangles) {
        corners.push_back({first[t.x], first[t.y], first[t.z]});
        const double own_area = triangle_area(world, t);
        if (!(own_area > 0)) continue;
        islands.join(first[t.x], first[t.y]);
        islands.join(first[t.x], first[t.z]);
        used[t.x] = used[t.y] = used[t.z] = true;
        area[t.x] += own_area;
        const dvec3 facet = normalized_or_zero(edge_product(world, t));
        facets[t.x] += own_area * glm::outerProduct(facet, facet);
    }

    const dmat3 normal_to_world = normal_matrix(world_from_object);
    std::map<std::size_t, std::size_t> index_of_root;
    MeshComponents components;
    std::vector<ComponentSums>& sums = components.sums;
    std::vector<bool> counted(world.size(), false);
    for (std::size_t i = 0; i < world.size(); ++i) {
        if (!used[i]) continue;
        const std::size_t root = islands.root(first[i]);
        const std::size_t index = index_of_root.try_emplace(root, sums.size()).first->second;
        if (index == sums.size()) sums.emplace_back();
        const dvec3 normal = normalized_or_zero(normal_to_world * dvec3(mesh.normals[i]));
        sums[index].add_vertex(normal, area[i]);
        sums[index].facets += facets[i];
        if (!counted[first[i]]) sums[index].add_position(world[i]);
        counted[first[i]] = true;
    }
    for_each_edge(triangle_edges(corners), [&](std::span<const TriangleEdge> edge) {
        if (edge.size() == 2) return;
        for (const std::size_t end : {edge[0].low, edge[0].high})
            if (const auto index = index_of_root.find(islands.root(end));
                index != index_of_root.end())
                sums[index->second].closed = false;
    });
    for (const uvec3& t : mesh.triangles) {
        const double own_area = triangle_area(world, t);
        std::optional<std::size_t>& index = components.of_triangles.emplace_back();
        if (!(own_area > 0)) continue;
        index = index_of_root.at(islands.root(first[t.x]));
        sums[*index].add_triangle({world[t.x], world[t.y], world[t.z]}, own_area);
    }
    return components;
}

/// Triangle of a lamp, world units.
struct LampFacet {
    dvec3 corner, second, third; ///< a corner, and the sides from it to the two others
    dvec3 normal{0};             ///< unit length, on the side of the vertex normals
    double area = 0;
};

/// Returns the place of a facet on a curve through space (Morton order). Facets that are near each
/// other on the curve are near each other in space. `middle` has coordinates from 0 to 1.
std::uint64_t morton_code(const dvec3& middle) {
    constexpr int kMortonBitsPerAxis = 20; // bits of each coordinate in a Morton code
    std::uint64_t code = 0;
    for (int bit = kMortonBitsPerAxis - 1; bit >= 0; --bit)
        for (int axis = 0; axis < 3; ++axis) {
            const auto cell = static_cast<std::uint64_t>(std::clamp(middle[axis], 0.0, 1.0) *
                                                         ((1 << kMortonBitsPerAxis) - 1));
            code = code << 1 | (cell >> bit & 1);
        }
    return code;
}

/// Sorts facets so that equal parts of their area, one after the other, are compact patches. In the
/// order of a mesh, points at equal steps of area could all lie on one side of a lamp.
void sort_facets(std::vector<LampFacet>& facets) {
    Bounds<double> box;
    const auto middle = [](const LampFacet& facet) {
        return facet.corner + (facet.second + facet.third) / 3.0;
    };
    for (const LampFacet& facet : facets) box.add(middle(facet));
    const dvec3 extent = box.extent();
    const double size = std::max({extent.x, extent.y, extent.z});
    if (!(size > 0)) return;
    std::vector<std::pair<std::uint64_t, std::size_t>> order;
    for (std::size_t i = 0; i < facets.size(); ++i)
        order.emplace_back(morton_code((middle(facets[i]) - box.lo) / size), i);
    std::ranges::sort(order);
    std::vector<LampFacet> sorted;
    for (const auto& [code, i] : order) sorted.push_back(facets[i]);
    facets = std::move(sorted);
}

std::vector<std::vector<LampFacet>> lamp_facets(const Mesh& mesh, const dmat4& world_from_object,
                                                const MeshComponents& components) {
    std::vector<dvec3> world;
    for (const dvec3& p : mesh.positions) world.push_back(transform_point(world_from_object, p));
    const dmat3 normal_to_world = normal_matrix(world_from_object);
    std::vector<std::vector<LampFacet>> facets(components.sums.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (!components.of_triangles[i]) continue;
        const uvec3& t = mesh.triangles[i];
        LampFacet facet{world[t.x], world[t.y] - world[t.x], world[t.z] - world[t.x],
                        normalized_or_zero(edge_product(world, t)), triangle_area(world, t)};
        const dvec3 vertex_normals = normal_to_world *
                                     (dvec3(mesh.normals[t.x]) + dvec3(mesh.normals[t.y]) +
                                      dvec3(mesh.normals[t.z]));
        if (glm::dot(facet.normal, vertex_normals) < 0) facet.normal = -facet.normal;
        facets[*components.of_triangles[i]].push_back(facet);
    }
    for (std::vector<LampFacet>& component : facets) sort_facets(component);
    return facets;
}

/// Returns number `i` of van der Corput's sequence to base 2, in [0,1).
double van_der_corput(std::uint32_t i) {
    double result = 0, digit = .5;
    for (; i != 0; i >>= 1, digit /= 2) result += (i & 1) * digit;
    return result;
}

/// Appends `count` lights that replace a lamp, each with an equal share of its area, and extents
/// that are smaller by the root of `count`. They lie at stratified points (Hammersley) of its
/// facets. Each shines to the facet's front, or to both sides if the lamp is open and two-sided.
/// The front of a closed lamp is the side away from the mean of its vertices.
void add_lamp_samples(const std::vector<LampFacet>& facets, const PointLight& lamp, bool two_sided,
                      int count, std::vector<PointLight>& lights) {
    double before = 0; // summed area of the facets before `facet`
    auto facet = facets.begin();
    for (int i = 0; i < count; ++i) {
        const double place = (i + .5) / count * lamp.area;
        while (facet + 1 != facets.end() && place > before + facet->area) before += (facet++)->area;
        const double root = std::sqrt(std::clamp((place - before) / facet->area, 0.0, 1.0)),
                     across = van_der_corput(static_cast<std::uint32_t>(i));
        PointLight light{.position = facet->corner + root * (1 - across) * facet->second +
                                     root * across * facet->third,
                         .area = lamp.area / count,
                         .is_lamp = true,
                         .closed = lamp.closed,
                         .half_axes = lamp.half_axes / std::sqrt(double(count)),
                         .emission = lamp.emission};
        if (two_sided && !lamp.closed) {
            ComponentSums one;
            one.area = light.area;
            one.facets = light.area * glm::outerProduct(facet->normal, facet->normal);
            set_two_sided_axes(light, one);
        } else {
            light.normal = facet->normal;
            if (lamp.closed && glm::dot(light.normal, light.position - lamp.position) < 0)
                light.normal = -light.normal;
        }
        lights.push_back(light);
    }
}

PointLight make_point_light(const PunctualLight& punctual) {
    const LightKind& kind = find_light_kind(punctual.kind);
    PointLight light{.position = dvec3(punctual.world_from_light[3]),
                     .area = 1,
                     .emission = punctual.intensity,
                     .range = punctual.range,
                     .directional = kind.is_parallel,
                     .kind = punctual.kind};
    if (kind.is_aimed) light.axis = -normalized_or_zero(dvec3(punctual.world_from_light[2]));
    if (kind.share != nullptr)
        light.cos_inner = punctual.cos_inner, light.cos_outer = punctual.cos_outer;
    return light;
}

} // namespace

std::vector<std::optional<std::size_t>> triangle_lights(const Mesh& mesh,
                                                        const dmat4& world_from_object) {
    return find_components(mesh, world_from_object).of_triangles;
}

double light_share(const PointLight& light, const dvec3& along) {
    if (light.normal != dvec3(0)) return std::max(0.0, glm::dot(light.normal, along));
    if (light.cosines != dvec3(0)) return glm::length(light.cosines * (along * light.axes));
    return light.is_lamp ? .25 : 1;
}

std::vector<PointLight> list_lights(const Scene& scene) {
    std::vector<PointLight> all;
    for (const Object& object : scene.objects) {
        const Material& material = scene.materials[object.material];
        if (scene::emitted_radiance(material) == vec3(0)) continue;
        const Mesh& mesh = scene.meshes[object.mesh];
        const MeshComponents components = find_components(mesh, object.world_from_object);
        std::vector<std::vector<LampFacet>> facets;
        if (scene.light_samples > 1)
            facets = lamp_facets(mesh, object.world_from_object, components);
        for (std::size_t i = 0; i < components.sums.size(); ++i) {
            const PointLight lamp = make_point_light(components.sums[i], material);
            if (scene.light_samples > 1)
                add_lamp_samples(facets[i], lamp, material.two_sided, scene.light_samples, all);
            else
                all.push_back(lamp);
        }
    }
    for (const PunctualLight& punctual : scene.punctual) all.push_back(make_point_light(punctual));
    return all;
}

} // namespace catoptric::scene
