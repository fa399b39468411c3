#pragma once

#include "scene/gltf_check.hpp"
#include "scene/gltf_texture.hpp"
#include "scene/load.hpp"

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
    // Read before tinygltf, which has no word for some and would cut others to 32 bits.
    std::vector<Marks> marks; ///< of each node
    std::vector<Material> materials;
    Lights lights;
    std::vector<std::vector<double>> weights; ///< of each mesh, of its morph targets
    std::vector<std::vector<double>>
        node_weights;          ///< of each node, in place of its mesh's; or none
    std::vector<bool> repeats; ///< of each animation: {"catoptric": {"repeats": true}}
    std::optional<double> exposure;
    bool is_quantised = false; ///< KHR_mesh_quantization

    /// "nodes[3] 'lamp'".
    std::string label(std::size_t node) const;
};

/// Reads a .gltf or .glb. Throws as `load_gltf`.
Document read(const std::string& file, Files& files, Account& account, Notes& notes,
              std::vector<UnsupportedFeature>& unsupported);

// ---- gltf_accessor.cpp

/// Elements in a buffer.
struct Elements {
    const unsigned char* first;
    std::size_t stride, count;
    int component; ///< TINYGLTF_COMPONENT_TYPE_
    int width;     ///< components of an element
    bool normalised;
};
Elements elements_of(const tinygltf::Model& model, int accessor);
/// One component; of whole numbers that are normalised within [-1,1].
double number_at(const Elements& elements, std::size_t index, int component);
dvec3 vector_at(const Elements& elements, std::size_t index);
std::uint32_t whole_at(const Elements& elements, std::size_t index, int component = 0);
/// The whole number that means "begin anew" among indices.
std::uint32_t restart_of(const Elements& elements);

/// What reading needs beside the document.
struct Context {
    /// Which numbers an accessor may hold beside floats: none; whole ones that are normalised; with
    /// KHR_mesh_quantization any of 8 or 16 bits.
    enum class Also { nothing, normalised, quantised };

    /// The elements of an accessor of TINYGLTF_TYPE_ `type`. Throws `bad_data` beginning with
    /// `place` for another. When it is first asked for, its elements are added to `total` and must
    /// be finite.
    Elements floats(int accessor, int type, Total& total, const std::string& place,
                    Also also = Also::nothing);
    /// The accessor of whole numbers, scalar and unsigned, or of another type.
    Elements whole(int accessor, const std::string& place, int type = TINYGLTF_TYPE_SCALAR) const;

    const Document& document;
    const LoadOptions& options;
    Account& account;
    Notes& notes;
    std::vector<UnsupportedFeature>& unsupported;
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

/// Name and field of view, or height.
std::vector<Camera> read_cameras(const Document& document);

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
/// `weights`: of its morph targets. With `joints`, the world from the space in which each was
/// bound, as a skin of them stands.
Mesh mesh_of(std::size_t mesh, const Part& part, const std::vector<double>& weights,
             const Context& context, const std::vector<dmat4>* joints = nullptr);

// ---- gltf_animation.cpp

/// How a node moves in its parent's space, not relative; where a track is null it does not.
struct Tracks {
    std::shared_ptr<const Keys> translations, scales;
    std::shared_ptr<const Turns> rotations;
    bool is_any() const { return translations || scales || rotations; }
};
struct Animation {
    std::vector<Tracks> nodes;
    bool repeats = false;
};
/// The one of the options. Each sampler is read once. Throws `usage` for a name that no animation
/// has.
Animation read_animation(Context& context);

// ---- gltf_rig.cpp

/// Where a node stands, and how it moves in world space.
struct Placed {
    dmat4 world_from_node{1};
    Motion motion;
    bool reached = false;
};

/// World transforms of the nodes that the scene shows: at rest, or where they move by more than
/// one translation at the first instant. Throws `bad_data` for a node with a second way to it.
std::vector<Placed> place(const Document& document, const Animation& animation);

/// For a skin's joints, the world from the space in which they were bound, as `at_rest` they stand.
std::vector<dmat4> joints_of(int skin, const std::vector<dmat4>& at_rest, Context& context);
/// World from each node, nothing moving.
std::vector<dmat4> rest_of(const Document& document);

} // namespace catoptric::scene::gltf
