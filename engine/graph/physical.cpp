#include "graph/physical.hpp"

namespace catoptric::graph {

VkImageAspectFlags image_aspect(TexelFormat format) {
    return is_depth(format) ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

VkImageCreateInfo image_create_info(const ImageDesc& desc) {
    VkImageCreateInfo create{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    create.flags = desc.cube ? VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT : 0;
    create.imageType = VK_IMAGE_TYPE_2D;
    create.format = gpu::to_vk_format(desc.format);
    create.extent = {desc.width, desc.height, 1};
    create.mipLevels = desc.mips;
    create.arrayLayers = desc.layers;
    create.samples = VK_SAMPLE_COUNT_1_BIT;
    create.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                   VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    create.usage |= is_depth(desc.format) ? VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT
                                          : VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    // Vulkan requires storage images only for these formats (table of mandatory formats).
    if (desc.format == TexelFormat::rgba32f || desc.format == TexelFormat::rgba16f ||
        desc.format == TexelFormat::r32f || desc.format == TexelFormat::r32ui ||
        desc.format == TexelFormat::rgba8_unorm)
        create.usage |= VK_IMAGE_USAGE_STORAGE_BIT;
    return create;
}

PhysicalImage make_physical_image(const gpu::Device& device, const ImageDesc& desc) {
    const VkImageCreateInfo create = image_create_info(desc);
    VkImage image = VK_NULL_HANDLE;
    gpu::check_vk(vkCreateImage(device.handle(), &create, nullptr, &image),
                  "create image '" + desc.name + "'");
    device.set_debug_name(VK_OBJECT_TYPE_IMAGE, reinterpret_cast<std::uint64_t>(image), desc.name);
    PhysicalImage physical;
    physical.desc = desc;
    physical.owned = {device.handle(), image};
    physical.image = image;
    return physical;
}

PhysicalImage wrap_image(const ImageDesc& desc, VkImage image) {
    PhysicalImage physical;
    physical.desc = desc;
    physical.image = image;
    return physical;
}

VkBufferImageCopy copy_region(const ImageDesc& desc, const ImageHandle& part) {
    VkBufferImageCopy region{};
    region.imageSubresource = {image_aspect(desc.format), part.first_mip, part.first_layer,
                               part.layer_count};
    region.imageExtent = {mip_size(desc.width, part.first_mip),
                          mip_size(desc.height, part.first_mip), 1};
    return region;
}

VkImageView PhysicalImage::view(const gpu::Device& device, gpu::ImageViewType shape,
                                const ImageHandle& part) {
    using gpu::ImageViewType;
    const std::uint32_t layer_count = part.layer_count;
    const ViewKey key{shape, part.first_layer, layer_count, part.first_mip, part.mip_count};
    if (const auto found = views_.find(key); found != views_.end()) return found->second;
    const auto wants = [&](bool ok, const char* what) {
        check(ok, Failure::internal, "image '", desc.name, "' has ", layer_count,
              " layers in this view, a shader wants ", what);
    };
    VkImageViewCreateInfo create{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    switch (shape) {
    case ImageViewType::flat:
        create.viewType = VK_IMAGE_VIEW_TYPE_2D, wants(layer_count == 1, "1");
        break;
    case ImageViewType::flat_array: create.viewType = VK_IMAGE_VIEW_TYPE_2D_ARRAY; break;
    case ImageViewType::cube:
        create.viewType = VK_IMAGE_VIEW_TYPE_CUBE, wants(layer_count == 6, "6");
        break;
    case ImageViewType::cube_array:
        create.viewType = VK_IMAGE_VIEW_TYPE_CUBE_ARRAY, wants(layer_count % 6 == 0, "6 each");
        break;
    }
    create.image = image;
    create.format = gpu::to_vk_format(desc.format);
    create.subresourceRange = {image_aspect(desc.format), part.first_mip, part.mip_count,
                               part.first_layer, layer_count};
    VkImageView handle = VK_NULL_HANDLE;
    gpu::check_vk(vkCreateImageView(device.handle(), &create, nullptr, &handle),
                  "view image '" + desc.name + "'");
    device.set_debug_name(VK_OBJECT_TYPE_IMAGE_VIEW, reinterpret_cast<std::uint64_t>(handle),
                          desc.name);
    return views_.emplace(key, gpu::UniqueImageView(device.handle(), handle)).first->second;
}

} // namespace catoptric::graph
