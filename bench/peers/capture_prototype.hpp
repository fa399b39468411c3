#pragma once

#include "plain.hpp"
#include "render/geometry.hpp"
#include "session/run.hpp"

#include <array>

namespace peers {

/// Simple Vulkan prototype of our technique `parallax`, without the engine's robustness. A frame
/// draws a shadow map of the mirror balls, a capture of each mirror, and the camera's view.
/// Mirrors in a capture show the captures of the frame before. Reflected directions get one step of
/// parallax correction. Supports only the features of the built-in scene.
class CubeCapturePrototypeRenderer {
public:
    /// Sets up the request's scene. `face` is the edge of the captures' faces, texels.
    CubeCapturePrototypeRenderer(catoptric::gpu::Device& device,
                                 catoptric::gpu::PipelineStore& pipelines,
                                 const catoptric::session::Request& request, std::uint32_t face);

    /// Draws a frame and waits for the device.
    void draw();
    std::vector<PeerVector3> read(); ///< returns the camera's view of the last frame, linear

private:
    struct PrototypeMaterial {
        catoptric::vec4 albedo, emission; ///< the albedo of a mirror holds its reflectance
    };
    /// Push constants of a draw, as in shaders/draw.glsl.
    struct DrawPushConstants {
        catoptric::vec4 eye, albedo, emission, centre;
        std::uint32_t first_view;
        float cube;
    };
    /// The captures of all mirrors: cube maps of colour and of distance.
    struct MirrorCaptureCubeMaps {
        GeneralLayoutVulkanImage colour, distance;
    };
    /// The pipelines of a pass, with descriptor sets for even or for odd frames.
    struct PrototypeGraphicsPipelines {
        BoundPrototypePipeline diffuse, mirror;
    };

    void add_scene(const catoptric::session::Request& request);
    void make_images(catoptric::uvec2 size);
    void make_programs(catoptric::gpu::PipelineStore& pipelines);
    void draw_object(VkCommandBuffer commands, const BoundPrototypePipeline& program,
                     std::size_t object, std::uint32_t first_view, std::uint32_t layers) const;
    void draw_shadows(VkCommandBuffer commands);
    void draw_surfaces(VkCommandBuffer commands, const PrototypeGraphicsPipelines& programs,
                       std::uint32_t first_view, std::uint32_t layers, std::size_t except) const;

    catoptric::gpu::Device& peer_device_;
    std::uint32_t face_;
    catoptric::render::FrameGeometry geometry_;
    std::vector<PrototypeMaterial> materials_; ///< material of each object
    std::vector<std::size_t> mirrors_;         ///< indices of the objects that are mirrors
    std::vector<catoptric::shared::View>
        views_; ///< views in the order of Frame in shaders/draw.glsl
    catoptric::gpu::Buffer vertices_, indices_, frame_, pixels_;
    catoptric::gpu::UniqueSampler linear_, compare_;
    GeneralLayoutVulkanImage shadow_map_, depth_, view_, view_depth_;
    std::array<MirrorCaptureCubeMaps, 2>
        cubes_; ///< captures of the current frame and of the frame before, in turn
    PrototypeDescriptorSets sets_;
    BoundPrototypePipeline shadow_;
    std::array<PrototypeGraphicsPipelines, 2> capture_,
        camera_; ///< by the element of `cubes_` that they read
    /// The capture's faces as attachments, by element of `cubes_` and by mirror: colour, distance.
    std::array<std::vector<std::array<VkImageView, 2>>, 2> faces_;
    VkImageView shadow_faces_{}, depth_faces_{}, picture_{}, picture_depth_{};
    std::size_t frame_number_ = 0;
};

} // namespace peers
