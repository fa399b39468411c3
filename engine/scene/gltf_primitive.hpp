#pragma once

#include "scene/gltf_model.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace catoptric::scene::gltf {

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
