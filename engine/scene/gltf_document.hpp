#pragma once

#include "scene/files.hpp"
#include "scene/gltf_accessor.hpp"
#include "scene/json.hpp"
#include "scene/notes.hpp"
#include "scene/scene.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

/// A glTF 2.0 file in our own types, checked, but with its node tree not yet flattened and its
/// meshes not yet read. Indices that may be absent are optional; every index is in range.
namespace catoptric::scene::gltf {

/// What glTF has no word for, from a node's `extras`:
///   {"catoptric": {"sphere": true | [x, y, z, r], "seen_by_camera": false, "distance": d}}
/// `sphere`: the mesh stands for this sphere in node space (true: [0, 0, 0, 1]), which a uniform
/// scale carries exactly into the world. `distance`: from a camera to its target.
struct Marks {
    std::optional<Sphere> sphere;
    std::optional<double> distance;
    bool seen_by_camera = true;
};

/// Triangles; the numbers are accessors.
struct Primitive {
    std::size_t positions = 0;
    std::optional<std::size_t> normals, indices;
};

/// The primitives of a mesh that share a material: one mesh of ours, since a mirror is a node,
/// however many primitives an exporter cut it into.
struct Part {
    std::size_t material = 0;
    std::vector<Primitive> primitives;
};

struct PrimitiveGroup {
    std::string name, place;
    std::vector<Part> parts; ///< in the order in which the materials come
};

struct Node {
    std::string name, label;
    dmat4 parent_from_node{1};
    std::optional<std::size_t> mesh, camera;
    std::vector<std::size_t> children;
    std::shared_ptr<const Keys> motion; ///< of its translation in its parent's space, not relative
    Marks marks;
};

struct Document {
    std::vector<Node> nodes;
    std::vector<std::size_t> roots;
    std::vector<PrimitiveGroup> meshes;
    std::vector<Material> materials;
    std::vector<std::optional<Camera>> cameras; ///< name and field of view; none of an unread kind
};

/// What reading needs beside the JSON.
struct Context {
    Accessors& accessors;
    Files& files;
    Account& account;
    Notes& notes;
};

/// Throws as `load_gltf`.
Document read(const Item& root, Context& context);

// The parts of `read`, by file.

/// gltf_node.cpp
std::vector<Node> read_nodes(const Item& root, Context& context);
/// The default scene's nodes, or the first one's, or every node that is no child.
std::vector<std::size_t> read_roots(const Item& root, const std::vector<Node>& nodes);
/// Throws `bad_data` unless every node has one parent at most, none is its own ancestor, and there
/// are at most 4096 above one another.
void check_forest(const Item& root, const std::vector<Node>& nodes);

/// gltf_mesh.cpp. For primitives without a material there is one more, white.
std::vector<PrimitiveGroup> read_meshes(const Item& root, std::vector<Material>& materials,
                                        Context& context);
/// One part's triangles, unused vertices left out; normals may be missing or have no length.
Mesh mesh_of(const PrimitiveGroup& group, const Part& part, Context& context);

/// gltf_animation.cpp: gives nodes their motion. Each sampler is read once.
void read_animations(const Item& root, std::vector<Node>& nodes, Context& context);

/// gltf_unread.cpp: names with a count what this reader does not know, and checks the indices and
/// names of files in it.
void note_unread(const Item& root, Context& context);

} // namespace catoptric::scene::gltf
