#include "graph/frame_memory.hpp"

#include <algorithm>

namespace catoptric::graph {

namespace {

VkMemoryRequirements requirements(const gpu::Device& device, const ImageDesc& desc) {
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
    create.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT |
                   VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    return create;
}

VkMemoryRequirements requirements(const gpu::Device& device, const BufferDesc& desc) {
    const VkBufferCreateInfo create = buffer_create_info(desc);
    VkDeviceBufferMemoryRequirements info{VK_STRUCTURE_TYPE_DEVICE_BUFFER_MEMORY_REQUIREMENTS};
    info.pCreateInfo = &create;
    VkMemoryRequirements2 needs{VK_STRUCTURE_TYPE_MEMORY_REQUIREMENTS_2};
    vkGetDeviceBufferMemoryRequirements(device.handle(), &info, &needs);
    return needs.memoryRequirements;
}

Requirements placed(const gpu::Device& device, const VkMemoryRequirements& needs,
                    const std::string& name) {
    const int type = device.memory_type(needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    check(type >= 0, Failure::internal, "no memory type for '", name, "'");
    // Linear buffers and optimal images share heaps: the granularity keeps them on pages of their
    // own.
    const auto granularity = device.limits().bufferImageGranularity;
    return {needs.size, std::max<std::uint64_t>(needs.alignment, granularity),
            static_cast<std::uint32_t>(type)};
}

gpu::UniqueBuffer make_buffer(const gpu::Device& device, const BufferDesc& desc) {
    const VkBufferCreateInfo create = buffer_create_info(desc);
    VkBuffer buffer = VK_NULL_HANDLE;
    gpu::check_vk(vkCreateBuffer(device.handle(), &create, nullptr, &buffer),
                  "create buffer '" + desc.name + "'");
    device.set_name(VK_OBJECT_TYPE_BUFFER, reinterpret_cast<std::uint64_t>(buffer), desc.name);
    return {device.handle(), buffer};
}

/// Calls visit(placement) for what lies in the memory of frames: `alone` or not, and not kept.
template <typename Visit>
void for_each_placement(const Compiled& shape, bool alone, const Visit& visit) {
    for (std::uint32_t i = 0; i < shape.plan.images.size(); ++i) {
        const Placement& placement = shape.plan.images[i];
        if (placement.used && placement.alone == alone && !shape.is_kept(i)) visit(placement);
    }
    for (const Placement& placement : shape.plan.buffers)
        if (placement.used && placement.alone == alone) visit(placement);
}

/// Where in each heap of the plan the memory of its wanted ones begins. The plan has them behind
/// what is shared; here they are elsewhere, at the same distance from one another.
std::vector<std::uint64_t> begin_of_own(const Compiled& shape) {
    const std::vector<std::uint64_t>& heaps = shape.plan.heap_bytes;
    std::vector<std::uint64_t> begin = heaps, alignment(heaps.size(), 1);
    for_each_placement(shape, true, [&](const Placement& p) {
        begin[p.heap] = std::min(begin[p.heap], p.offset);
        alignment[p.heap] = std::max(alignment[p.heap], p.alignment);
    });
    for (std::size_t h = 0; h < begin.size(); ++h) begin[h] -= begin[h] % alignment[h];
    return begin;
}

/// Bytes that a shape needs of each heap.
std::vector<std::uint64_t> claim(const Compiled& shape, bool alone) {
    std::vector<std::uint64_t> bytes(shape.plan.heap_bytes.size(), 0);
    const std::vector<std::uint64_t> begin = begin_of_own(shape);
    for_each_placement(shape, alone, [&](const Placement& p) {
        const std::uint64_t end = p.offset + p.bytes - (alone ? begin[p.heap] : 0);
        bytes[p.heap] = std::max(bytes[p.heap], end);
    });
    return bytes;
}

std::vector<std::uint64_t> largest_claim(std::span<const std::shared_ptr<Compiled>> shapes,
                                         bool alone) {
    std::vector<std::uint64_t> largest;
    for (const auto& shape : shapes) {
        if (!shape->ran) continue;
        const std::vector<std::uint64_t> bytes = claim(*shape, alone);
        largest.resize(std::max(largest.size(), bytes.size()), 0);
        for (std::size_t h = 0; h < bytes.size(); ++h) largest[h] = std::max(largest[h], bytes[h]);
    }
    return largest;
}

} // namespace

Sizer sizer_of(const gpu::Device& device) {
    return {[&device](const ImageDesc& desc) {
                return placed(device, requirements(device, desc), desc.name);
            },
            [&device](const BufferDesc& desc) {
                return placed(device, requirements(device, desc), desc.name);
            }};
}

void FrameMemory::allocate(Arena& arena, std::vector<std::uint64_t> bytes) {
    arena = {}; // before more is asked for
    for (std::size_t type = 0; type < bytes.size(); ++type)
        arena.heaps.push_back(bytes[type]
                                  ? device_.allocate(bytes[type], static_cast<std::uint32_t>(type),
                                                     "images of the frame")
                                  : gpu::UniqueMemory());
    arena.bytes = std::move(bytes);
}

void FrameMemory::make(Compiled& shape, Resources& resources, const Arena& arena, bool alone) {
    resources = {};
    const std::vector<std::uint64_t> begin = begin_of_own(shape);
    const auto offset_of = [&](const Placement& p) {
        return p.offset - (alone ? begin[p.heap] : 0);
    };
    for (std::uint32_t i = 0; i < shape.plan.images.size(); ++i) {
        const Placement& p = shape.plan.images[i];
        const ImageDesc& desc = shape.outline.images()[i];
        resources.images.emplace_back();
        if (!p.used || p.alone != alone || shape.is_kept(i)) continue;
        resources.images.back() = make_physical(device_, desc);
        gpu::check_vk(vkBindImageMemory(device_.handle(), resources.images.back().image,
                                        arena.heaps[p.heap], offset_of(p)),
                      "place image '" + desc.name + "'");
    }
    for (std::size_t b = 0; b < shape.plan.buffers.size(); ++b) {
        const Placement& p = shape.plan.buffers[b];
        const BufferDesc& desc = shape.outline.buffers()[b];
        resources.buffers.emplace_back();
        if (!p.used || p.alone != alone) continue;
        resources.buffers.back() = make_buffer(device_, desc);
        gpu::check_vk(vkBindBufferMemory(device_.handle(), resources.buffers.back(),
                                         arena.heaps[p.heap], offset_of(p)),
                      "place buffer '" + desc.name + "'");
    }
    resources.made = true;
}

void FrameMemory::provide(Compiled& shape, std::size_t slot,
                          std::span<const std::shared_ptr<Compiled>> shapes,
                          const std::function<void()>& wait) {
    shape.ran = true;
    if (shape.shared.made && shape.own[slot].made) return;
    if (std::vector<std::uint64_t> bytes = largest_claim(shapes, false); bytes != shared_.bytes) {
        wait();
        for (const auto& other : shapes) other->shared = {};
        allocate(shared_, std::move(bytes));
    }
    // Nobody else uses this slot's: its last frame has ended.
    if (std::vector<std::uint64_t> bytes = largest_claim(shapes, true); bytes != own_[slot].bytes) {
        for (const auto& other : shapes) other->own[slot] = {};
        allocate(own_[slot], std::move(bytes));
    }
    if (!shape.shared.made) make(shape, shape.shared, shared_, false);
    if (!shape.own[slot].made) make(shape, shape.own[slot], own_[slot], true);
}

} // namespace catoptric::graph
