#include "scene/shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

namespace catoptric::scene {

namespace {

using Vertex = std::uint32_t;
using Midpoints = std::map<std::pair<Vertex, Vertex>, Vertex>;

/// The vertex on the sphere over the middle of the edge, made when first asked for.
Vertex midpoint(Mesh& mesh, Midpoints& known, Vertex a, Vertex b) {
    const auto [entry, is_new] = known.try_emplace(std::minmax(a, b),
                                                   static_cast<Vertex>(mesh.positions.size()));
    if (is_new) mesh.positions.push_back(glm::normalize(mesh.positions[a] + mesh.positions[b]));
    return entry->second;
}

void subdivide(Mesh& mesh) {
    Midpoints known;
    std::vector<uvec3> finer;
    finer.reserve(4 * mesh.triangles.size());
    for (const uvec3& t : mesh.triangles) {
        const Vertex xy = midpoint(mesh, known, t.x, t.y);
        const Vertex yz = midpoint(mesh, known, t.y, t.z);
        const Vertex zx = midpoint(mesh, known, t.z, t.x);
        finer.insert(finer.end(), {{t.x, xy, zx}, {xy, t.y, yz}, {zx, yz, t.z}, {xy, yz, zx}});
    }
    mesh.triangles = std::move(finer);
}

} // namespace

Mesh quad(std::string name, dvec3 a, dvec3 b, dvec3 c, dvec3 d) {
    const vec3 normal(glm::normalize(glm::cross(b - a, c - a)));
    return {.name = std::move(name),
            .positions = {a, b, c, d},
            .normals = std::vector<vec3>(4, normal),
            .triangles = {{0, 1, 2}, {0, 2, 3}}};
}

Mesh wall(int face, dvec3 lo, dvec3 hi) {
    const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::array<dvec3, 4> corners;
    for (std::size_t i = 0; i < 4; ++i) {
        corners[i][axis] = face % 2 ? lo[axis] : hi[axis];
        corners[i][u] = i == 1 || i == 2 ? hi[u] : lo[u];
        corners[i][v] = i >= 2 ? hi[v] : lo[v];
    }
    // (a b c d) counter-clockwise seen from +axis: right for the wall on the low side.
    if (face % 2)
        return quad("wall" + std::to_string(face), corners[0], corners[1], corners[2], corners[3]);
    return quad("wall" + std::to_string(face), corners[3], corners[2], corners[1], corners[0]);
}

Mesh ball(std::string name, int levels) {
    const double s = std::sqrt(2.0), q = std::sqrt(6.0);
    Mesh mesh{.name = std::move(name)};
    mesh.positions = {
        {0, 0, -1}, {0, 2 * s / 3, 1.0 / 3}, {-q / 3, -s / 3, 1.0 / 3}, {q / 3, -s / 3, 1.0 / 3}};
    mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}}; // counter-clockwise from outside
    for (int level = 0; level < levels; ++level) subdivide(mesh);
    mesh.normals.assign(mesh.positions.begin(), mesh.positions.end());
    return mesh;
}

} // namespace catoptric::scene
