#pragma once

#include "scene/gltf_check.hpp"
#include "scene/scene.hpp"

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <tiny_gltf.h>

/// A glTF 2.0 file as tinygltf has read it, behind our checks (gltf_check.hpp), on its way into a
/// scene: what its values say is checked here. Indices that are -1 are absent, all others in range.
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

struct Document {
    std::string file; ///< begins every message
    tinygltf::Model model;
    std::vector<Marks> marks; ///< of each node; tinygltf would cut their numbers to 32 bits
    std::optional<double>
        exposure; ///< of the scene that is shown: {"catoptric": {"exposure": stops}}

    /// "nodes[3] 'lamp'".
    std::string label(std::size_t node) const;
};

/// Reads a .gltf or .glb. Throws as `load_gltf`.
Document read(const std::string& file, Files& files, Account& account, Notes& notes);

// ---- gltf_accessor.cpp

/// Elements in a buffer.
struct Elements {
    const unsigned char* first;
    std::size_t stride, count;
    int component; ///< TINYGLTF_COMPONENT_TYPE_
};
Elements elements_of(const tinygltf::Model& model, int accessor);
double scalar_at(const Elements& elements, std::size_t index);
dvec3 vector_at(const Elements& elements, std::size_t index);
std::uint32_t whole_at(const Elements& elements, std::size_t index);
/// The whole number that means "begin anew" among indices.
std::uint32_t restart_of(const Elements& elements);

/// What reading needs beside the document.
struct Context {
    /// The dense accessor of floats of TINYGLTF_TYPE_ `type`. Throws `bad_data` beginning with
    /// `place` for another. When it is first asked for, its elements are added to `total` and must
    /// be finite.
    Elements floats(int accessor, int type, Total& total, const std::string& place);
    /// The dense accessor of whole numbers, scalar and unsigned.
    Elements whole(int accessor, const std::string& place) const;

    const Document& document;
    Account& account;
    Notes& notes;
    std::set<int> finite; ///< accessors known to be
};

// ---- gltf_node.cpp

std::vector<Marks> read_marks(const Item& root);
/// Throws `bad_data` for a rotation without a length.
dmat4 parent_from_node(const Document& document, std::size_t node);
/// The default scene's nodes, or the first one's, or every node that is no child.
std::vector<int> roots_of(const tinygltf::Model& model);
/// Throws `bad_data` unless every node has one parent at most, none is its own ancestor, and there
/// are at most 4096 above one another.
void check_forest(const Document& document);

// ---- gltf_material.cpp

std::vector<Material> read_materials(const Context& context);
/// Name and field of view; none of an unread kind.
std::vector<std::optional<Camera>> read_cameras(const Document& document);

// ---- gltf_mesh.cpp

/// The primitives of a mesh that share a material: one mesh of ours, since a mirror is a node,
/// however many primitives an exporter cut it into.
struct Part {
    std::size_t material = 0;
    std::vector<std::size_t> primitives;
};

/// The parts of each mesh, in the order in which their materials come. For primitives without a
/// material there is one more, white.
std::vector<std::vector<Part>> read_parts(std::vector<Material>& materials, Context& context);
/// "FILE: meshes[0] 'm'".
std::string mesh_place(const Document& document, std::size_t mesh);
/// One part's triangles, unused vertices left out; normals may be missing or have no length.
Mesh mesh_of(std::size_t mesh, const Part& part, const Context& context);

// ---- gltf_animation.cpp

/// For each node its translation in its parent's space, not relative. Each sampler is read once.
std::vector<std::shared_ptr<const Keys>> read_motions(Context& context);

} // namespace catoptric::scene::gltf
