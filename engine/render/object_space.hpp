#pragma once

#include "render/space.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

/// Chooses the objects that are stored in object space, and finds the transforms of these spaces.
namespace catoptric::render {

/// An object space for vertices: scene = centre + scene_from_own * own. Vertices in it are about 1
/// in size.
struct ObjectSpace {
    dmat3 scene_from_own{1};
    dvec3 centre{0};  ///< scene units
    double least = 1; ///< each length in object space is at least this many scene units a unit
    /// Radius of the exact sphere around the middle, in object space; 0: no exact sphere.
    float radius = 0;
    dvec3 to_object(const dvec3& scene) const {
        return glm::inverse(scene_from_own) * (scene - centre);
    }
};

/// Copies of meshes are stored in scene units up to this many triangles (some 50 MB). Copies beyond
/// it keep the space of their mesh and share one set of vertices.
inline constexpr std::uint64_t kMaxCopiedTriangles = 1u << 18;

/// Returns, by object, whether it shares the vertices of its mesh. An object does not share in
/// three cases: it is a one-sided lamp, whose corners may have to be swapped; its mesh has no
/// extent; or its transform loses too much float precision for rays. Costs O(objects + vertices of
/// such meshes).
std::vector<bool> find_sharing_objects(const scene::Scene& scene);
/// Returns whether a copy may share its mesh in its present state.
bool may_share_mesh(const scene::Scene& now, const scene::Object& object);

/// Returns whether the object is smaller than require::kSmallObjectRatio of its distance from the
/// origin. Costs O(triangles).
bool is_small_for_distance(const scene::Scene& now, const scene::Object& object,
                           const SceneUnits& space);

/// The object space of a mesh that copies share: the axes of the mesh, around the middle of its
/// bounds.
struct MeshSpace {
    dvec3 middle{0};
    double unit = 1;    ///< object space units in one unit of the mesh
    Bounds<double> box; ///< bounds in object space
};
/// The box of the result is empty.
MeshSpace make_mesh_space(const scene::Mesh& mesh);
/// Returns the placement of a copy's object space.
ObjectSpace make_object_space(const MeshSpace& mesh, const dmat4& world_from_object,
                              const SceneUnits& space);

/// Returns the object space of a single object. It has the world's axes, so that vertices need no
/// rotation. Its middle is that of the exact sphere, or else of the bounds.
ObjectSpace make_object_space(const scene::Scene& now, const scene::Object& object,
                              const SceneUnits& space);

/// Returns the scene bounds of a box in object space, padded for rounding to float.
Bounds<float> scene_bounds(const ObjectSpace& own, const Bounds<double>& box);

} // namespace catoptric::render
