#pragma once

#include "import/file_options.hpp"
#include "import/gltf_check.hpp"
#include "import/gltf_texture.hpp"
#include "import/load.hpp"
#include "scene/motion.hpp"

#include <tiny_gltf.h>

#include <array>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

/// Builds a scene from a glTF 2.0 file that our checks (gltf_check.hpp) have passed and tinygltf
/// has parsed. These functions check the values of the file. An index of -1 means absent; all other
/// indices are in range.
namespace catoptric::scene::gltf {

/// Properties of a node that glTF cannot express, read from the node's `extras`:
///   {"catoptric": {"sphere": true | [x, y, z, r], "seen_by_camera": false, "distance": d}}
/// `sphere`: centre and radius of the sphere, in node space, that the mesh approximates. `true`
/// stands for [0, 0, 0, 1]. A node with a uniform scale keeps the sphere exact in world space.
/// `distance`: distance from a camera to its target, in world units.
struct NodeExtras {
    std::optional<Sphere> sphere;
    std::optional<double> distance;
    bool seen_by_camera = true;
};

struct Document {
    std::string file; ///< begins every message
    tinygltf::Model model;
    // These members are read before tinygltf parses the file. The library tinygltf does not read
    // some of these members, and cuts others to 32 bits.
    std::vector<NodeExtras> extras; ///< of each node
    std::vector<Material> materials;
    PunctualLights lights;
    /// Morph target weights of each mesh.
    std::vector<std::vector<double>> weights;
    /// Morph target weights of each node, which replace those of its mesh. Empty: the mesh's hold.
    std::vector<std::vector<double>> node_weights;
    /// Whether each animation repeats, from its `extras`: {"catoptric": {"repeats": true}}.
    std::vector<bool> repeats;
    std::optional<double> exposure; ///< stops
    bool is_quantised = false;      ///< the file uses KHR_mesh_quantization

    /// Returns a node's name for messages, such as "nodes[3] 'lamp'".
    std::string describe_node(std::size_t node) const;
};

/// Reads a .gltf or .glb. Throws the same errors as `load_gltf`.
Document read_document(const std::string& file, FileOpener& files, LoadAccount& account,
                       LoaderNotes& notes, std::vector<UnsupportedFeature>& unsupported);

// ---- gltf_accessor.cpp

/// The elements of an accessor, as they lie in its buffer.
struct AccessorElements {
    const unsigned char* first;
    std::size_t stride, count; ///< bytes from one element to the next; number of elements
    int component;             ///< one of TINYGLTF_COMPONENT_TYPE_*
    int width;                 ///< components per element
    bool normalised;
};
AccessorElements read_elements(const tinygltf::Model& model, int accessor);
/// Returns one component of an element. Normalised integers become values in [-1, 1].
double read_number(const AccessorElements& elements, std::size_t index, int component);
dvec3 read_vector(const AccessorElements& elements, std::size_t index);
std::uint32_t read_integer(const AccessorElements& elements, std::size_t index, int component = 0);
/// Returns the primitive restart index, the largest value of the component type.
std::uint32_t restart_index(const AccessorElements& elements);

/// The document, the load options and the lists that functions add to while they build a scene.
struct ReadContext {
    /// Which integers an accessor may hold besides floats. `nothing`: none. `normalised`:
    /// normalised ones of 8 or 16 bits. `quantised`: any of 8 or 16 bits, if the file uses
    /// KHR_mesh_quantization.
    enum class AllowedIntegers { nothing, normalised, quantised };

    /// Returns the elements of an accessor of floats, or of the integers that `also` allows. The
    /// first request for an accessor adds its elements to `total` and checks that floats are
    /// finite. Throws `bad_data` beginning with `place` for a float that is not finite, for other
    /// components, or for a type other than `type` (TINYGLTF_TYPE_*).
    AccessorElements floats(int accessor, int type, LimitedSum& total, const std::string& place,
                            AllowedIntegers also = AllowedIntegers::nothing);
    /// Returns the elements of an accessor of unsigned integers, scalars unless `type` says
    /// otherwise. Throws `bad_data` beginning with `place` for any other accessor.
    AccessorElements whole(int accessor, const std::string& place,
                           int type = TINYGLTF_TYPE_SCALAR) const;

    const Document& document;
    const FileOptions& options;
    LoadAccount& account;
    LoaderNotes& notes;
    std::vector<UnsupportedFeature>& unsupported;
    std::set<int> finite; ///< accessors whose elements have been checked and counted
};

// ---- gltf_node.cpp

/// Returns one entry for each node. Throws `bad_data`.
std::vector<NodeExtras> read_all_extras(const JsonObject& root);
/// Returns a node's transform into its parent's space. Throws `bad_data` for a rotation of zero or
/// infinite length.
dmat4 parent_from_node(const Document& document, std::size_t node);
/// Returns the root nodes of the default scene, or of the first scene if there is no default. A
/// file without scenes has every node without a parent as a root.
std::vector<int> root_nodes(const tinygltf::Model& model);
/// Checks that the nodes form a forest: at most one parent each, no node its own ancestor, and at
/// most 4096 levels. Throws `bad_data` if they do not.
void check_forest(const Document& document);

/// Reads the name of each camera and its field of view or, if orthographic, its height. Throws
/// `bad_data`.
std::vector<Camera> read_cameras(const Document& document);

// ---- gltf_mesh.cpp

/// The primitives of a glTF mesh that share a material. They become one mesh of the scene, because
/// a mirror is a node and exporters may split its mesh into any number of primitives.
struct MeshPart {
    std::size_t material = 0;
    std::vector<std::size_t> primitives;
};

/// Returns the parts of each mesh, ordered by the first use of their materials. Appends a white
/// material to `materials` if a primitive has none.
std::vector<std::vector<MeshPart>> read_mesh_parts(std::vector<Material>& materials,
                                                   ReadContext& context);
/// Returns a mesh's place for messages, such as "FILE: meshes[0] 'm'".
std::string mesh_place(const Document& document, std::size_t mesh);
/// Builds the mesh of one part, without unused vertices. Normals may be missing or have zero
/// length. `weights`: weights of the morph targets. `joints`: for each joint of the skin, the
/// transform from its bind space to world space. With joints, the vertices are in world space.
/// Throws `bad_data`.
Mesh build_part(std::size_t mesh, const MeshPart& part, const std::vector<double>& weights,
                const ReadContext& context, const std::vector<dmat4>* joints = nullptr);

// ---- gltf_animation.cpp

/// The motion of a node in its parent's space. Values of a track replace the node's own. A null
/// track means that this part of the transform does not move.
struct NodeTracks {
    std::shared_ptr<const TranslationTrack> translations, scales;
    std::shared_ptr<const RotationTrack> rotations;
    bool has_track() const { return translations || scales || rotations; }
};
/// The animation that moves the nodes of the scene.
struct NodeAnimation {
    std::vector<NodeTracks> nodes; ///< tracks of each node
    bool repeats = false;
};
/// Reads the animation that the options choose. The other animations are checked, too. Throws
/// `bad_data`, or the failure of `FileOptions::animation_by` for a name that no animation has.
NodeAnimation read_animation(ReadContext& context);

// ---- gltf_rig.cpp

/// The world transform of a node, and its motion in world space.
struct PlacedNode {
    dmat4 world_from_node{1};
    Motion motion;
    bool reached = false; ///< the node belongs to the scene that is shown
};

/// Returns the world transform and motion of each node. The transform is that at rest or, if the
/// node follows a rig, that at time 0. Throws `bad_data` for a node that the scene reaches twice.
std::vector<PlacedNode> place_nodes(const Document& document, const NodeAnimation& animation);

/// Returns, for each joint of a skin, the transform from its bind space to world space. `at_rest`
/// holds the world transform of each node. Throws `bad_data`.
std::vector<dmat4> joint_transforms(int skin, const std::vector<dmat4>& at_rest,
                                    ReadContext& context);
/// Returns the transform from each node to world space, with nothing animated.
std::vector<dmat4> rest_transforms(const Document& document);

/// Checks a primitive's attributes, morph targets and indices. Throws `bad_data` beginning with
/// `place` if they cannot be drawn.
void check_primitive(const tinygltf::Primitive& primitive, const std::string& place,
                     ReadContext& context);

struct GltfVertex {
    dvec3 position, normal; ///< a normal of zero means none
};

/// The elements of a checked primitive.
struct GltfPrimitive {
    GltfPrimitive(const tinygltf::Model& model, const tinygltf::Primitive& from,
                  const std::vector<double>& weights);

    std::size_t triangle_count() const;
    /// Returns a vertex, moved by the morph targets at their weights.
    GltfVertex vertex(std::size_t index) const;
    vec4 colour(std::size_t index) const;
    /// Moves a vertex into world space by the weighted mean of its joints. Joints beyond the list
    /// are ignored. A vertex whose weights add up to zero stays. Needs `joints` and `weights`.
    void pose(std::size_t index, const std::vector<dmat4>& world_from_bound, dvec3& position,
              dvec3& normal) const;

    int mode;
    AccessorElements positions;
    std::optional<AccessorElements> normals, indices, colours, joints, weights;
    std::array<std::optional<AccessorElements>, 2> uv;
    struct MorphTarget {
        double weight;
        std::optional<AccessorElements> positions, normals;
    };
    std::vector<MorphTarget> morphs; ///< only targets with a weight other than 0
};

/// Returns indices into the positions, three for each triangle. Throws `bad_data` beginning with
/// `place` for an index of no position, or for a restart index.
std::vector<std::uint32_t> triangle_corners(const GltfPrimitive& primitive,
                                            const std::string& place);

} // namespace catoptric::scene::gltf
