// Reads images and buffers of a graph runner back to the host.
#include "graph/graph_runner.hpp"
#include "graph/sync.hpp"

namespace catoptric::graph {

namespace {

std::uint64_t part_bytes(const ImageDesc& desc, const ImageHandle& part) {
    std::uint64_t texels = 0;
    for (std::uint32_t m = part.first_mip; m < part.first_mip + part.mip_count; ++m)
        texels += std::uint64_t{mip_size(desc.width, m)} * mip_size(desc.height, m);
    return texels * part.layer_count * bytes_per_texel(desc.format);
}

/// Records the copy of a part of an image to a buffer. The part is in layout `is` before and after.
void record_copy(VkCommandBuffer commands, const PhysicalImage& source, const ImageHandle& part,
                 VkImageLayout is, VkBuffer target) {
    VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    barrier.srcStageMask = barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT;
    barrier.oldLayout = is, barrier.newLayout = image_layout(ResourceUse::copy_from);
    barrier.image = source.image;
    barrier.subresourceRange = {image_aspect(source.desc.format), part.first_mip, part.mip_count,
                                part.first_layer, part.layer_count};
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.imageMemoryBarrierCount = 1;
    dependency.pImageMemoryBarriers = &barrier;
    const bool moves = barrier.oldLayout != barrier.newLayout;
    if (moves) vkCmdPipelineBarrier2(commands, &dependency);
    std::uint64_t offset = 0;
    for (std::uint32_t m = 0; m < part.mip_count; ++m) {
        VkBufferImageCopy region = copy_region(source.desc, part.mip(m));
        region.bufferOffset = offset;
        offset += part_bytes(source.desc, part.mip(m));
        vkCmdCopyImageToBuffer(commands, source.image, image_layout(ResourceUse::copy_from), target,
                               1, &region);
    }
    std::swap(barrier.oldLayout, barrier.newLayout);
    if (moves) vkCmdPipelineBarrier2(commands, &dependency);
}

} // namespace

std::vector<std::byte> GraphRunner::read_back(FrameTicket ticket, ImageHandle image) {
    wait_for(ticket);
    const FrameSlot& slot = slot_of(ticket);
    CompiledGraph& shape = *slot.shape;
    const ImageDesc& desc = shape.outline.images()[image.id];
    const bool kept = shape.outlives_frames(image.id);
    check(!kept || ticket.frame == frame_, Failure::internal, "image '", desc.name, "' of frame ",
          ticket.frame, " is read after frame ", frame_,
          " was submitted, which may have changed it");
    check(!kept || shape.kept[image.id], Failure::internal, "image '", desc.name,
          "' is read after it was released");
    // A frame with `stays` does not advance the history, so its images do not count as the last
    // frame's yet.
    image.previous = kept && !slot.stays;
    const PhysicalImage& source = shape.physical_image(image, slot_index_of(ticket.frame));
    const std::uint64_t bytes = part_bytes(desc, image);
    gpu::Buffer target(device_, "read-back of " + desc.name, bytes, gpu::BufferUsage::read_back);
    device_.run_commands("read back image '" + desc.name + "'", [&](VkCommandBuffer commands) {
        record_copy(commands, source, image,
                    image_layout(kept ? ResourceUse::sampled : ResourceUse::copy_from),
                    target.handle());
    });
    std::vector<std::byte> data = target.read();
    data.resize(bytes);
    return data;
}

std::vector<std::byte> GraphRunner::read_back(FrameTicket ticket, BufferHandle buffer) {
    wait_for(ticket);
    const FrameSlot& slot = slot_of(ticket);
    const CompiledGraph& shape = *slot.shape;
    const auto& [name, bytes] = shape.outline.buffers()[buffer.id];
    const bool kept = shape.outlives_frames(buffer);
    check(!kept || ticket.frame == frame_, Failure::internal, "buffer '", name, "' of frame ",
          ticket.frame, " is read after frame ", frame_,
          " was submitted, which may have changed it");
    check(!kept || shape.kept_buffers[buffer.id], Failure::internal, "buffer '", name,
          "' is read after it was released");
    buffer.previous = kept && !slot.stays; // as for images
    const VkBuffer source = shape.vulkan_buffer(buffer, slot_index_of(ticket.frame));
    gpu::Buffer target(device_, "read-back of " + name, bytes, gpu::BufferUsage::read_back);
    device_.run_commands("read back buffer '" + name + "'", [&](VkCommandBuffer commands) {
        const VkBufferCopy region{0, 0, bytes};
        vkCmdCopyBuffer(commands, source, target.handle(), 1, &region);
    });
    std::vector<std::byte> data = target.read();
    data.resize(bytes);
    return data;
}

std::vector<std::byte> GraphRunner::read_history() {
    std::vector<std::byte> history;
    if (frame_ == 0) return history;
    const CompiledGraph& shape = *slot_of({frame_}).shape;
    for (std::uint32_t id = 0; id < shape.outline.images().size(); ++id) {
        if (!shape.outlives_frames(id) || shape.outline.image_lifetime(id) != Lifetime::previous)
            continue;
        const ImageDesc& desc = shape.outline.images()[id];
        const std::vector<std::byte> image = read_back(
            ImageHandle{.id = id, .layer_count = desc.layers, .mip_count = desc.mips});
        history.insert(history.end(), image.begin(), image.end());
    }
    for (std::uint32_t id = 0; id < shape.outline.buffers().size(); ++id) {
        if (!shape.outlives_frames(BufferHandle{id})) continue;
        const std::vector<std::byte> buffer = read_back(BufferHandle{id});
        history.insert(history.end(), buffer.begin(), buffer.end());
    }
    return history;
}

} // namespace catoptric::graph
