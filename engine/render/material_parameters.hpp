#pragma once

#include "graph/commands.hpp"
#include "render/device_list.hpp"
#include "render/geometry.hpp"
#include "render/vertices.hpp"

namespace catoptric::render {

/// The material parameters of surfaces with more than one colour, on the device
/// (shaders/lib/material.glsl): textures, vertex attributes, alpha masks and sharp reflection.
class MaterialParameterLists {
public:
    explicit MaterialParameterLists(std::size_t slots);

    /// Fills the lists for a new geometry layout. Costs O(n) in attributes, and in texels if the
    /// images changed. Throws `exhausted` if the images and the tables before them take more than
    /// `most` texels.
    void fill(const scene::Scene& now, const SceneUnitTransform& space,
              const FrameGeometry& geometry, const DeviceVertices& vertices, std::uint64_t most);
    /// Writes the changes, like DeviceList::upload_changed_pages.
    std::size_t write(gpu::Device& device, std::size_t slot);
    void bind(graph::PassCommands& commands, std::size_t slot) const;

    bool any_clear_coat() const { return any_clear_coat_; } ///< some surface has a clear coat
    /// Returns whether glass attenuates the light that surfaces behind it receive.
    bool has_tinted_shadows() const { return any_tinted_shadow_; }
    bool has_any_glass_material() const { return any_glass_; } ///< rays pass through some surface
    /// Returns whether solid bodies of glass share space (scene/nested_glass.hpp).
    bool has_ranked_glass() const { return any_ranked_glass_; }
    bool has_any_blended_material() const {
        return any_blended_;
    }                                                     ///< some surface covers by its alpha
    bool has_varying_colours() const { return any_; }     ///< some surface has more than one colour
    bool has_cut_out_surfaces() const { return masks_; }  ///< some surface is partly cut out
    bool has_lobe_surfaces() const { return any_lobes_; } ///< some surface reflects by a lobe
    bool has_normal_textures() const { return any_normal_textures_; }
    /// Returns, for each object, the index of its material parameters. Objects with equal
    /// parameters share an entry. Entries of ranked glass come first, by falling rank.
    const std::vector<std::uint32_t>& material_parameter_indices() const { return indices_; }

private:
    shared::TextureUse texture_use_of_material(const std::optional<scene::Texture>& texture) const;
    void fill_texture_texels(const scene::Scene& now, std::uint64_t most);
    /// Returns the parameters of an object that follow from its material and its draw range.
    shared::MaterialParameters make_parameters_of_object(const scene::Scene& now,
                                                         const SceneUnitTransform& space,
                                                         const scene::Material& material,
                                                         const ObjectDrawRange& range,
                                                         const DeviceVertices& vertices) const;

    /// Images of the textures, in the order in which their texels lie in the texel buffer.
    std::vector<std::shared_ptr<const scene::Image>> images_;
    std::vector<std::uint32_t> first_texels_; ///< first texel of each image
    std::vector<std::uint32_t> indices_;      ///< index of each object's parameters
    bool any_ = false, masks_ = false, any_normal_textures_ = false;
    bool any_lobes_ = false, any_glass_ = false, any_clear_coat_ = false, any_blended_ = false;
    bool any_tinted_shadow_ = false, any_ranked_glass_ = false;
    bool has_lobe_table_ = false; ///< the texels hold the albedo of rough lobes
    bool texels_filled_ = false;  ///< `fill_texture_texels` was called
    DeviceList detail_words_, attributes_, texels_;
};

} // namespace catoptric::render
