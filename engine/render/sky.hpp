#pragma once

#include "graph/commands.hpp"
#include "render/resident.hpp"
#include "scene/environment.hpp"

#include <memory>

/// What is seen where the scene ends.
namespace catoptric::render {

class GpuScene;

/// A scene's environment on the device.
class Sky {
public:
    explicit Sky(std::size_t slots);

    /// None: black. O(texels) where it is another than before.
    void set(const std::shared_ptr<const scene::Environment>& environment);
    /// As Resident::write.
    std::size_t write(gpu::Device& device, std::size_t slot);
    void bind(graph::Commands& commands, std::size_t slot) const;
    /// Binds the triangle that covers the picture.
    void bind_vertices(graph::Commands& commands, std::size_t slot) const;
    /// As shaders/lib/environment.glsl numbers them; 0: none.
    std::uint32_t kind() const { return kind_; }

private:
    std::shared_ptr<const scene::Environment> environment_;
    std::uint32_t kind_ = 0;
    Resident sky_, texels_, vertices_, indices_;
};

/// Draws it into the layers, whose views are those from `first_view` on, where nothing else is.
/// `store`: as Drawing has it.
void draw_sky(graph::Commands& commands, const GpuScene& scene, std::uint32_t first_view,
              std::uint32_t layers, const gpu::Constants& store);

} // namespace catoptric::render
