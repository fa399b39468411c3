#pragma once

#include "graph/commands.hpp"
#include "render/geometry.hpp"
#include "render/resident.hpp"
#include "render/vertices.hpp"

namespace catoptric::render {

/// What surfaces are beyond one colour, on the device (shaders/lib/material.glsl): textures,
/// attributes of vertices, what is cut out, what is sharp.
class MaterialParameterLists {
public:
    explicit MaterialParameterLists(std::size_t slots);

    /// Of a geometry laid out anew, O(n) in attributes, and in texels where images are others.
    /// Throws `exhausted` where the images have more than `most` texels, some of them a table.
    void fill(const scene::Scene& now, const Geometry& geometry, const Vertices& vertices,
              std::uint64_t most);
    /// As Resident::write.
    std::size_t write(gpu::Device& device, std::size_t slot);
    void bind(graph::Commands& commands, std::size_t slot) const;

    bool any() const { return any_; }     ///< some surface is more than one colour
    bool masks() const { return masks_; } ///< something is cut out
    /// By object, where in the list of details its own is. Objects with equal details share one.
    const std::vector<std::uint32_t>& indices() const { return indices_; }

private:
    shared::TextureUse use_of(const std::optional<scene::Texture>& texture) const;
    void fill_texels(const scene::Scene& now, std::uint64_t most);

    std::vector<std::shared_ptr<const scene::Image>> images_; ///< in the buffer, one after another
    std::vector<std::uint32_t> first_texels_;                 ///< by image
    std::vector<std::uint32_t> indices_;                      ///< by object
    bool any_ = false, masks_ = false;
    Resident details_, attributes_, texels_;
};

} // namespace catoptric::render
