#pragma once

#include "render/object_space.hpp"
#include "shared.h"

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace catoptric::render {

/// Which objects keep a space of their own.
enum class Spaces {
    one, ///< none: all vertices are in scene units
    own  ///< see make_geometry
};

/// The triangles of one object in the shared buffers.
struct DrawRange {
    std::uint32_t first_index = 0;
    std::uint32_t index_count = 0;
    std::uint32_t first_vertex = 0;
    std::uint32_t vertex_count = 0;
    Bounds<float> bounds; ///< scene units
    float radius = 0;     ///< around the middle of the bounds, of all vertices; roundings included
    bool mirror = false;
    bool casts_shadow = true; ///< a light's own mesh does not: it would hide the light
    bool seen_by_camera = true;
    bool exact_sphere = false; ///< the mesh stands for one
    bool one_sided = false;    ///< not there from behind, where triangles run clockwise
    bool varies = false;       ///< more than one colour, or sharp without being a mirror
    bool turns = false;        ///< its normal turns to who looks
    bool masked = false;       ///< parts of it may be cut out
    bool lit = false;          ///< a mirror with light of its own, which only its picture shows
    bool shell = false;        ///< in its mesh's space it is one (is_shell)
    bool flipped = false;      ///< mirrored or flattened on its way from that space
    /// Of its mesh, in Geometry::attributes; none: its vertices have none.
    std::optional<std::uint32_t> first_attribute;
    std::optional<ObjectSpace> own; ///< none: vertices are in scene units
    /// Object whose vertices and indices these are, the first that has the mesh; itself where it
    /// shares none.
    std::uint32_t storage = 0;
    bool shares = false; ///< has the mesh's space, of which there may be others
};

/// All triangles of a frame, in scene units where their object has no space of its own; one range
/// for each object, in the scene's order. What is in scene units comes first in both lists.
struct Geometry {
    std::vector<shared::Vertex> vertices;
    std::vector<std::uint32_t> indices;
    std::vector<DrawRange> ranges;
    std::vector<shared::Attribute> attributes;    ///< of meshes that have them, once each
    std::map<std::size_t, MeshSpace> mesh_spaces; ///< by mesh, of those that share
    Bounds<float> core;                           ///< where most of it is (Space::core)
    Spaces spaces = Spaces::one;
    std::uint32_t flat_indices = 0; ///< of what is in scene units
};
/// With Spaces::own an object keeps its own space where it is small (is_small) or one of many
/// copies (shared_objects). Costs O(n) in vertices and triangles that are stored; a copy of a mesh
/// that shares costs O(1).
Geometry make_geometry(const scene::Scene& now, const Space& space, Spaces spaces = Spaces::one);

/// Whether `make_geometry` would now give the object another kind of space than it has.
bool changes_space(const Geometry& geometry, const scene::Scene& now, const Space& space,
                   std::size_t object);

/// Puts an object's triangles where they are now; nothing else of it may have changed since
/// `make_geometry`. Returns whether vertices changed: not where only an own space moved. Throws as
/// check_reach does.
bool move_object(Geometry& geometry, const scene::Scene& now, const Space& space,
                 std::size_t index);

/// Squared distance from p to the triangle (Ericson, Real-Time Collision Detection, 5.1.5).
float squared_distance(vec3 p, vec3 a, vec3 b, vec3 c);

} // namespace catoptric::render
