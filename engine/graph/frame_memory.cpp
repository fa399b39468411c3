#include "graph/frame_memory.hpp"

#include "graph/device_memory.hpp"

#include <algorithm>

namespace catoptric::graph {

namespace {

/// Calls visit(placement) for each image and buffer in the memory of frames whose member `alone`
/// equals the given value. Those that outlive frames are skipped.
template <typename Visit>
void for_each_memory_placement(const CompiledRenderGraph& shape, bool alone, const Visit& visit) {
    for (std::uint32_t i = 0; i < shape.plan.images.size(); ++i) {
        const MemoryPlacement& placement = shape.plan.images[i];
        if (shape.is_allocated_by_runner(i) && placement.alone == alone &&
            !shape.outlives_frames(i))
            visit(placement);
    }
    for (std::uint32_t b = 0; b < shape.plan.buffers.size(); ++b)
        if (shape.is_allocated_by_runner(BufferHandle{b}) && shape.plan.buffers[b].alone == alone &&
            !shape.outlives_frames(BufferHandle{b}))
            visit(shape.plan.buffers[b]);
}

/// Returns the offset in each heap of the plan at which outputs begin. In a plan, outputs follow
/// the memory that resources share. The runner allocates outputs separately, at the same distances
/// from each other.
std::vector<std::uint64_t> find_output_offsets_in_heaps(const CompiledRenderGraph& shape) {
    const std::vector<std::uint64_t>& heaps = shape.plan.heap_bytes;
    std::vector<std::uint64_t> begin = heaps, alignment(heaps.size(), 1);
    for_each_memory_placement(shape, true, [&](const MemoryPlacement& p) {
        begin[p.heap] = std::min(begin[p.heap], p.offset);
        alignment[p.heap] = std::max(alignment[p.heap], p.alignment);
    });
    for (std::size_t h = 0; h < begin.size(); ++h) begin[h] -= begin[h] % alignment[h];
    return begin;
}

/// Returns the bytes of each heap that a planned graph needs.
std::vector<std::uint64_t> count_needed_bytes_per_heap(const CompiledRenderGraph& shape,
                                                       bool alone) {
    std::vector<std::uint64_t> bytes(shape.plan.heap_bytes.size(), 0);
    const std::vector<std::uint64_t> begin = find_output_offsets_in_heaps(shape);
    for_each_memory_placement(shape, alone, [&](const MemoryPlacement& p) {
        const std::uint64_t end = p.offset + p.bytes - (alone ? begin[p.heap] : 0);
        bytes[p.heap] = std::max(bytes[p.heap], end);
    });
    return bytes;
}

std::vector<std::uint64_t>
max_needed_bytes_per_heap(std::span<const std::shared_ptr<CompiledRenderGraph>> shapes,
                          bool alone) {
    std::vector<std::uint64_t> largest;
    for (const auto& shape : shapes) {
        if (!shape->ran) continue;
        const std::vector<std::uint64_t> bytes = count_needed_bytes_per_heap(*shape, alone);
        largest.resize(std::max(largest.size(), bytes.size()), 0);
        for (std::size_t h = 0; h < bytes.size(); ++h) largest[h] = std::max(largest[h], bytes[h]);
    }
    return largest;
}

} // namespace

void SharedGraphMemoryArena::allocate(DeviceHeapAllocations& arena,
                                      std::vector<std::uint64_t> bytes) {
    arena = {}; // frees the old memory before more is allocated
    for (std::size_t type = 0; type < bytes.size(); ++type)
        arena.heaps.push_back(
            bytes[type] ? memory_device_.allocate(bytes[type], static_cast<std::uint32_t>(type),
                                                  "images of the frame")
                        : gpu::UniqueMemory());
    arena.bytes = std::move(bytes);
}

void SharedGraphMemoryArena::create_resources(CompiledRenderGraph& shape,
                                              CompiledGraphResources& resources,
                                              const DeviceHeapAllocations& arena, bool alone) {
    resources = {};
    const std::vector<std::uint64_t> begin = find_output_offsets_in_heaps(shape);
    const auto offset_of = [&](const MemoryPlacement& p) {
        return p.offset - (alone ? begin[p.heap] : 0);
    };
    for (std::uint32_t i = 0; i < shape.plan.images.size(); ++i) {
        const MemoryPlacement& p = shape.plan.images[i];
        const ImageDesc& desc = shape.outline.list_images()[i];
        resources.images.emplace_back();
        if (!shape.is_allocated_by_runner(i) || p.alone != alone || shape.outlives_frames(i))
            continue;
        resources.images.back() = make_physical_image(memory_device_, desc);
        gpu::check_vk(vkBindImageMemory(memory_device_.handle(), resources.images.back().image,
                                        arena.heaps[p.heap], offset_of(p)),
                      "place image '" + desc.name + "'");
    }
    for (std::uint32_t b = 0; b < shape.plan.buffers.size(); ++b) {
        const MemoryPlacement& p = shape.plan.buffers[b];
        const BufferDesc& desc = shape.outline.list_buffers()[b];
        resources.buffers.emplace_back();
        if (!shape.is_allocated_by_runner(BufferHandle{b}) || p.alone != alone ||
            shape.outlives_frames(BufferHandle{b}))
            continue;
        resources.buffers.back() = make_unbound_buffer(memory_device_, desc);
        gpu::check_vk(vkBindBufferMemory(memory_device_.handle(), resources.buffers.back(),
                                         arena.heaps[p.heap], offset_of(p)),
                      "place buffer '" + desc.name + "'");
    }
    resources.made = true;
}

std::uint64_t SharedGraphMemoryArena::allocated_device_bytes() const {
    std::uint64_t sum = 0;
    const auto add = [&](const DeviceHeapAllocations& arena) {
        for (const std::uint64_t bytes : arena.bytes) sum += bytes;
    };
    add(shared_);
    for (const DeviceHeapAllocations& arena : own_) add(arena);
    return sum;
}

void SharedGraphMemoryArena::find_or_make_resources(
    CompiledRenderGraph& shape, std::size_t slot,
    std::span<const std::shared_ptr<CompiledRenderGraph>> shapes,
    const std::function<void()>& wait) {
    shape.ran = true;
    if (shape.shared.made && shape.own[slot].made) return;
    if (std::vector<std::uint64_t> bytes = max_needed_bytes_per_heap(shapes, false);
        bytes != shared_.bytes) {
        wait();
        for (const auto& other : shapes) other->shared = {};
        allocate(shared_, std::move(bytes));
    }
    // No frame in flight uses the memory of this slot, because the slot's last frame has ended.
    if (std::vector<std::uint64_t> bytes = max_needed_bytes_per_heap(shapes, true);
        bytes != own_[slot].bytes) {
        for (const auto& other : shapes) other->own[slot] = {};
        allocate(own_[slot], std::move(bytes));
    }
    if (!shape.shared.made) create_resources(shape, shape.shared, shared_, false);
    if (!shape.own[slot].made) create_resources(shape, shape.own[slot], own_[slot], true);
}

} // namespace catoptric::graph
