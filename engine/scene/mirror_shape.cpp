#include "scene/mirror_shape.hpp"

#include "scene/transform.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace catoptric::scene {

namespace {

constexpr double kFlat = 1e-4;  // of the extent
constexpr double kRound = 1e-3; // of the radius: vertices
constexpr double kFacets = .1;  // the same: facets

using Triangle = std::array<std::size_t, 3>;

/// An object's triangles in the world, about the centre of its bounds; places are numbered once.
struct Soup {
    std::vector<dvec3> places;
    std::vector<Triangle> triangles;
    dvec3 centre{0};
    double extent = 0; ///< longest side of the bounds

    dvec3 cross_of(const Triangle& t) const {
        return glm::cross(places[t[1]] - places[t[0]], places[t[2]] - places[t[0]]);
    }
};

Soup soup_of(const Scene& scene, const Object& object) {
    const Mesh& mesh = scene.meshes[object.mesh];
    const Bounds<double> box = bounds(scene, object);
    Soup soup;
    if (box.empty()) return soup;
    soup.centre = box.centre();
    soup.extent = std::max({box.extent().x, box.extent().y, box.extent().z});
    std::map<std::array<double, 3>, std::size_t> known;
    const auto place_of = [&](std::uint32_t vertex) {
        const dvec3& p = mesh.positions[vertex];
        const auto [entry, is_new] = known.try_emplace({p.x, p.y, p.z}, soup.places.size());
        if (is_new)
            soup.places.push_back(transform_point(object.world_from_object, p) - soup.centre);
        return entry->second;
    };
    for (const uvec3& t : mesh.triangles)
        soup.triangles.push_back({place_of(t.x), place_of(t.y), place_of(t.z)});
    return soup;
}

bool is_flat(const Soup& soup) {
    dvec3 sum(0);
    for (const Triangle& t : soup.triangles) sum += soup.cross_of(t);
    const dvec3 normal = normalized_or_zero(sum);
    if (normal == dvec3(0)) return false;
    const double height = glm::dot(normal, soup.places[soup.triangles.front()[0]]);
    return std::ranges::all_of(soup.triangles, [&](const Triangle& t) {
        const bool in_plane = std::ranges::all_of(t, [&](std::size_t i) {
            return std::abs(glm::dot(normal, soup.places[i]) - height) <= kFlat * soup.extent;
        });
        return in_plane && glm::dot(normal, soup.cross_of(t)) > 0;
    });
}

/// Least squares: |p|^2 = 2 c.p + (r^2 - |c|^2), linear in c and the bracket; in units of the
/// extent.
std::optional<Sphere> fitted(const Soup& soup) {
    dmat4 matrix(0);
    dvec4 wanted(0);
    for (const dvec3& place : soup.places) {
        const dvec3 p = place / soup.extent;
        const dvec4 row(2.0 * p, 1);
        matrix += glm::outerProduct(row, row);
        wanted += row * glm::dot(p, p);
    }
    const double determinant = glm::determinant(matrix);
    if (!(std::abs(determinant) > 1e-12)) return std::nullopt; // all in a plane, or few
    const dvec4 found = glm::inverse(matrix) * wanted;
    const double square = found.w + glm::dot(dvec3(found), dvec3(found));
    if (!(square > 0)) return std::nullopt;
    return Sphere{dvec3(found) * soup.extent, std::sqrt(square) * soup.extent};
}

/// Of the vertices, in radii; 1 where facets cut off so much that it is a cube rather than a ball.
double farthest_from(const Sphere& sphere, const Soup& soup) {
    double farthest = 0;
    for (const dvec3& place : soup.places)
        farthest = std::max(farthest, std::abs(glm::length(place - sphere.centre) - sphere.radius));
    for (const Triangle& t : soup.triangles) {
        const dvec3 normal = normalized_or_zero(soup.cross_of(t));
        const double height = std::abs(glm::dot(normal, soup.places[t[0]] - sphere.centre));
        if (!(height >= (1 - kFacets) * sphere.radius)) return 1;
    }
    return farthest / sphere.radius;
}

/// How the triangles meet.
struct Edges {
    bool closed = true, convex = true, concave = true;
};

/// The tip of a triangle over the plane of its neighbour says which way their edge bends.
Edges edges_of(const Soup& soup) {
    struct Side {
        std::size_t triangle, tip;
    };
    std::map<std::pair<std::size_t, std::size_t>, std::vector<Side>> sides;
    for (std::size_t i = 0; i < soup.triangles.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t a = soup.triangles[i][k], b = soup.triangles[i][(k + 1) % 3];
            sides[std::minmax(a, b)].push_back({i, soup.triangles[i][(k + 2) % 3]});
        }
    Edges edges;
    for (const auto& [ends, its] : sides) {
        edges.closed &= its.size() == 2;
        if (its.size() != 2) continue;
        for (int k = 0; k < 2; ++k) {
            const Side &here = its[std::size_t(k)], &there = its[std::size_t(1 - k)];
            const dvec3 normal = normalized_or_zero(soup.cross_of(soup.triangles[here.triangle]));
            const double above = glm::dot(normal, soup.places[there.tip] - soup.places[ends.first]);
            edges.convex &= above <= kFlat * soup.extent;
            edges.concave &= above >= -kFlat * soup.extent;
        }
    }
    return edges;
}

} // namespace

Shape shape_of(const Scene& scene, const Object& object) {
    using enum Shape::Kind;
    const Soup soup = soup_of(scene, object);
    Shape shape;
    if (soup.triangles.empty()) return shape;
    const Edges edges = edges_of(soup);
    shape.is_closed = edges.closed;
    if (is_flat(soup)) {
        shape.kind = flat;
        return shape;
    }
    if (std::optional<Sphere> fit = fitted(soup)) {
        const double off = farthest_from(*fit, soup);
        fit->centre += soup.centre;
        if (off <= kRound) shape.fit = fit, shape.tolerance = off;
    }
    if (object.sphere) shape.fit = object.sphere, shape.tolerance = 0;
    shape.kind = shape.fit && edges.closed ? sphere
                 : edges.convex            ? convex
                 : edges.concave           ? concave
                                           : other;
    return shape;
}

const char* name_of(Shape::Kind kind) {
    switch (kind) {
    case Shape::Kind::flat: return "flat";
    case Shape::Kind::sphere: return "sphere";
    case Shape::Kind::convex: return "convex";
    case Shape::Kind::concave: return "concave";
    case Shape::Kind::other: break;
    }
    return "other";
}

} // namespace catoptric::scene
