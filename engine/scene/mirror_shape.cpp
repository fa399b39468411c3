#include "scene/mirror_shape.hpp"

#include "scene/material_facts.hpp"

#include "scene/moved_sphere.hpp"
#include "scene/pose.hpp"
#include "scene/topology.hpp"
#include "scene/transform.hpp"

#include <algorithm>
#include <cmath>

namespace catoptric::scene {

namespace {

constexpr double kFlatnessTolerance = 1e-4;     // share of the extent
constexpr double kSphereVertexTolerance = 1e-3; // vertices: share of the radius
constexpr double kMinBendingShare = .95;        // share of all bending (angle times length)
constexpr double kFacetRadiusTolerance = .1;    // facets: share of the radius
constexpr double kNormalAngleTolerance = .01;   // tolerance of normals, radians

/// Triangles of an object in the world, relative to the centre of its bounds. Each place has one
/// number.
struct CentredTriangles {
    std::vector<dvec3> places;
    std::vector<TriangleCorners> triangles;
    dvec3 centre{0};
    double extent = 0; ///< longest side of the bounds

    dvec3 edge_cross(const TriangleCorners& t) const {
        return glm::cross(places[t[1]] - places[t[0]], places[t[2]] - places[t[0]]);
    }
};

CentredTriangles centred_triangles(const Scene& scene, const Object& object) {
    const Mesh& mesh = scene.meshes[object.mesh];
    const Bounds<double> box = bounds(scene, object);
    CentredTriangles soup;
    if (box.empty()) return soup;
    soup.centre = box.centre();
    soup.extent = std::max({box.extent().x, box.extent().y, box.extent().z});
    const std::vector<std::size_t> first = weld_vertices(mesh.positions);
    std::vector<std::size_t> place(first.size(), soup.places.max_size());
    const auto place_of = [&](std::uint32_t vertex) {
        std::size_t& number = place[first[vertex]];
        if (number == soup.places.max_size()) {
            number = soup.places.size();
            const dvec3& p = mesh.positions[first[vertex]];
            soup.places.push_back(transform_point(object.world_from_object, p) - soup.centre);
        }
        return number;
    };
    for (const uvec3& t : mesh.triangles) {
        const TriangleCorners corners{place_of(t.x), place_of(t.y), place_of(t.z)};
        if (has_distinct_corners(corners)) soup.triangles.push_back(corners);
    }
    return soup;
}

bool are_coplanar(const CentredTriangles& soup) {
    dvec3 sum(0);
    for (const TriangleCorners& t : soup.triangles) sum += soup.edge_cross(t);
    const dvec3 normal = normalized_or_zero(sum);
    if (normal == dvec3(0)) return false;
    const double height = glm::dot(normal, soup.places[soup.triangles.front()[0]]);
    return std::ranges::all_of(soup.triangles, [&](const TriangleCorners& t) {
        const bool in_plane = std::ranges::all_of(t, [&](std::size_t i) {
            return std::abs(glm::dot(normal, soup.places[i]) - height) <=
                   kFlatnessTolerance * soup.extent;
        });
        return in_plane && glm::dot(normal, soup.edge_cross(t)) > 0;
    });
}

/// Returns the sphere that fits the places best by least squares. |p|^2 = 2 c.p + (r^2 - |c|^2) is
/// linear in c and in the bracket. Solved in units of the extent.
std::optional<Sphere> fit_sphere(const CentredTriangles& soup) {
    dmat4 matrix(0);
    dvec4 wanted(0);
    for (const dvec3& place : soup.places) {
        const dvec3 p = place / soup.extent;
        const dvec4 row(2.0 * p, 1);
        matrix += glm::outerProduct(row, row);
        wanted += row * glm::dot(p, p);
    }
    const double determinant = glm::determinant(matrix);
    if (!(std::abs(determinant) > 1e-12)) return std::nullopt; // flat, or too few places
    const dvec4 found = glm::inverse(matrix) * wanted;
    const double square = found.w + glm::dot(dvec3(found), dvec3(found));
    if (!(square > 0)) return std::nullopt;
    return Sphere{dvec3(found) * soup.extent, std::sqrt(square) * soup.extent};
}

/// Returns the largest distance of a vertex from the sphere, in radii. Returns 1 if facets cut off
/// so much that the mesh is a cube rather than a ball.
double max_deviation(const Sphere& sphere, const CentredTriangles& soup) {
    double farthest = 0;
    for (const dvec3& place : soup.places)
        farthest = std::max(farthest, std::abs(glm::length(place - sphere.centre) - sphere.radius));
    for (const TriangleCorners& t : soup.triangles) {
        const dvec3 normal = normalized_or_zero(soup.edge_cross(t));
        const double height = std::abs(glm::dot(normal, soup.places[t[0]] - sphere.centre));
        if (!(height >= (1 - kFacetRadiusTolerance) * sphere.radius)) return 1;
    }
    return farthest / sphere.radius;
}

/// Returns whether the corners' normals lie along the sphere's radii, outwards or inwards. A ball
/// with flat-shaded facets reflects as its facets do, not as a sphere.
bool has_sphere_normals(const Sphere& sphere, const Scene& scene, const Object& object) {
    const Mesh& mesh = scene.meshes[object.mesh];
    const dmat3 turns = normal_matrix(object.world_from_object);
    return std::ranges::all_of(mesh.triangles, [&](const uvec3& t) {
        return std::ranges::all_of(std::array{t.x, t.y, t.z}, [&](std::uint32_t i) {
            const dvec3 out = normalized_or_zero(
                            transform_point(object.world_from_object, mesh.positions[i]) -
                            sphere.centre),
                        normal = transform_normal(turns, dvec3(mesh.normals[i]));
            return glm::length(glm::cross(out, normal)) <= kNormalAngleTolerance;
        });
    });
}

/// Returns whether all vertices lie about equally far from the centre of the bounds. This quick
/// test numbers no places.
bool may_be_sphere(const Scene& scene, const Object& object) {
    const Bounds<double> box = bounds(scene, object);
    if (box.empty()) return false;
    const dvec3 centre = box.centre();
    const double radius = std::max({box.extent().x, box.extent().y, box.extent().z}) / 2;
    return std::ranges::all_of(scene.meshes[object.mesh].positions, [&](const dvec3& p) {
        const double far = glm::distance(transform_point(object.world_from_object, p), centre);
        return std::abs(far - radius) <= kFacetRadiusTolerance * radius;
    });
}

/// Sums over the edges at which triangles meet.
struct BendingSums {
    bool closed = true;
    double outwards = 0, inwards = 0; ///< bend angles times lengths of the edges

    bool is_dominant(double bends) const {
        return bends >= kMinBendingShare * (outwards + inwards);
    }
};

/// Measures how a mesh bends at its edges. An edge bends inwards if the tip of one triangle lies
/// above the plane of the other.
BendingSums measure_bends(const CentredTriangles& soup) {
    BendingSums edges;
    const auto add = [&](const TriangleEdge& here, const TriangleEdge& there) {
        const dvec3 normal = normalized_or_zero(soup.edge_cross(soup.triangles[here.triangle]));
        const dvec3 other = normalized_or_zero(soup.edge_cross(soup.triangles[there.triangle]));
        const double above = glm::dot(normal, soup.places[there.tip] - soup.places[here.low]);
        const double angle = std::atan2(glm::length(glm::cross(normal, other)),
                                        glm::dot(normal, other));
        (above < 0 ? edges.outwards : edges.inwards) += angle *
                                                        glm::distance(soup.places[here.low],
                                                                      soup.places[here.high]);
    };
    for_each_edge(triangle_edges(soup.triangles), [&](std::span<const TriangleEdge> sides) {
        edges.closed &= sides.size() == 2;
        if (sides.size() == 2) add(sides[0], sides[1]);
    });
    return edges;
}

/// Returns whether most of the area faces away from a point.
bool faces_away(const CentredTriangles& soup, const dvec3& point) {
    double area = 0;
    for (const TriangleCorners& t : soup.triangles) {
        const dvec3 cross = soup.edge_cross(t);
        area += glm::dot(cross, soup.places[t[0]] - point) > 0 ? glm::length(cross)
                                                               : -glm::length(cross);
    }
    return area > 0;
}

} // namespace

MirrorShape classify_shape(const Scene& scene, const Object& object) {
    using enum MirrorShape::Kind;
    const CentredTriangles soup = centred_triangles(scene, object);
    MirrorShape shape;
    if (soup.triangles.empty()) return shape;
    const BendingSums edges = measure_bends(soup);
    shape.is_closed = edges.closed;
    if (are_coplanar(soup)) {
        shape.kind = flat;
        return shape;
    }
    if (std::optional<Sphere> fit = fit_sphere(soup)) {
        const double off = max_deviation(*fit, soup);
        fit->centre += soup.centre;
        if (off <= kSphereVertexTolerance) shape.fit = fit, shape.tolerance = off;
    }
    if (object.sphere) {
        // The mesh stands for an exact sphere, whatever the positions of its vertices are.
        if (!shape.fit) shape.tolerance = 0;
        shape.fit = object.sphere;
    }
    if (shape.fit && edges.closed &&
        (object.sphere || has_sphere_normals(*shape.fit, scene, object)))
        shape.kind = sphere;
    else if (shape.fit) // subdivided balls bend inwards at some edges
        shape.kind = faces_away(soup, shape.fit->centre - soup.centre) ? convex : concave;
    else
        shape.kind = edges.is_dominant(edges.outwards)  ? convex
                     : edges.is_dominant(edges.inwards) ? concave
                                                        : other;
    return shape;
}

void find_exact_spheres(Scene& scene) {
    for (Object& object : scene.objects) {
        const RigAttachment* follows = followed_node(object.motion);
        if (object.sphere || !is_mirror(scene, object) ||
            scene.materials[object.material].normal_texture ||
            is_glass(scene.materials[object.material]) ||
            (follows && !preserves_spheres(*follows)) || !may_be_sphere(scene, object))
            continue;
        const MirrorShape shape = classify_shape(scene, object);
        if (shape.kind == MirrorShape::Kind::sphere) object.sphere = shape.fit;
    }
}

const char* shape_name(MirrorShape::Kind kind) {
    switch (kind) {
    case MirrorShape::Kind::flat: return "flat";
    case MirrorShape::Kind::sphere: return "sphere";
    case MirrorShape::Kind::convex: return "convex";
    case MirrorShape::Kind::concave: return "concave";
    case MirrorShape::Kind::other: break;
    }
    return "other";
}

} // namespace catoptric::scene
