#pragma once

#include "scene/scene.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// A glTF 2.0 file in our own types, checked, but with its node tree not yet flattened. Indices
/// that may be absent are optional; every index is in range.
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

/// Triangles as the file has them: indices and numbers are checked, normals may be missing.
struct Primitive {
    Mesh mesh;
    std::size_t material = 0;
};

struct PrimitiveGroup {
    std::string name;
    std::vector<Primitive> primitives;
};

struct Node {
    std::string name;
    dmat4 parent_from_node{1};
    std::optional<std::size_t> mesh, camera;
    std::vector<std::size_t> children;
    std::optional<Keyframes> motion; ///< the node's translation in its parent's space, not relative
    Marks marks;
};

struct Document {
    std::vector<Node> nodes;
    std::vector<std::size_t> roots;
    std::vector<PrimitiveGroup> meshes;
    std::vector<Material> materials;
    std::vector<Camera> cameras; ///< name and field of view
    std::vector<std::string> warnings;
};

/// Reads a node's extras; a text without our marks, or none, gives the defaults. Throws `bad_data`
/// naming `place` for a mark of the wrong kind.
Marks marks(const std::string& extras_json, const std::string& place);

/// A node's matrix from the properties that it has; the others are empty.
dmat4 matrix_of(const std::vector<double>& matrix, const std::vector<double>& translation,
                const std::vector<double>& rotation, const std::vector<double>& scale);

/// An animation sampler's keys; cubic ones come as in-tangent, value, out-tangent. Throws
/// `bad_data` naming `place` for times that do not increase, counts that do not match, or what is
/// not finite.
Keyframes keyframes(const std::string& interpolation, std::vector<double> times,
                    const std::vector<dvec3>& output, const std::string& place);

/// Throws as `load_gltf`.
Document read(const std::filesystem::path& path);

/// What must hold before a general reader may see the bytes: GLB header, JSON that nests less than
/// 64 deep, asset version 2, no required extension that we lack, buffers in the file's folder.
/// Throws `bad_data` or `missing_input`.
void preflight(const std::filesystem::path& path, std::string_view bytes);

bool is_binary(std::string_view bytes);

} // namespace catoptric::scene::gltf
