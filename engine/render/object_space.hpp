#pragma once

#include "render/space.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

/// Which objects keep a space of their own, and where it stands.
namespace catoptric::render {

/// A space of its own for an object's vertices: scene = centre + scene_from_own * own, own about 1.
struct ObjectSpace {
    dmat3 scene_from_own{1};
    dvec3 centre{0};  ///< scene units
    double least = 1; ///< no length in own units becomes less than this many times it
    float radius = 0; ///< own units, of the exact sphere around the middle; 0: none
    dvec3 point(const dvec3& scene) const {
        return glm::inverse(scene_from_own) * (scene - centre);
    }
};

/// Copies of shared meshes are put into scene units up to so many triangles (some 50 MB); those of
/// the meshes above that keep the mesh's space and one set of vertices.
inline constexpr std::uint64_t kMostCopied = 1u << 18;

/// By object, whether it is one of those copies. It is not where it is a lamp of one side, whose
/// corners may have to be swapped, where the mesh has no extent, or where its transform is worse
/// than a float can turn a ray by. O(objects + vertices of such meshes).
std::vector<bool> shared_objects(const scene::Scene& scene);
/// Whether a copy may stay one as it stands now.
bool may_share(const scene::Scene& now, const scene::Object& object);

/// Whether the object is smaller than kSmallPart of its distance from the origin. O(triangles).
bool is_small(const scene::Scene& now, const scene::Object& object, const Space& space);

/// The space of a mesh that copies share: the mesh's axes, its bounds' middle.
struct MeshSpace {
    dvec3 middle{0};
    double unit = 1;    ///< own units in one of the mesh's
    Bounds<double> box; ///< own units
};
/// Without the box.
MeshSpace space_of_mesh(const scene::Mesh& mesh);
/// Where such a copy's space stands.
ObjectSpace object_space_of(const MeshSpace& mesh, const dmat4& world_from_object,
                            const Space& space);

/// Of a single object: the world's axes, so that nothing turns on its way; the middle is that of
/// its exact sphere or of its bounds.
ObjectSpace object_space_of(const scene::Scene& now, const scene::Object& object,
                            const Space& space);

/// Where a box of an own space is in the scene, with the roundings of what becomes float.
Bounds<float> scene_bounds(const ObjectSpace& own, const Bounds<double>& box);

} // namespace catoptric::render
