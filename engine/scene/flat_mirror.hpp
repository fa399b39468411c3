#pragma once

#include "scene/scene.hpp"

#include <optional>
#include <vector>

/// Mirrors with flat faces, which show what a camera behind them would see.
namespace catoptric::scene {

/// Triangles of a mesh, from the first to before `end`.
struct TriangleRun {
    std::uint32_t first = 0, end = 0;
    bool operator==(const TriangleRun&) const = default;
};

/// A surface, or a face of one, that lies in a plane, or nearly so; world units.
struct Flat {
    dvec3 point{0};  ///< in the plane
    dvec3 normal{0}; ///< unit; to which side it points means nothing without is_one_sided
    std::vector<dvec3> corners; ///< of the surface's convex hull, in order
    /// How far it is from flat: the largest angle, in radians, between the plane's normal and a
    /// vertex's, or a vertex's distance from the plane as a part of the surface's size if that is
    /// more.
    double off = 0;
    double share = 1; ///< of the surface's area
    /// A face of a closed body: it can only be seen from where the normal points.
    bool is_one_sided = false;
    std::vector<TriangleRun> triangles; ///< that lie in it, ascending
};

/// The flat faces of a surface.
struct FlatFaces {
    std::vector<Flat> faces;       ///< the largest first, kMostFaces at most
    std::vector<TriangleRun> bent; ///< the triangles that lie in none of them, ascending
    /// Share of the area in faces that are off by at most `tolerance`.
    double share(double tolerance) const;
    /// The whole surface lies in one plane.
    bool is_one() const { return faces.size() == 1 && bent.empty(); }
};

/// The most faces that a surface is given, and the least share of its area that is one.
inline constexpr std::size_t kMostFaces = 8;
inline constexpr double kLeastFace = 1e-3;
/// A surface of which this share of the area lies in flat faces can be drawn by their planes.
inline constexpr double kFlatEnough = .5;

/// What is further from flat than this is no Flat, whatever the picture.
inline constexpr double kFarFromFlat = .01;

/// Nothing where some vertex is too far off, or without a triangle that has an area. O(vertices),
/// and O(1) for most that are curved: it ends at the first vertex that is off.
std::optional<Flat> flat(const Mesh& mesh, const dmat4& world_from_object);

/// The faces of a mirror that a plane can stand for: the whole where it is `flat`; else each set of
/// triangles that lie in one plane within 1e-4 of the extent, whose corners' normals are the
/// plane's within kFarFromFlat. A board modelled as a thin closed box has six. None where there are
/// more than 64 such planes or 65,536 triangles: nobody draws those one by one. O(triangles), with
/// O(n log n) for a surface that has faces.
FlatFaces flat_faces(const Mesh& mesh, const dmat4& world_from_object);

/// How far from flat a mirror may be that shows what a plane would, in a picture so many pixels
/// high: a sixteenth of the angle of a pixel in the picture's middle. A normal that is off by so
/// much turns a reflected ray by an eighth of a pixel; an orthographic picture's pixels are those
/// of an angle whose tangent is 2 / height.
double flat_tolerance(const Camera& camera, uvec2 size);

} // namespace catoptric::scene
