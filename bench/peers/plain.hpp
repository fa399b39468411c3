#pragma once

#include "core/math.hpp"
#include "gpu/buffer.hpp"
#include "gpu/pipeline.hpp"
#include "whitted.hpp"

#include <map>

/// Simple Vulkan helpers for the prototypes that our frames are compared with. Images stay in one
/// layout, descriptor sets are written once, and a barrier of all memory separates passes.
namespace peers {

/// An image that is always in VK_IMAGE_LAYOUT_GENERAL.
class GeneralLayoutVulkanImage {
public:
    GeneralLayoutVulkanImage() = default;
    GeneralLayoutVulkanImage(catoptric::gpu::Device& device, catoptric::TexelFormat format,
                             catoptric::uvec2 size, std::uint32_t layers, VkImageUsageFlags usage);

    /// Returns a view of `count` layers from layer `first`. The view is valid as long as the image.
    VkImageView view(VkImageViewType type, std::uint32_t first = 0, std::uint32_t count = 1);
    VkExtent2D image_extent() const { return extent_; }
    /// Copies the texels of the first layer to a buffer.
    void copy(VkCommandBuffer commands, const catoptric::gpu::Buffer& to) const;

private:
    catoptric::gpu::DeviceHandle peer_device_;
    catoptric::TexelFormat format_{};
    VkExtent2D extent_{};
    catoptric::gpu::UniqueMemory memory_; // declared before the image, so destroyed after the image
    catoptric::gpu::UniqueImage image_;
    std::vector<catoptric::gpu::UniqueImageView> views_;
};

/// Returns the texels, without alpha, of an rgba32f image that GeneralLayoutVulkanImage::copy
/// copied to a buffer.
std::vector<PeerVector3> read_texel_colours_from_buffer(const catoptric::gpu::Buffer& texels);

/// The resource of a named shader binding: a buffer, or an image view with or without a sampler.
struct BoundResource {
    const catoptric::gpu::Buffer* buffer = nullptr;
    VkImageView view = VK_NULL_HANDLE;
    VkSampler sampler = VK_NULL_HANDLE;
};
using Resources = std::map<std::string, BoundResource>;

/// A pipeline with its descriptor set.
struct BoundPrototypePipeline {
    const catoptric::gpu::Pipeline* pipeline = nullptr;
    VkDescriptorSet set = VK_NULL_HANDLE;

    void bind(VkCommandBuffer commands) const;
    template <typename Push>
    void push_draw_constants(VkCommandBuffer commands, const Push& push) const {
        vkCmdPushConstants(commands, pipeline->layout, pipeline->stages, 0, sizeof push, &push);
    }
};

/// Allocates and owns the descriptor sets of a program.
class PrototypeDescriptorSets {
public:
    explicit PrototypeDescriptorSets(const catoptric::gpu::Device& device);
    /// Writes a descriptor set with the resources that the pipeline uses, by the bindings' names.
    BoundPrototypePipeline bind(const catoptric::gpu::Pipeline& pipeline,
                                const Resources& resources);

private:
    const catoptric::gpu::Device& peer_device_;
    catoptric::gpu::UniqueDescriptorPool pool_;
};

/// Creates a sampler with bilinear filtering. With `compares` the sampler compares reversed depth.
catoptric::gpu::UniqueSampler make_linear_sampler(const catoptric::gpu::Device& device,
                                                  bool compares);

/// Records a barrier that makes all writes before it visible to all commands after it.
void record_full_memory_barrier(VkCommandBuffer commands);

/// Returns an attachment that is cleared to `red` (of a depth image, the depth).
VkRenderingAttachmentInfo make_cleared_attachment(VkImageView view, float red, bool stored = true);

} // namespace peers
