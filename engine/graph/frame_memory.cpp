#include "graph/frame_memory.hpp"

#include "graph/device_memory.hpp"

#include <algorithm>

namespace catoptric::graph {

namespace {

/// Calls visit(placement) for each image and buffer in the memory of frames whose member `alone`
/// equals the given value. Those that outlive frames are skipped.
template <typename Visit>
void for_each_placement(const CompiledGraph& shape, bool alone, const Visit& visit) {
    for (std::uint32_t i = 0; i < shape.plan.images.size(); ++i) {
        const MemoryPlacement& placement = shape.plan.images[i];
        if (shape.owns_memory(i) && placement.alone == alone && !shape.outlives_frames(i))
            visit(placement);
    }
    for (std::uint32_t b = 0; b < shape.plan.buffers.size(); ++b)
        if (shape.owns_memory(BufferHandle{b}) && shape.plan.buffers[b].alone == alone &&
            !shape.outlives_frames(BufferHandle{b}))
            visit(shape.plan.buffers[b]);
}

/// Returns the offset in each heap of the plan at which outputs begin. In a plan, outputs follow
/// the memory that resources share. The runner allocates outputs separately, at the same distances
/// from each other.
std::vector<std::uint64_t> output_offsets(const CompiledGraph& shape) {
    const std::vector<std::uint64_t>& heaps = shape.plan.heap_bytes;
    std::vector<std::uint64_t> begin = heaps, alignment(heaps.size(), 1);
    for_each_placement(shape, true, [&](const MemoryPlacement& p) {
        begin[p.heap] = std::min(begin[p.heap], p.offset);
        alignment[p.heap] = std::max(alignment[p.heap], p.alignment);
    });
    for (std::size_t h = 0; h < begin.size(); ++h) begin[h] -= begin[h] % alignment[h];
    return begin;
}

/// Returns the bytes of each heap that a planned graph needs.
std::vector<std::uint64_t> heap_needs(const CompiledGraph& shape, bool alone) {
    std::vector<std::uint64_t> bytes(shape.plan.heap_bytes.size(), 0);
    const std::vector<std::uint64_t> begin = output_offsets(shape);
    for_each_placement(shape, alone, [&](const MemoryPlacement& p) {
        const std::uint64_t end = p.offset + p.bytes - (alone ? begin[p.heap] : 0);
        bytes[p.heap] = std::max(bytes[p.heap], end);
    });
    return bytes;
}

std::vector<std::uint64_t> max_heap_needs(std::span<const std::shared_ptr<CompiledGraph>> shapes,
                                          bool alone) {
    std::vector<std::uint64_t> largest;
    for (const auto& shape : shapes) {
        if (!shape->ran) continue;
        const std::vector<std::uint64_t> bytes = heap_needs(*shape, alone);
        largest.resize(std::max(largest.size(), bytes.size()), 0);
        for (std::size_t h = 0; h < bytes.size(); ++h) largest[h] = std::max(largest[h], bytes[h]);
    }
    return largest;
}

} // namespace

void FrameMemory::allocate(HeapAllocations& arena, std::vector<std::uint64_t> bytes) {
    arena = {}; // frees the old memory before more is allocated
    for (std::size_t type = 0; type < bytes.size(); ++type)
        arena.heaps.push_back(bytes[type]
                                  ? device_.allocate(bytes[type], static_cast<std::uint32_t>(type),
                                                     "images of the frame")
                                  : gpu::UniqueMemory());
    arena.bytes = std::move(bytes);
}

void FrameMemory::create_resources(CompiledGraph& shape, GraphResources& resources,
                                   const HeapAllocations& arena, bool alone) {
    resources = {};
    const std::vector<std::uint64_t> begin = output_offsets(shape);
    const auto offset_of = [&](const MemoryPlacement& p) {
        return p.offset - (alone ? begin[p.heap] : 0);
    };
    for (std::uint32_t i = 0; i < shape.plan.images.size(); ++i) {
        const MemoryPlacement& p = shape.plan.images[i];
        const ImageDesc& desc = shape.outline.images()[i];
        resources.images.emplace_back();
        if (!shape.owns_memory(i) || p.alone != alone || shape.outlives_frames(i)) continue;
        resources.images.back() = make_physical_image(device_, desc);
        gpu::check_vk(vkBindImageMemory(device_.handle(), resources.images.back().image,
                                        arena.heaps[p.heap], offset_of(p)),
                      "place image '" + desc.name + "'");
    }
    for (std::uint32_t b = 0; b < shape.plan.buffers.size(); ++b) {
        const MemoryPlacement& p = shape.plan.buffers[b];
        const BufferDesc& desc = shape.outline.buffers()[b];
        resources.buffers.emplace_back();
        if (!shape.owns_memory(BufferHandle{b}) || p.alone != alone ||
            shape.outlives_frames(BufferHandle{b}))
            continue;
        resources.buffers.back() = make_unbound_buffer(device_, desc);
        gpu::check_vk(vkBindBufferMemory(device_.handle(), resources.buffers.back(),
                                         arena.heaps[p.heap], offset_of(p)),
                      "place buffer '" + desc.name + "'");
    }
    resources.made = true;
}

std::uint64_t FrameMemory::allocated_bytes() const {
    std::uint64_t sum = 0;
    const auto add = [&](const HeapAllocations& arena) {
        for (const std::uint64_t bytes : arena.bytes) sum += bytes;
    };
    add(shared_);
    for (const HeapAllocations& arena : own_) add(arena);
    return sum;
}

void FrameMemory::ensure_resources(CompiledGraph& shape, std::size_t slot,
                                   std::span<const std::shared_ptr<CompiledGraph>> shapes,
                                   const std::function<void()>& wait) {
    shape.ran = true;
    if (shape.shared.made && shape.own[slot].made) return;
    if (std::vector<std::uint64_t> bytes = max_heap_needs(shapes, false); bytes != shared_.bytes) {
        wait();
        for (const auto& other : shapes) other->shared = {};
        allocate(shared_, std::move(bytes));
    }
    // No frame in flight uses the memory of this slot, because the slot's last frame has ended.
    if (std::vector<std::uint64_t> bytes = max_heap_needs(shapes, true);
        bytes != own_[slot].bytes) {
        for (const auto& other : shapes) other->own[slot] = {};
        allocate(own_[slot], std::move(bytes));
    }
    if (!shape.shared.made) create_resources(shape, shape.shared, shared_, false);
    if (!shape.own[slot].made) create_resources(shape, shape.own[slot], own_[slot], true);
}

} // namespace catoptric::graph
