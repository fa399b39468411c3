#pragma once

#include "render/object_space.hpp"
#include "shared.h"

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace catoptric::render {

/// The choice of objects that are stored in object space.
enum class VertexSpaces {
    scene_space, ///< none: all vertices are in scene units
    object_space ///< some: see make_geometry
};

/// The triangles of one object in the shared buffers, and its properties.
struct DrawRange {
    std::uint32_t first_index = 0;
    std::uint32_t index_count = 0;
    std::uint32_t first_vertex = 0;
    std::uint32_t vertex_count = 0;
    Bounds<float> bounds; ///< scene units
    /// Largest distance of a vertex from the middle of the bounds, with rounding errors.
    float radius = 0;
    bool mirror = false;
    bool casts_shadow = true; ///< false for the mesh of a light, which would hide the light
    bool seen_by_camera = true;
    bool exact_sphere = false; ///< the mesh stands for an exact sphere
    bool one_sided = false;    ///< invisible from behind, where triangles run clockwise
    /// Whether the object has several colours, or reflects sharply without being a mirror.
    bool varies = false;
    bool has_normal_texture = false;
    bool has_lobe = false;   ///< some part reflects by a lobe (scene::may_reflect_by_lobe)
    bool rough = false;      ///< a mirror that reflects by a lobe (scene::may_reflect_by_lobe)
    float lobe_alpha = 0;    ///< of a rough mirror, the width of its lobe; 0: it has several lobes
    bool clear_coat = false; ///< scene::has_clear_coat
    bool turns = false;      ///< the normal turns to the viewer's side
    bool masked = false;     ///< whether an alpha mask may cut out parts of the object
    bool blended = false;    ///< no mirror; covers a share of the picture behind it
    /// A mirror with diffuse or emitted light beside its reflection.
    bool lit = false;
    bool glass = false;   ///< rays pass through (scene::is_glass)
    bool tints = false;   ///< glass that attenuates the light for surfaces behind it
    bool shell = false;   ///< render::is_closed_shell is true for the mesh
    bool flipped = false; ///< whether the object's transform mirrors or flattens the mesh
    /// Index in FrameGeometry::attributes of the first attribute of the object's mesh; empty: the
    /// mesh has no attributes.
    std::optional<std::uint32_t> first_attribute;
    std::optional<ObjectSpace> own; ///< none: vertices are in scene units
    /// Index of the object that owns these vertices and indices: the first object with the mesh, or
    /// this object if it shares no vertices with others.
    std::uint32_t storage = 0;
    bool shares = false; ///< uses the space of its mesh, which copies may share
};

/// All triangles of a frame, in scene units unless their object has an object space. Each object
/// has one range, in the order of the scene. Vertices and indices in scene units come first.
struct FrameGeometry {
    std::vector<shared::Vertex> vertices;
    std::vector<std::uint32_t> indices;
    std::vector<DrawRange> ranges;
    /// Vertex attributes, stored once for each mesh that has them.
    std::vector<shared::VertexAttribute> attributes;
    /// Object spaces of meshes that copies share, by mesh index.
    std::map<std::size_t, MeshSpace> mesh_spaces;
    Bounds<float> core; ///< bounds of most of the scene (SceneUnits::core)
    VertexSpaces spaces = VertexSpaces::scene_space;
    std::uint32_t flat_indices = 0; ///< number of indices in scene units
};
/// Builds the geometry of a scene. With VertexSpaces::object_space, an object keeps
/// an object space if it is small (is_small_for_distance) or one of many copies
/// (find_sharing_objects). Costs O(n) in stored vertices and triangles; a copy that shares
/// its mesh costs O(1).
FrameGeometry make_geometry(const scene::Scene& now, const SceneUnits& space,
                            VertexSpaces spaces = VertexSpaces::scene_space);

/// Returns whether `make_geometry` would now choose another kind of space for the object.
bool needs_other_space(const FrameGeometry& geometry, const scene::Scene& now,
                       const SceneUnits& space, std::size_t object);

/// Moves the triangles of an object to where the object is in `now`. Only the place of the object
/// may have changed since `make_geometry`. Returns whether vertices changed: no vertex
/// changes if the object has a coordinate space of its own, which then moves. Throws as
/// check_object_distance does.
bool move_object(FrameGeometry& geometry, const scene::Scene& now, const SceneUnits& space,
                 std::size_t index);

/// Returns the squared distance from p to the triangle (Ericson, Real-Time Collision Detection,
/// 5.1.5).
float squared_distance(vec3 p, vec3 a, vec3 b, vec3 c);

} // namespace catoptric::render
