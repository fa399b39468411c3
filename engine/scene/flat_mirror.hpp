#pragma once

#include "scene/material_facts.hpp"
#include "scene/scene.hpp"

#include <optional>
#include <vector>

/// Flat faces of mirrors. A flat face shows the view of a camera mirrored behind it.
namespace catoptric::scene {

/// Consecutive triangles of a mesh, from `first` to before `end`.
struct TriangleRun {
    std::uint32_t first = 0, end = 0;
    bool operator==(const TriangleRun&) const = default;
};

/// Surface, or a face of a surface, that lies nearly in a plane; world units.
struct FlatFace {
    dvec3 point{0};             ///< a point in the plane
    dvec3 normal{0};            ///< unit length; its sign means nothing unless `is_one_sided`
    std::vector<dvec3> corners; ///< corners of the surface's convex hull, in order
    /// Deviation from flat, the larger of two numbers. The first is the largest angle, in radians,
    /// between the plane's normal and a vertex normal. The second is the largest distance of a
    /// vertex from the plane, as a part of the surface's size.
    double off = 0;
    double share = 1; ///< share of the surface's area, 0 to 1
    /// True for a face of a closed body, which can be seen only from the side of the normal.
    bool is_one_sided = false;
    std::vector<TriangleRun> triangles; ///< ascending
};

struct FlatFaces {
    std::vector<FlatFace> faces;   ///< largest first, at most kMaxFlatFaces
    std::vector<TriangleRun> bent; ///< triangles that lie in no face, ascending
    /// Why no mirrored view shows what the surface reflects, although it may be flat: "bumpy" or
    /// "glass". Such a surface has no faces. Empty for any other surface.
    std::string_view misfit = {};
    bool is_rough = false; ///< the surface reflects by a lobe (may_reflect_by_lobe)
    /// Returns the share of the area in faces whose `off` is at most `tolerance`.
    double flat_share(double tolerance) const;
    bool is_plane() const { return faces.size() == 1 && bent.empty(); }
};

/// Largest number of faces of a surface, and least share of the surface's area that is a face.
inline constexpr std::size_t kMaxFlatFaces = 8;
inline constexpr double kMinFaceShare = 1e-3;
/// Least share of a surface's area that must lie in flat faces before planes may draw the surface.
inline constexpr double kMinFlatShare = .5;

/// Largest value of `FlatFace::off`. A surface that deviates more from a plane is not flat at any
/// picture size.
inline constexpr double kMaxPlaneDeviation = .01;

/// Returns the plane of a mesh. Returns nothing if a vertex is off by more than kMaxPlaneDeviation,
/// or if no triangle has an area. O(vertices). O(1) for most curved meshes, because the test ends
/// at the first vertex that is off.
std::optional<FlatFace> find_mesh_plane(const Mesh& mesh, const dmat4& world_from_object);

/// Returns the flat faces of a mirror, each of which a plane can replace. If the mesh lies in one
/// plane (`find_mesh_plane`), the whole mesh is one face. Otherwise a face is a set of triangles
/// that lie in one plane within 1e-4 of the extent. The normals at their corners differ from the
/// plane's by at most kMaxPlaneDeviation. A board modelled as a thin closed box has six faces.
/// Returns no faces for more than 64 such planes or 65,536 triangles, because so many planes are
/// never drawn one by one. O(triangles), plus O(n log n) for a surface that has faces.
FlatFaces find_flat_faces(const Mesh& mesh, const dmat4& world_from_object);
/// Returns the flat faces of an object that is a mirror; none for a rough mirror.
FlatFaces find_flat_faces(const Scene& scene, const Object& object);

/// Returns the largest `FlatFace::off` at which a mirror shows what a plane would, in a picture of
/// `size` pixels. It is a sixteenth of the angle of a pixel in the picture's middle. A normal that
/// is off by this angle turns a reflected ray by an eighth of a pixel. For an orthographic camera,
/// a pixel counts as the angle whose tangent is 2 / height.
double flat_tolerance(const Camera& camera, uvec2 size);

} // namespace catoptric::scene
