#include "plain.hpp"

#include <array>
#include <cstring>

namespace peers {

using namespace catoptric;
using gpu::check_vk;

namespace {

VkImageAspectFlags image_aspect(TexelFormat format) {
    return is_depth(format) ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

} // namespace

GeneralLayoutVulkanImage::GeneralLayoutVulkanImage(gpu::Device& device, TexelFormat format,
                                                   uvec2 size, std::uint32_t layers,
                                                   VkImageUsageFlags usage)
    : peer_device_(device.handle()), format_(format), extent_{size.x, size.y} {
    VkImageCreateInfo create{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    create.flags = layers % 6 == 0 ? VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT : 0;
    create.imageType = VK_IMAGE_TYPE_2D;
    create.format = gpu::to_vk_format(format);
    create.extent = {size.x, size.y, 1};
    create.mipLevels = 1;
    create.arrayLayers = layers;
    create.samples = VK_SAMPLE_COUNT_1_BIT;
    create.usage = usage;
    VkImage image = VK_NULL_HANDLE;
    check_vk(vkCreateImage(peer_device_, &create, nullptr, &image), "create a plain image");
    image_ = {peer_device_, image};
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(peer_device_, image, &needs);
    memory_ = device.allocate(needs.size,
                              static_cast<std::uint32_t>(device.find_memory_type(
                                  needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT)),
                              "a plain image");
    check_vk(vkBindImageMemory(peer_device_, image, memory_, 0), "bind a plain image");
    device.run_commands("lay out a plain image", [&](VkCommandBuffer commands) {
        VkImageMemoryBarrier barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
        barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL;
        barrier.image = image;
        barrier.subresourceRange = {image_aspect(format), 0, 1, 0, layers};
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                             VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0, nullptr, 1,
                             &barrier);
    });
}

VkImageView GeneralLayoutVulkanImage::view(VkImageViewType type, std::uint32_t first,
                                           std::uint32_t count) {
    VkImageViewCreateInfo create{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    create.image = image_;
    create.viewType = type;
    create.format = gpu::to_vk_format(format_);
    create.subresourceRange = {image_aspect(format_), 0, 1, first, count};
    VkImageView view = VK_NULL_HANDLE;
    check_vk(vkCreateImageView(peer_device_, &create, nullptr, &view), "view a plain image");
    views_.emplace_back(peer_device_, view);
    return view;
}

void GeneralLayoutVulkanImage::copy(VkCommandBuffer commands, const gpu::Buffer& to) const {
    VkBufferImageCopy region{};
    region.imageSubresource = {image_aspect(format_), 0, 0, 1};
    region.imageExtent = {extent_.width, extent_.height, 1};
    vkCmdCopyImageToBuffer(commands, image_, VK_IMAGE_LAYOUT_GENERAL, to.handle(), 1, &region);
}

std::vector<PeerVector3> read_texel_colours_from_buffer(const gpu::Buffer& texels) {
    const std::vector<std::byte> bytes = texels.read();
    std::vector<PeerVector3> vectors(bytes.size() / sizeof(vec4));
    for (std::size_t i = 0; i < vectors.size(); ++i)
        std::memcpy(&vectors[i], &bytes[i * sizeof(vec4)], sizeof(PeerVector3));
    return vectors;
}

void BoundPrototypePipeline::bind(VkCommandBuffer commands) const {
    vkCmdBindPipeline(commands, pipeline->bind_point, pipeline->pipeline);
    vkCmdBindDescriptorSets(commands, pipeline->bind_point, pipeline->layout, 0, 1, &set, 0,
                            nullptr);
}

PrototypeDescriptorSets::PrototypeDescriptorSets(const gpu::Device& device) : peer_device_(device) {
    constexpr std::uint32_t kMaxDescriptorSets = 64;
    const std::array<VkDescriptorPoolSize, 5> sizes{
        {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, kMaxDescriptorSets},
         {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kMaxDescriptorSets},
         {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, kMaxDescriptorSets},
         {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, kMaxDescriptorSets},
         {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, kMaxDescriptorSets}}};
    VkDescriptorPoolCreateInfo create{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    create.maxSets = kMaxDescriptorSets;
    create.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
    create.pPoolSizes = sizes.data();
    VkDescriptorPool pool = VK_NULL_HANDLE;
    check_vk(vkCreateDescriptorPool(device.handle(), &create, nullptr, &pool),
             "create a descriptor pool");
    pool_ = {device.handle(), pool};
}

BoundPrototypePipeline PrototypeDescriptorSets::bind(const gpu::Pipeline& pipeline,
                                                     const Resources& resources) {
    const VkDescriptorSetLayout layout = pipeline.set_layout;
    VkDescriptorSetAllocateInfo allocate{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    allocate.descriptorPool = pool_;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &layout;
    VkDescriptorSet set = VK_NULL_HANDLE;
    check_vk(vkAllocateDescriptorSets(peer_device_.handle(), &allocate, &set), "allocate a set");
    for (const gpu::ShaderBinding& binding : pipeline.bindings) {
        const auto found = resources.find(binding.name);
        check(found != resources.end(), Failure::internal, "a prototype lacks '", binding.name,
              "'");
        const auto& [buffer, view, sampler] = found->second;
        const VkDescriptorImageInfo image{sampler, view, VK_IMAGE_LAYOUT_GENERAL};
        const VkDescriptorBufferInfo bytes{buffer ? buffer->handle() : VK_NULL_HANDLE, 0,
                                           VK_WHOLE_SIZE};
        const VkBufferView texels = buffer ? buffer->texel_view() : VK_NULL_HANDLE;
        VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
        write.dstSet = set;
        write.dstBinding = binding.binding;
        write.descriptorCount = 1;
        write.descriptorType = gpu::descriptor_type(binding.kind);
        write.pImageInfo = &image, write.pBufferInfo = &bytes, write.pTexelBufferView = &texels;
        vkUpdateDescriptorSets(peer_device_.handle(), 1, &write, 0, nullptr);
    }
    return {&pipeline, set};
}

gpu::UniqueSampler make_linear_sampler(const gpu::Device& device, bool compares) {
    VkSamplerCreateInfo create{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    create.magFilter = create.minFilter = VK_FILTER_LINEAR;
    create.addressModeU = create.addressModeV = create.addressModeW =
        VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    create.compareEnable = compares;
    create.compareOp = VK_COMPARE_OP_GREATER_OR_EQUAL;
    VkSampler sampler = VK_NULL_HANDLE;
    check_vk(vkCreateSampler(device.handle(), &create, nullptr, &sampler), "create a sampler");
    return {device.handle(), sampler};
}

void record_full_memory_barrier(VkCommandBuffer commands) {
    const VkMemoryBarrier barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr,
                                  VK_ACCESS_MEMORY_WRITE_BIT,
                                  VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                         VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 1, &barrier, 0, nullptr, 0,
                         nullptr);
}

VkRenderingAttachmentInfo make_cleared_attachment(VkImageView view, float red, bool stored) {
    VkRenderingAttachmentInfo info{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    info.imageView = view;
    info.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
    info.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    info.storeOp = stored ? VK_ATTACHMENT_STORE_OP_STORE : VK_ATTACHMENT_STORE_OP_DONT_CARE;
    info.clearValue.color.float32[0] = red; // the clear depth of a depth image
    return info;
}

} // namespace peers
