#include "graph/persistent_resources.hpp"

#include "graph/access.hpp"
#include "graph/device_memory.hpp"
#include "graph/sync.hpp"

namespace catoptric::graph {

namespace {

void clear_image(VkCommandBuffer commands, const PhysicalImage& image) {
    const ImageDesc& desc = image.desc;
    const VkImageSubresourceRange range{image_aspect(desc.format), 0, desc.mips, 0, desc.layers};
    VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    barrier.image = image.image;
    barrier.subresourceRange = range;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
    barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    gpu::image_barrier(commands, barrier);
    if (is_depth(desc.format)) {
        const VkClearDepthStencilValue nothing{};
        vkCmdClearDepthStencilImage(commands, image.image, barrier.newLayout, &nothing, 1, &range);
    } else {
        const VkClearColorValue black{};
        vkCmdClearColorImage(commands, image.image, barrier.newLayout, &black, 1, &range);
    }
    barrier.srcStageMask = barrier.dstStageMask, barrier.srcAccessMask = barrier.dstAccessMask;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT;
    barrier.oldLayout = barrier.newLayout, barrier.newLayout = image_layout(ResourceUse::sampled);
    gpu::image_barrier(commands, barrier);
}

} // namespace

/// Creates the copies of the image, cleared to black and in the layout for sampling.
void PersistentResources::create_image(const ImageDesc& desc, PersistentImage& kept) {
    const std::size_t copies = kept.lifetime == Lifetime::previous ? 2 : 1;
    const MemoryRequirements needs = device_sizer(device_).image(desc);
    const std::uint64_t second = (needs.bytes + needs.alignment - 1) / needs.alignment *
                                 needs.alignment;
    kept.bytes = (copies - 1) * second + needs.bytes;
    kept.memory = device_.allocate(kept.bytes, needs.heap, desc.name);
    for (std::size_t i = 0; i < copies; ++i) {
        kept.copies.push_back(make_physical_image(device_, desc));
        gpu::check_vk(
            vkBindImageMemory(device_.handle(), kept.copies[i].image, kept.memory, i * second),
            "place image '" + desc.name + "'");
    }
    device_.run_commands("clear image '" + desc.name + "'", [&](VkCommandBuffer commands) {
        for (const PhysicalImage& copy : kept.copies) clear_image(commands, copy);
    });
    kept.stamps = LayerHashes(desc.layers * desc.mips);
}

PersistentImage& PersistentResources::find_or_create(const ImageDesc& desc, Lifetime lifetime,
                                                     const ReplaceHandler& release) {
    auto found = all_.images.find(desc.name);
    if (found != all_.images.end() &&
        (found->second.copies[0].desc != desc || found->second.lifetime != lifetime)) {
        release(&found->second, nullptr);
        all_.images.erase(found);
        found = all_.images.end();
    }
    if (found == all_.images.end()) {
        PersistentImage kept;
        kept.lifetime = lifetime;
        create_image(desc, kept);
        found = all_.images.emplace(desc.name, std::move(kept)).first;
    }
    return found->second;
}

/// Finds the buffer, or creates its copies, filled with zeros.
PersistentBuffer& PersistentResources::find_or_create(const BufferDesc& desc,
                                                      const ReplaceHandler& release) {
    const auto found = all_.buffers.find(desc.name);
    if (found != all_.buffers.end()) {
        if (found->second.desc == desc) return found->second;
        release(nullptr, &found->second);
        all_.buffers.erase(found);
    }
    PersistentBuffer kept{.desc = desc};
    const MemoryRequirements needs = device_sizer(device_).buffer(desc);
    const std::uint64_t second = (needs.bytes + needs.alignment - 1) / needs.alignment *
                                 needs.alignment;
    kept.bytes = second + needs.bytes;
    kept.memory = device_.allocate(kept.bytes, needs.heap, desc.name);
    for (std::size_t i = 0; i < kept.copies.size(); ++i) {
        kept.copies[i] = make_unbound_buffer(device_, desc);
        gpu::check_vk(vkBindBufferMemory(device_.handle(), kept.copies[i], kept.memory, i * second),
                      "place buffer '" + desc.name + "'");
    }
    device_.run_commands("clear buffer '" + desc.name + "'", [&](VkCommandBuffer commands) {
        for (const gpu::UniqueBuffer& copy : kept.copies)
            vkCmdFillBuffer(commands, copy, 0, VK_WHOLE_SIZE, 0);
    });
    return all_.buffers.emplace(desc.name, std::move(kept)).first->second;
}

void PersistentResources::find_or_create(CompiledGraph& shape, const ReplaceHandler& release) {
    shape.kept.assign(shape.plan.images.size(), nullptr);
    for (std::uint32_t i = 0; i < shape.plan.images.size(); ++i)
        if (shape.outlives_frames(i))
            shape.kept[i] = &find_or_create(shape.outline.images()[i],
                                            shape.outline.image_lifetime(i), release);
    shape.kept_buffers.assign(shape.plan.buffers.size(), nullptr);
    for (std::uint32_t b = 0; b < shape.plan.buffers.size(); ++b)
        if (shape.outlives_frames(BufferHandle{b}))
            shape.kept_buffers[b] = &find_or_create(shape.outline.buffers()[b], release);
}

void PersistentResources::store_hashes(const Graph& graph, const CompiledGraph& shape) {
    for (const auto& [part, content_hash] : graph.content_hashes()) {
        PersistentImage* const kept = shape.kept[part.id];
        if (!kept) continue; // the frame uses no part of the image
        for_each_range(part, graph.images()[part.id].layers,
                       [&](std::uint32_t first, std::uint32_t end) {
                           kept->stamps.fill(first, end, content_hash);
                       });
    }
}

void PersistentResources::swap_copies(const CompiledGraph& shape) {
    for (PersistentImage* const kept : shape.kept) {
        if (!kept || kept->lifetime != Lifetime::previous) continue;
        kept->last = 1 - kept->last;
        kept->valid = true;
    }
    for (PersistentBuffer* const kept : shape.kept_buffers) {
        if (!kept) continue;
        kept->last = 1 - kept->last;
        kept->valid = true;
    }
}

std::uint64_t PersistentResources::allocated_bytes() const {
    std::uint64_t sum = 0;
    for (const auto& [name, kept] : all_.images) sum += kept.bytes;
    for (const auto& [name, kept] : all_.buffers) sum += kept.bytes;
    return sum;
}

GraphHistory PersistentResources::make_history() const {
    GraphHistory history;
    for (const auto& [name, kept] : all_.buffers)
        if (kept.valid) history.previous.insert(name);
    for (const auto& [name, kept] : all_.images) {
        if (kept.lifetime == Lifetime::persistent)
            history.persistent.emplace(
                name, GraphHistory::PersistentImage{kept.copies[0].desc, kept.stamps});
        else if (kept.valid)
            history.previous.insert(name);
    }
    return history;
}

} // namespace catoptric::graph
