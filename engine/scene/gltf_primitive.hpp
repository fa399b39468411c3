#pragma once

#include "scene/gltf_model.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace catoptric::scene::gltf {

/// Throws `bad_data` beginning with `place` for attributes or indices that cannot be drawn.
void check_primitive(const tinygltf::Primitive& primitive, const std::string& place,
                     Context& context);

struct Vertex {
    dvec3 position, normal; ///< zero: none
};

/// The elements that a primitive is made of, which has been checked.
struct Primitive {
    Primitive(const tinygltf::Model& model, const tinygltf::Primitive& from,
              const std::vector<double>& weights);

    std::size_t triangle_count() const;
    /// With the morph targets of its mesh at their weights.
    Vertex vertex(std::size_t index) const;
    vec4 colour(std::size_t index) const;
    /// Moves a vertex with its joints, of which there are enough.
    void pose(std::size_t index, const std::vector<dmat4>& world_from_bound, dvec3& position,
              dvec3& normal) const;

    int mode;
    Elements positions;
    std::optional<Elements> normals, indices, colours, joints, weights;
    std::array<std::optional<Elements>, 2> uv;
    struct Morph {
        double weight;
        std::optional<Elements> positions, normals;
    };
    std::vector<Morph> morphs; ///< those whose weight is not 0
};

/// The corners of its triangles, as numbers of its positions. Throws `bad_data` for an index of
/// none.
std::vector<std::uint32_t> corners_of(const Primitive& primitive, const std::string& place);

} // namespace catoptric::scene::gltf
