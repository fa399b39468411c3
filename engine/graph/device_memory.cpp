#include "graph/device_memory.hpp"

#include <algorithm>

namespace catoptric::graph {

namespace {

VkMemoryRequirements query_requirements(const gpu::Device& device, const ImageDesc& desc) {
    const VkImageCreateInfo create = image_create_info(desc);
    VkDeviceImageMemoryRequirements info{VK_STRUCTURE_TYPE_DEVICE_IMAGE_MEMORY_REQUIREMENTS};
    info.pCreateInfo = &create;
    VkMemoryRequirements2 needs{VK_STRUCTURE_TYPE_MEMORY_REQUIREMENTS_2};
    vkGetDeviceImageMemoryRequirements(device.handle(), &info, &needs);
    return needs.memoryRequirements;
}

VkBufferCreateInfo buffer_create_info(const BufferDesc& desc) {
    VkBufferCreateInfo create{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    create.size = desc.bytes;
    create.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
                   VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                   VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    return create;
}

VkMemoryRequirements query_requirements(const gpu::Device& device, const BufferDesc& desc) {
    const VkBufferCreateInfo create = buffer_create_info(desc);
    VkDeviceBufferMemoryRequirements info{VK_STRUCTURE_TYPE_DEVICE_BUFFER_MEMORY_REQUIREMENTS};
    info.pCreateInfo = &create;
    VkMemoryRequirements2 needs{VK_STRUCTURE_TYPE_MEMORY_REQUIREMENTS_2};
    vkGetDeviceBufferMemoryRequirements(device.handle(), &info, &needs);
    return needs.memoryRequirements;
}

MemoryRequirements to_requirements(const gpu::Device& device, const VkMemoryRequirements& needs,
                                   const std::string& name) {
    const int type = device.find_memory_type(needs.memoryTypeBits,
                                             VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    check(type >= 0, Failure::internal, "no memory type for '", name, "'");
    // Buffers and images are placed in the same heaps. Their offsets are aligned to
    // bufferImageGranularity, so that a buffer and an image never share a page.
    const auto granularity = device.limits().bufferImageGranularity;
    return {needs.size, std::max<std::uint64_t>(needs.alignment, granularity),
            static_cast<std::uint32_t>(type)};
}

} // namespace

MemorySizer device_sizer(const gpu::Device& device) {
    return {[&device](const ImageDesc& desc) {
                return to_requirements(device, query_requirements(device, desc), desc.name);
            },
            [&device](const BufferDesc& desc) {
                return to_requirements(device, query_requirements(device, desc), desc.name);
            }};
}

gpu::UniqueBuffer make_unbound_buffer(const gpu::Device& device, const BufferDesc& desc) {
    const VkBufferCreateInfo create = buffer_create_info(desc);
    VkBuffer buffer = VK_NULL_HANDLE;
    gpu::check_vk(vkCreateBuffer(device.handle(), &create, nullptr, &buffer),
                  "create buffer '" + desc.name + "'");
    device.set_debug_name(VK_OBJECT_TYPE_BUFFER, reinterpret_cast<std::uint64_t>(buffer),
                          desc.name);
    return {device.handle(), buffer};
}

ImageWithMemory make_importable_image(const gpu::Device& device, const ImageDesc& desc) {
    const MemoryRequirements needs = device_sizer(device).image(desc);
    ImageWithMemory made{device.allocate(needs.bytes, needs.heap, desc.name),
                         make_physical_image(device, desc)};
    gpu::check_vk(vkBindImageMemory(device.handle(), made.image.image, made.memory, 0),
                  "place image '" + desc.name + "'");
    return made;
}

} // namespace catoptric::graph
