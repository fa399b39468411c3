#pragma once

#include "core/math.hpp"
#include "gpu/buffer.hpp"
#include "gpu/pipeline.hpp"
#include "whitted.hpp"

#include <map>

/// Vulkan as plain code has it, for prototypes beside which our own frames are measured: images
/// that stay in one layout, sets written once, a barrier of all memory between passes.
namespace peers {

/// Always in VK_IMAGE_LAYOUT_GENERAL.
class PlainImage {
public:
    PlainImage() = default;
    PlainImage(catoptric::gpu::Device& device, catoptric::Format format, catoptric::uvec2 size,
               std::uint32_t layers, VkImageUsageFlags usage);

    /// Some layers, as the shader has them; valid as long as the image.
    VkImageView view(VkImageViewType type, std::uint32_t first = 0, std::uint32_t count = 1);
    VkExtent2D extent() const { return extent_; }
    /// The first layer's texels, to a buffer.
    void copy(VkCommandBuffer commands, const catoptric::gpu::Buffer& to) const;

private:
    catoptric::gpu::DeviceHandle device_;
    catoptric::Format format_{};
    VkExtent2D extent_{};
    catoptric::gpu::UniqueMemory memory_; // before the image: destroyed after it
    catoptric::gpu::UniqueImage image_;
    std::vector<catoptric::gpu::UniqueImageView> views_;
};

/// What such a copy of a rgba32f image holds.
std::vector<Vector> vectors_of(const catoptric::gpu::Buffer& texels);

/// What a shader's binding of some name stands for: a buffer, or a view with or without a sampler.
struct Resource {
    const catoptric::gpu::Buffer* buffer = nullptr;
    VkImageView view = VK_NULL_HANDLE;
    VkSampler sampler = VK_NULL_HANDLE;
};
using Resources = std::map<std::string, Resource>;

/// A pipeline with its set.
struct Bound {
    const catoptric::gpu::Pipeline* pipeline = nullptr;
    VkDescriptorSet set = VK_NULL_HANDLE;

    void bind(VkCommandBuffer commands) const;
    template <typename Push>
    void push(VkCommandBuffer commands, const Push& push) const {
        vkCmdPushConstants(commands, pipeline->layout, pipeline->stages, 0, sizeof push, &push);
    }
};

/// Sets of one program; all of them live as long as this.
class PlainSets {
public:
    explicit PlainSets(const catoptric::gpu::Device& device);
    /// Resources by name; those that the pipeline does not use are left out.
    Bound bind(const catoptric::gpu::Pipeline& pipeline, const Resources& resources);

private:
    const catoptric::gpu::Device& device_;
    catoptric::gpu::UniqueDescriptorPool pool_;
};

/// Texels are mixed, and compared (reversed depth) where `compares`.
catoptric::gpu::UniqueSampler linear_sampler(const catoptric::gpu::Device& device, bool compares);

/// All that was written is visible to all that follows.
void plain_barrier(VkCommandBuffer commands);

/// An attachment that is cleared.
VkRenderingAttachmentInfo cleared(VkImageView view, float red, bool stored = true);

} // namespace peers
