#pragma once

#include "graph/commands.hpp"
#include "render/device_list.hpp"
#include "scene/scene.hpp"

#include <memory>

/// The environment, which fills the background of pictures.
namespace catoptric::render {

class GpuScene;

class DeviceEnvironment {
public:
    explicit DeviceEnvironment(std::size_t slots);

    /// Sets the environment; null: black. `has_lobes`: some surface reflects it by a lobe.
    /// `casts_shadows`: rays leave surfaces towards its bright cells
    /// (find_bright_cells). Costs O(texels) if the environment differs from the last
    /// one, and about 0.2 s for lobes (find_sky_levels).
    void set(const std::shared_ptr<const scene::Environment>& environment, bool has_lobes,
             bool casts_shadows);
    /// Writes the changes, like DeviceList::write.
    std::size_t write(gpu::Device& device, std::size_t slot);
    void bind(graph::PassCommands& commands, std::size_t slot) const;
    /// Binds the triangle that covers the picture.
    void bind_vertices(graph::PassCommands& commands, std::size_t slot) const;
    /// Returns the kind of environment, numbered as in shaders/lib/environment.glsl; 0: none.
    std::uint32_t kind() const { return kind_; }

private:
    std::shared_ptr<const scene::Environment> environment_;
    std::uint32_t kind_ = 0;
    bool has_levels_ = false, has_cells_ = false;
    DeviceList sky_, texels_, vertices_, indices_;
};

/// Draws the environment into pixels that no surface covers, into layers whose views start at
/// `first_view`. `store`: as in DrawSettings.
void draw_sky(graph::PassCommands& commands, const GpuScene& scene, std::uint32_t first_view,
              std::uint32_t layers, const gpu::ShaderConstants& store);

} // namespace catoptric::render
