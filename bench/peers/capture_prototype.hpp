#pragma once

#include "app/run.hpp"
#include "plain.hpp"
#include "render/geometry.hpp"

#include <array>

namespace peers {

/// Environment maps as a day's plain Vulkan code has them: a shadow map of the balls, a capture of
/// each mirror, in which the others show what they captured a frame before, and the view; reflected
/// directions are corrected by one step. As our `parallax`, without what it promises beside the
/// picture. Only what the built-in scene has is understood.
class CapturePrototype {
public:
    /// `face`: of captures, texels.
    CapturePrototype(catoptric::gpu::Device& device, catoptric::gpu::Pipelines& pipelines,
                     const catoptric::app::Request& request, std::uint32_t face);

    /// A frame, until it is done.
    void draw();
    std::vector<Vector> read(); ///< the view of the last frame

private:
    struct Material {
        catoptric::vec4 albedo, emission; ///< of a mirror its reflectance
    };
    /// Push constants.
    struct Draw {
        catoptric::vec4 eye, albedo, emission, centre;
        std::uint32_t first_view;
        float cube;
    };
    /// Colours and distances around all mirrors.
    struct Cubes {
        PlainImage colour, distance;
    };
    /// What an object is drawn by: the pipelines of one pass, with the set of one parity.
    struct Programs {
        Bound diffuse, mirror;
    };

    void add_scene(const catoptric::app::Request& request);
    void make_images(catoptric::uvec2 size);
    void make_programs(catoptric::gpu::Pipelines& pipelines);
    void draw_object(VkCommandBuffer commands, const Bound& program, std::size_t object,
                     std::uint32_t first_view, std::uint32_t layers) const;
    void draw_shadows(VkCommandBuffer commands);
    void draw_surfaces(VkCommandBuffer commands, const Programs& programs, std::uint32_t first_view,
                       std::uint32_t layers, std::size_t except) const;

    catoptric::gpu::Device& device_;
    std::uint32_t face_;
    catoptric::render::Geometry geometry_;
    std::vector<Material> materials_;            ///< of objects
    std::vector<std::size_t> mirrors_;           ///< their objects
    std::vector<catoptric::shared::View> views_; ///< as Frame of shaders/draw.glsl has them
    catoptric::gpu::Buffer vertices_, indices_, frame_, pixels_;
    catoptric::gpu::UniqueSampler linear_, compare_;
    PlainImage shadow_map_, depth_, view_, view_depth_;
    std::array<Cubes, 2> cubes_; ///< a frame's, and those of the frame before
    PlainSets sets_;
    Bound shadow_;
    std::array<Programs, 2> capture_, camera_; ///< by which cubes they look into
    std::array<std::vector<std::array<VkImageView, 2>>, 2> faces_; ///< of each mirror to draw to
    VkImageView shadow_faces_{}, depth_faces_{}, picture_{}, picture_depth_{};
    std::size_t frame_number_ = 0;
};

} // namespace peers
