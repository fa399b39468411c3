#include "scene/flat_mirror.hpp"

#include "scene/material_facts.hpp"
#include "scene/rough_reflectors.hpp"
#include "scene/topology.hpp"
#include "scene/transform.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <ranges>
#include <utility>

namespace catoptric::scene {

namespace {

/// Returns the unit normal of the largest triangle; zero if no triangle has an area.
dvec3 main_normal(const Mesh& mesh, const dmat4& world_from_object) {
    dvec3 largest(0);
    for (const uvec3& triangle : mesh.triangles) {
        const dvec3 a = transform_point(world_from_object, mesh.positions[triangle.x]),
                    b = transform_point(world_from_object, mesh.positions[triangle.y]),
                    c = transform_point(world_from_object, mesh.positions[triangle.z]);
        const dvec3 normal = cross(b - a, c - a);
        if (dot(normal, normal) > dot(largest, largest)) largest = normal;
    }
    const double size = length(largest);
    return size > 0 ? largest / size : dvec3(0);
}

/// Returns the sine of the angle between two unit vectors. For small angles it is about the angle.
double sine_between(const dvec3& a, const dvec3& b) { return length(cross(a, b)); }

/// Returns the corners of the convex hull of points in a plane (Andrew 1979).
std::vector<dvec3> convex_hull(std::vector<dvec3> points, const dvec3& normal) {
    const dvec3 size = abs(normal), other = size.x <= size.y && size.x <= size.z ? dvec3(1, 0, 0)
                                            : size.y <= size.z                   ? dvec3(0, 1, 0)
                                                                                 : dvec3(0, 0, 1);
    const dvec3 right = normalize(cross(other, normal)), up = cross(normal, right);
    const auto place = [&](const dvec3& p) { return std::pair(dot(p, right), dot(p, up)); };
    std::ranges::sort(points, {}, place);
    std::vector<dvec3> corners;
    const auto add_half = [&](const auto& half) {
        const std::size_t first = corners.size();
        for (const dvec3& p : half) {
            const auto turns_right = [&] {
                const dvec3 &a = corners[corners.size() - 2], &b = corners.back();
                return dot(cross(b - a, p - b), normal) <= 0;
            };
            while (corners.size() >= first + 2 && turns_right()) corners.pop_back();
            corners.push_back(p);
        }
        corners.pop_back(); // the other half begins with this corner
    };
    add_half(points);
    add_half(std::views::reverse(points));
    return corners;
}

constexpr std::size_t kMaxPlanes = 64, kMaxFlatMirrorTriangles = 65536;
constexpr double kCoplanarTolerance =
    1e-4; // 1e-4 radians between normals; for distances, 1e-4 of the surface's extent

/// Triangles of a mesh in the world.
struct MeshTriangles {
    const Mesh& mesh;
    std::vector<dvec3> places, normals; ///< of the mesh's vertices

    MeshTriangles(const Mesh& of, const dmat4& world_from_object) : mesh(of) {
        const dmat3 turns = normal_matrix(world_from_object);
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            places.push_back(transform_point(world_from_object, mesh.positions[i]));
            normals.push_back(transform_normal(turns, dvec3(mesh.normals[i])));
        }
    }
    /// Returns a vector along the normal, as long as twice the triangle's area.
    dvec3 edge_cross(std::size_t i) const {
        const uvec3& t = mesh.triangles[i];
        return cross(places[t.y] - places[t.x], places[t.z] - places[t.x]);
    }
    /// Returns the largest angle between `normal` and a corner's normal, in radians.
    double max_normal_deviation(std::size_t i, const dvec3& normal) const {
        double most = 0;
        for (int corner = 0; corner < 3; ++corner)
            most = std::max(most, sine_between(normals[mesh.triangles[i][corner]], normal));
        return most;
    }
};

/// A flat face while its triangles are being collected.
struct FlatFaceBuilder {
    dvec3 point{0}, normal{0};
    double area = 0; ///< twice the area
    std::vector<std::uint32_t> triangles;
};

/// Returns the planes of the triangles whose normals agree; nothing if there are more than
/// kMaxPlanes.
std::optional<std::vector<FlatFaceBuilder>> group_by_plane(const MeshTriangles& triangles,
                                                           double extent) {
    std::vector<FlatFaceBuilder> planes;
    for (std::uint32_t i = 0; i < triangles.mesh.triangles.size(); ++i) {
        const dvec3 along = triangles.edge_cross(i), normal = normalized_or_zero(along);
        if (normal == dvec3(0) ||
            !(triangles.max_normal_deviation(i, normal) <= kMaxPlaneDeviation))
            continue;
        const uvec3& t = triangles.mesh.triangles[i];
        const auto holds = [&](const FlatFaceBuilder& plane) {
            if (!(dot(plane.normal, normal) > 0 &&
                  sine_between(plane.normal, normal) <= kCoplanarTolerance))
                return false;
            return std::ranges::all_of(std::array{t.x, t.y, t.z}, [&](std::uint32_t corner) {
                return std::abs(dot(triangles.places[corner] - plane.point, plane.normal)) <=
                       kCoplanarTolerance * extent;
            });
        };
        auto plane = std::ranges::find_if(planes, holds);
        if (plane == planes.end()) {
            if (planes.size() == kMaxPlanes) return std::nullopt;
            planes.push_back({.point = triangles.places[t.x], .normal = normal, .triangles = {}});
            plane = planes.end() - 1;
        }
        plane->area += length(along);
        plane->triangles.push_back(i);
    }
    return planes;
}

std::vector<TriangleRun> to_runs(const std::vector<std::uint32_t>& ascending) {
    std::vector<TriangleRun> runs;
    for (const std::uint32_t i : ascending) {
        if (!runs.empty() && runs.back().end == i)
            ++runs.back().end;
        else
            runs.push_back({i, i + 1});
    }
    return runs;
}

FlatFace make_face(const MeshTriangles& triangles, const FlatFaceBuilder& plane, double area,
                   bool is_one_sided) {
    FlatFace face{.point = plane.point,
                  .normal = plane.normal,
                  .corners = {},
                  .share = plane.area / area,
                  .is_one_sided = is_one_sided,
                  .triangles = to_runs(plane.triangles)};
    std::vector<dvec3> points;
    for (const std::uint32_t i : plane.triangles) {
        face.off = std::max(face.off, triangles.max_normal_deviation(i, plane.normal));
        for (int corner = 0; corner < 3; ++corner)
            points.push_back(triangles.places[triangles.mesh.triangles[i][corner]]);
    }
    face.corners = convex_hull(points, plane.normal);
    double size = 0, high = 0;
    for (const dvec3& corner : face.corners)
        size = std::max(size, distance(corner, face.corners.front()));
    for (const dvec3& p : points) high = std::max(high, std::abs(dot(p - face.point, face.normal)));
    face.off = std::max(face.off, high / size);
    return face;
}

} // namespace

double FlatFaces::flat_share(double tolerance) const {
    double sum = 0;
    for (const FlatFace& face : faces)
        if (face.off <= tolerance) sum += face.share;
    return sum;
}

FlatFaces find_flat_faces(const Scene& scene, const Object& object) {
    const Mesh& mesh = scene.meshes[object.mesh];
    FlatFaces none;
    if (scene.materials[object.material].normal_texture) none.misfit = "bumpy";
    if (is_glass(scene.materials[object.material])) none.misfit = "glass";
    none.is_rough = may_reflect_by_lobe(scene, object);
    if (none.misfit.empty()) {
        FlatFaces found = find_flat_faces(mesh, object.world_from_object);
        found.is_rough = none.is_rough;
        return found;
    }
    if (!mesh.triangles.empty())
        none.bent = {{0, static_cast<std::uint32_t>(mesh.triangles.size())}};
    return none;
}

FlatFaces find_flat_faces(const Mesh& mesh, const dmat4& world_from_object) {
    const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
    FlatFaces found;
    if (std::optional<FlatFace> whole = find_mesh_plane(mesh, world_from_object)) {
        whole->triangles = {{0, count}};
        found.faces.push_back(std::move(*whole));
        return found;
    }
    if (count > 0) found.bent = {{0, count}};
    if (count > kMaxFlatMirrorTriangles) return found;
    const MeshTriangles triangles(mesh, world_from_object);
    Bounds<double> box;
    for (const dvec3& place : triangles.places) box.add(place);
    double area = 0;
    for (std::uint32_t i = 0; i < count; ++i) area += length(triangles.edge_cross(i));
    std::optional<std::vector<FlatFaceBuilder>> planes;
    if (!box.empty() && area > 0) planes = group_by_plane(triangles, length(box.extent()));
    if (!planes) return found;
    std::erase_if(*planes,
                  [&](const FlatFaceBuilder& plane) { return plane.area < kMinFaceShare * area; });
    std::ranges::stable_sort(*planes, std::ranges::greater(), &FlatFaceBuilder::area);
    if (planes->size() > kMaxFlatFaces) planes->resize(kMaxFlatFaces);
    if (planes->empty()) return found;
    // The normals of a closed body with negative volume point inwards: it is inside out. They are
    // turned below.
    const dvec3 centre = box.centre();
    const bool is_body = is_closed_surface(mesh.positions, mesh.triangles);
    double volume = 0;
    for (std::uint32_t i = 0; i < count; ++i)
        volume += dot(triangles.edge_cross(i), triangles.places[mesh.triangles[i].x] - centre);
    std::vector<bool> in_face(count);
    for (FlatFaceBuilder& plane : *planes) {
        for (const std::uint32_t i : plane.triangles) in_face[i] = true;
        if (volume < 0) plane.normal = -plane.normal;
        found.faces.push_back(make_face(triangles, plane, area, is_body && volume != 0));
    }
    std::vector<std::uint32_t> bent;
    for (std::uint32_t i = 0; i < count; ++i)
        if (!in_face[i]) bent.push_back(i);
    found.bent = to_runs(bent);
    return found;
}

std::optional<FlatFace> find_mesh_plane(const Mesh& mesh, const dmat4& world_from_object) {
    // The test of the first normals rejects most curved meshes, before the whole mesh is tested.
    const dmat3 turns = normal_matrix(world_from_object);
    const auto normal_of = [&](std::size_t vertex) {
        return transform_normal(turns, dvec3(mesh.normals[vertex]));
    };
    for (const uvec3& triangle : mesh.triangles)
        if (sine_between(normal_of(triangle.x), normal_of(mesh.triangles.front().x)) >
            2 * kMaxPlaneDeviation)
            return {};
    FlatFace found;
    found.normal = main_normal(mesh, world_from_object);
    if (found.normal == dvec3(0)) return {};
    std::vector<dvec3> points;
    for (const uvec3& triangle : mesh.triangles)
        for (int corner = 0; corner < 3; ++corner) {
            points.push_back(transform_point(world_from_object, mesh.positions[triangle[corner]]));
            found.off = std::max(found.off,
                                 sine_between(normal_of(triangle[corner]), found.normal));
        }
    found.point = points.front();
    found.corners = convex_hull(points, found.normal);
    double size = 0;
    for (const dvec3& corner : found.corners)
        size = std::max(size, distance(corner, found.corners.front()));
    for (const dvec3& p : points)
        found.off = std::max(found.off, std::abs(dot(p - found.point, found.normal)) / size);
    // This form of the comparison also rejects NaN.
    return found.off <= kMaxPlaneDeviation ? std::optional(found) : std::nullopt;
}

double flat_tolerance(const Camera& camera, uvec2 size) {
    const double half = camera.orthographic_height > 0
                            ? 1
                            : std::tan(glm::radians(camera.vertical_fov_degrees) / 2);
    return std::atan(2 * half / size.y) / 16;
}

} // namespace catoptric::scene
