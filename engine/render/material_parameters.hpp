#pragma once

#include "graph/commands.hpp"
#include "render/device_list.hpp"
#include "render/geometry.hpp"
#include "render/vertices.hpp"

namespace catoptric::render {

/// The material parameters of surfaces with more than one colour, on the device
/// (shaders/lib/material.glsl): textures, vertex attributes, alpha masks and sharp reflection.
class MaterialLists {
public:
    explicit MaterialLists(std::size_t slots);

    /// Fills the lists for a new geometry layout. Costs O(n) in attributes, and in texels if the
    /// images changed. Throws `exhausted` if the images and the tables before them take more than
    /// `most` texels.
    void fill(const scene::Scene& now, const SceneUnits& space, const FrameGeometry& geometry,
              const DeviceVertices& vertices, std::uint64_t most);
    /// Writes the changes, like DeviceList::write.
    std::size_t write(gpu::Device& device, std::size_t slot);
    void bind(graph::PassCommands& commands, std::size_t slot) const;

    bool has_clear_coats() const { return has_clear_coats_; }
    /// Returns whether glass attenuates the light that surfaces behind it receive.
    bool has_tinted_shadows() const { return has_tinted_shadows_; }
    bool has_glass() const { return has_glass_; } ///< rays pass through some surface
    /// Returns whether solid bodies of glass share space (scene/nested_glass.hpp).
    bool has_ranked_glass() const { return has_ranked_glass_; }
    bool has_blended() const { return has_blended_; } ///< some surface covers by its alpha
    bool has_varying_colours() const { return has_varying_colours_; }
    bool has_masks() const { return has_masks_; } ///< some surface is partly cut out
    bool has_lobes() const { return has_lobes_; }
    bool has_normal_textures() const { return has_normal_textures_; }
    /// Returns, for each object, the index of its material parameters. Objects with equal
    /// parameters share an entry. Entries of ranked glass come first, by falling rank.
    const std::vector<std::uint32_t>& indices() const { return indices_; }

private:
    shared::TextureUse texture_use(const std::optional<scene::Texture>& texture) const;
    void fill_texels(const scene::Scene& now, std::uint64_t most);
    /// Returns the parameters of an object that follow from its material and its draw range.
    shared::MaterialParameters object_parameters(const scene::Scene& now, const SceneUnits& space,
                                                 const scene::Material& material,
                                                 const DrawRange& range,
                                                 const DeviceVertices& vertices) const;

    /// Images of the textures, in the order in which their texels lie in the texel buffer.
    std::vector<std::shared_ptr<const scene::Image>> images_;
    std::vector<std::uint32_t> first_texels_; ///< first texel of each image
    std::vector<std::uint32_t> indices_;      ///< index of each object's parameters
    bool has_varying_colours_ = false, has_masks_ = false, has_normal_textures_ = false;
    bool has_lobes_ = false, has_glass_ = false, has_clear_coats_ = false, has_blended_ = false;
    bool has_tinted_shadows_ = false, has_ranked_glass_ = false;
    bool has_lobe_table_ = false; ///< the texels hold the albedo of rough lobes
    bool texels_filled_ = false;  ///< `fill_texels` was called
    DeviceList detail_words_, attributes_, texels_;
};

} // namespace catoptric::render
