#include "scene/shapes.hpp"

#include "scene/pattern.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>

namespace catoptric::scene {

namespace {

using VertexIndex = std::uint32_t;
using EdgeMidpoints = std::map<std::pair<VertexIndex, VertexIndex>, VertexIndex>;

/// Returns the vertex on the sphere over the middle of the edge. The first call for an edge
/// creates the vertex.
VertexIndex sphere_midpoint(Mesh& mesh, EdgeMidpoints& known, VertexIndex a, VertexIndex b) {
    const auto [entry, is_new] = known.try_emplace(std::minmax(a, b),
                                                   static_cast<VertexIndex>(mesh.positions.size()));
    if (is_new) mesh.positions.push_back(glm::normalize(mesh.positions[a] + mesh.positions[b]));
    return entry->second;
}

void subdivide(Mesh& mesh) {
    EdgeMidpoints known;
    std::vector<uvec3> finer;
    finer.reserve(4 * mesh.triangles.size());
    for (const uvec3& t : mesh.triangles) {
        const VertexIndex xy = sphere_midpoint(mesh, known, t.x, t.y);
        const VertexIndex yz = sphere_midpoint(mesh, known, t.y, t.z);
        const VertexIndex zx = sphere_midpoint(mesh, known, t.z, t.x);
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

Mesh box(std::string name, dvec3 lo, dvec3 hi) {
    Mesh box_mesh{.name = std::move(name)};
    for (int face = 0; face < 6; ++face) {
        const Mesh side = make_box_wall(face, hi,
                                        lo); // faces outwards because low and high are exchanged
        const auto first = static_cast<VertexIndex>(box_mesh.positions.size());
        box_mesh.positions.insert(box_mesh.positions.end(), side.positions.begin(),
                                  side.positions.end());
        box_mesh.normals.insert(box_mesh.normals.end(), side.normals.begin(), side.normals.end());
        box_mesh.uv[0].insert(box_mesh.uv[0].end(), {{0, 1}, {1, 1}, {1, 0}, {0, 0}});
        for (const uvec3& triangle : side.triangles) box_mesh.triangles.push_back(triangle + first);
    }
    return box_mesh;
}

Mesh lathe(std::string name, const std::vector<dvec2>& profile, int around) {
    Mesh mesh{.name = std::move(name)};
    const auto along = [&](std::size_t i) { // zero if the point is given twice
        return i + 1 < profile.size() ? profile[i + 1] - profile[i] : dvec2(0);
    };
    const auto turned = [](const dvec2& way) { // the outside of a step of the profile
        const double length = glm::length(way);
        return length > 0 ? dvec2(way.y, -way.x) / length : dvec2(0);
    };
    double length = 0, far = 0;
    for (std::size_t i = 0; i < profile.size(); ++i) length += glm::length(along(i));
    for (std::size_t i = 0; i < profile.size(); ++i) {
        const dvec2 before = i > 0 ? turned(along(i - 1)) : dvec2(0), after = turned(along(i));
        const dvec2 sum = before + after;
        const dvec2 normal = sum / std::max(glm::length(sum), 1e-9);
        for (int k = 0; k <= around; ++k) {
            const double angle = 2 * std::numbers::pi * k / around;
            const dvec3 out(std::cos(angle), 0, -std::sin(angle));
            mesh.positions.push_back(profile[i].x * out + dvec3(0, profile[i].y, 0));
            mesh.normals.push_back(vec3(normal.x * out + dvec3(0, normal.y, 0)));
            mesh.uv[0].push_back(vec2(dvec2(double(k) / around, 1 - far / length)));
        }
        far += glm::length(along(i));
    }
    const auto row = static_cast<VertexIndex>(around + 1);
    for (VertexIndex i = 0; i + 1 < profile.size(); ++i) {
        if (along(i) == dvec2(0)) continue;
        for (VertexIndex k = 0; k + 1 < row; ++k) {
            const VertexIndex a = i * row + k, b = a + 1, c = b + row, d = a + row;
            if (profile[i].x > 0) mesh.triangles.emplace_back(a, b, c);
            if (profile[i + 1].x > 0) mesh.triangles.emplace_back(a, c, d);
        }
    }
    return mesh;
}

Mesh torus(std::string name, double radius, double thickness, int around) {
    std::vector<dvec2> ring;
    for (int k = 0; k <= around / 2; ++k) {
        const double angle = 4 * std::numbers::pi * k / around;
        ring.push_back({radius + thickness * std::cos(angle), thickness * std::sin(angle)});
    }
    Mesh mesh = lathe(std::move(name), ring, around);
    // The normals are computed exactly and not from triangles, so that they are smooth where the
    // ring closes.
    for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
        const dvec3 out = mesh.positions[i] * dvec3(1, 0, 1);
        mesh.normals[i] = vec3(glm::normalize(mesh.positions[i] - radius * glm::normalize(out)));
    }
    return mesh;
}

Mesh make_box_wall(int face, dvec3 lo, dvec3 hi) {
    const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::array<dvec3, 4> corners;
    for (std::size_t i = 0; i < 4; ++i) {
        corners[i][axis] = face % 2 ? lo[axis] : hi[axis];
        corners[i][u] = i == 1 || i == 2 ? hi[u] : lo[u];
        corners[i][v] = i >= 2 ? hi[v] : lo[v];
    }
    // (a b c d) is counter-clockwise seen from +axis, as the wall on the low side needs.
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

RoomPaints add_papered_room(Scene& scene, dvec3 lo, dvec3 hi, uvec3 dark_floor, uvec3 light_floor,
                            int papered) {
    const auto paint = [&](const char* name, vec3 albedo) {
        return add_material(scene, {.name = name, .albedo = albedo});
    };
    const std::size_t floor = add_material(
        scene, {.name = "floor",
                .albedo = vec3(1),
                .albedo_texture = make_checker_texture(dark_floor, light_floor, 8)});
    const std::size_t white = paint("white", {.72f, .71f, .68f}),
                      orange = paint("orange", {.7f, .3f, .08f}),
                      blue = paint("blue", {.1f, .22f, .5f});
    const std::size_t wallpaper = add_material(
        scene, {.name = "wallpaper",
                .albedo = vec3(1),
                .albedo_texture = make_wallpaper_texture({196, 190, 170}, {60, 110, 80})});
    const std::array<std::size_t, 6> walls{orange, blue, white, floor, white, white};
    for (int face = 0; face < 6; ++face)
        add_mesh(scene, make_box_wall(face, lo, hi),
                 face == papered ? wallpaper : walls[static_cast<std::size_t>(face)]);
    return {orange, blue};
}

} // namespace catoptric::scene
