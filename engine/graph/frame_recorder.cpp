#include "graph/frame_recorder.hpp"

#include "graph/sync.hpp"

#include <algorithm>
#include <cstring>

namespace catoptric::graph {

namespace {

gpu::UniqueSampler make_sampler(const gpu::Device& device, TextureFilter filter) {
    VkSamplerCreateInfo create{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    create.magFilter = create.minFilter = filter == TextureFilter::nearest ? VK_FILTER_NEAREST
                                                                           : VK_FILTER_LINEAR;
    create.addressModeU = create.addressModeV = create.addressModeW =
        VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    if (filter == TextureFilter::mipmapped) {
        create.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
        create.maxLod = VK_LOD_CLAMP_NONE;
    }
    create.compareEnable = filter == TextureFilter::compare;
    // Depth is reversed: a fragment passes the test unless it lies behind the stored depth.
    create.compareOp = VK_COMPARE_OP_GREATER_OR_EQUAL;
    VkSampler sampler = VK_NULL_HANDLE;
    gpu::check_vk(vkCreateSampler(device.handle(), &create, nullptr, &sampler), "create a sampler");
    return {device.handle(), sampler};
}

std::string describe_image(const ImageDesc& desc) {
    return std::string(format_name(desc.format)) + " " + std::to_string(desc.width) + "x" +
           std::to_string(desc.height) + " with " + std::to_string(desc.layers) + " layer(s) and " +
           std::to_string(desc.mips) + " mip(s)";
}

VkExtent2D framebuffer_extent(const Graph& graph, const Pass& pass) {
    const ImageHandle& image = std::ranges::find_if(pass.images, [](const ImageUse& use) {
                                   return use.use == ResourceUse::colour ||
                                          use.use == ResourceUse::depth;
                               })->image;
    const ImageDesc& desc = graph.images()[image.id];
    return {mip_size(desc.width, image.first_mip), mip_size(desc.height, image.first_mip)};
}

VkRect2D pass_area(const Pass& pass, VkExtent2D extent) {
    if (!pass.area) return {{0, 0}, extent};
    const auto& [x, y, width, height] = *pass.area;
    return {{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)}, {width, height}};
}

struct BarrierScopes {
    gpu::AccessScope before, after;
};

BarrierScopes make_barrier_scopes(const PlannedBarrier& barrier, bool last) {
    BarrierScopes sides{sync_scope(barrier.before), sync_scope(barrier.after)};
    for (const AccessState& touch : barrier.shared) {
        const gpu::AccessScope scope = sync_scope(touch);
        sides.before.stages |= scope.stages, sides.before.access |= scope.access;
    }
    if (last) sides.after = {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT};
    if (last && barrier.is_buffer) { // an imported buffer may lie in the host's memory
        sides.after.stages |= VK_PIPELINE_STAGE_2_HOST_BIT;
        sides.after.access |= VK_ACCESS_2_HOST_READ_BIT;
    }
    // The first access of a frame has no earlier access to wait for. With equal stages on both
    // sides, it waits for the barrier that separates this frame from the last.
    if (sides.before.stages == VK_PIPELINE_STAGE_2_NONE) sides.before = sides.after;
    return sides;
}

template <typename VulkanBarrier>
void set_scopes(VulkanBarrier& barrier, const BarrierScopes& sides) {
    barrier.srcStageMask = sides.before.stages, barrier.srcAccessMask = sides.before.access;
    barrier.dstStageMask = sides.after.stages, barrier.dstAccessMask = sides.after.access;
}

/// Returns the bytes of an attachment that a pass loads or clears before it draws, plus those that
/// it stores.
std::uint64_t attachment_bytes(const VkRenderingAttachmentInfo& attachment, TexelFormat format,
                               const VkRenderingInfo& rendering) {
    const VkExtent2D extent = rendering.renderArea.extent;
    const std::uint64_t once = std::uint64_t{extent.width} * extent.height * rendering.layerCount *
                               bytes_per_texel(format);
    return once * (attachment.storeOp == VK_ATTACHMENT_STORE_OP_STORE ? 2 : 1);
}

} // namespace

FrameRecorder::FrameRecorder(gpu::Device& device, gpu::PipelineStore& pipelines)
    : device_(device), pipelines_(pipelines) {
    for (TextureFilter filter : {TextureFilter::nearest, TextureFilter::linear,
                                 TextureFilter::compare, TextureFilter::mipmapped})
        samplers_[static_cast<std::size_t>(filter)] = make_sampler(device, filter);
    if (!device.has_debug_labels()) return;
    begin_label_ = reinterpret_cast<PFN_vkCmdBeginDebugUtilsLabelEXT>(
        vkGetDeviceProcAddr(device.handle(), "vkCmdBeginDebugUtilsLabelEXT"));
    end_label_ = reinterpret_cast<PFN_vkCmdEndDebugUtilsLabelEXT>(
        vkGetDeviceProcAddr(device.handle(), "vkCmdEndDebugUtilsLabelEXT"));
}

void FrameRecorder::record_frame(const Graph& graph, CompiledGraph& shape, FrameSlot& slot,
                                 std::size_t slot_index, PassTiming timing, WorkCounter* work,
                                 FramePieces& pieces) {
    graph_ = &graph, shape_ = &shape, slot_ = &slot, slot_index_ = slot_index, work_ = work;
    commands_ = slot.commands, pieces_ = &pieces, timing_ = timing;
    begin_commands();
    if (timing == PassTiming::isolated) write_timestamp(timing);
    for (const PlannedPass& planned : shape.plan.passes) {
        if (timing == PassTiming::pipelined) write_timestamp(timing);
        record_barriers(planned.barriers, false);
        record_pass(planned);
        write_timestamp(timing);
        pieces.end_pass(graph.passes()[planned.pass].most_rays);
    }
    record_barriers(shape.plan.last, true);
    gpu::check_vk(vkEndCommandBuffer(commands_), "end a command buffer");
}

void FrameRecorder::begin_commands() {
    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    gpu::check_vk(vkBeginCommandBuffer(commands_, &begin), "begin a command buffer");
    record_full_barrier();
}

void FrameRecorder::run_piece() {
    if (work_) work_->pause_pass(commands_);
    if (end_label_) end_label_(commands_);
    write_timestamp(timing_);
    record_full_barrier();
    gpu::check_vk(vkEndCommandBuffer(commands_), "end a command buffer");
    pieces_->submit_and_wait();
    begin_commands();
    write_timestamp(timing_);
    begin_label(*pass_in_pieces_);
    if (work_) work_->resume_pass(commands_);
}

std::uint32_t FrameRecorder::read_word(BufferHandle buffer, std::uint64_t offset) {
    run_piece();
    const std::string name = "word of buffer '" + graph_->buffers()[buffer.id].name + "'";
    const gpu::Buffer target(device_, name, sizeof(std::uint32_t), gpu::BufferUsage::read_back);
    device_.run_commands("read a " + name, [&](VkCommandBuffer commands) {
        const VkBufferCopy region{offset, 0, sizeof(std::uint32_t)};
        vkCmdCopyBuffer(commands, vulkan_buffer(buffer), target.handle(), 1, &region);
    });
    std::uint32_t word = 0;
    std::memcpy(&word, target.read().data(), sizeof word);
    return word;
}

/// Records a barrier that completes all earlier work and makes it visible to all later work. It
/// separates frames and read-backs.
void FrameRecorder::record_full_barrier() {
    gpu::memory_barrier(commands_,
                        {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT},
                        {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                         VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT});
}

/// Writes a timestamp. It is exact only if an execution barrier follows: without one, a software
/// driver takes it after the next pass's work.
void FrameRecorder::write_timestamp(PassTiming timing) {
    vkCmdWriteTimestamp2(commands_, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, slot_->queries,
                         slot_->next_query++);
    if (timing == PassTiming::isolated)
        vkCmdPipelineBarrier(commands_, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                             VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0, nullptr, 0,
                             nullptr);
}

void FrameRecorder::add_barrier(const PlannedBarrier& barrier, bool last) {
    const BarrierScopes sides = make_barrier_scopes(barrier, last);
    if (barrier.is_buffer) {
        VkBufferMemoryBarrier2 b{VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER_2};
        set_scopes(b, sides);
        b.buffer = vulkan_buffer({barrier.id, barrier.previous});
        b.size = VK_WHOLE_SIZE;
        buffer_barriers_.push_back(b);
        return;
    }
    VkImageMemoryBarrier2 b{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    set_scopes(b, sides);
    b.oldLayout = barrier.before.nothing ? VK_IMAGE_LAYOUT_UNDEFINED
                                         : image_layout(barrier.before.use);
    b.newLayout = image_layout(barrier.after.use);
    b.image = physical_image({.id = barrier.id, .previous = barrier.previous}).image;
    b.subresourceRange = {image_aspect(graph_->images()[barrier.id].format), barrier.first_mip,
                          barrier.mip_count, barrier.first_layer, barrier.layer_count};
    image_barriers_.push_back(b);
}

void FrameRecorder::record_barriers(const std::vector<PlannedBarrier>& list, bool last) {
    if (list.empty()) return;
    image_barriers_.clear(), buffer_barriers_.clear();
    for (const PlannedBarrier& barrier : list) add_barrier(barrier, last);
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.imageMemoryBarrierCount = static_cast<std::uint32_t>(image_barriers_.size());
    dependency.pImageMemoryBarriers = image_barriers_.data();
    dependency.bufferMemoryBarrierCount = static_cast<std::uint32_t>(buffer_barriers_.size());
    dependency.pBufferMemoryBarriers = buffer_barriers_.data();
    vkCmdPipelineBarrier2(commands_, &dependency);
}

void FrameRecorder::begin_label(const Pass& pass) {
    if (!begin_label_) return;
    VkDebugUtilsLabelEXT label{VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT};
    label.pLabelName = pass.name.c_str();
    begin_label_(commands_, &label);
}

void FrameRecorder::record_pass(const PlannedPass& planned) {
    const Pass& pass = graph_->passes()[planned.pass];
    begin_label(pass);
    if (work_) work_->begin_pass(commands_);
    if (!pass.is_raster()) {
        pass_in_pieces_ = &pass;
        PassCommands commands(*this, *graph_, pass, commands_, 0, 1);
        pass.body(commands);
    } else if (pass.layer_count == 1 || device_.supports_layers()) {
        record_raster_pass(planned, 0, pass.layer_count);
    } else {
        for (std::uint32_t layer = 0; layer < pass.layer_count; ++layer)
            record_raster_pass(planned, layer, 1);
    }
    if (work_) work_->end_pass(commands_);
    if (end_label_) end_label_(commands_);
}

PhysicalImage& FrameRecorder::physical_image(ImageHandle image) {
    if (graph_->image_lifetime(image.id) != Lifetime::imported)
        return shape_->physical_image(image, slot_index_);
    PhysicalImage* const outside = graph_->imported(image.id);
    const ImageDesc& wanted = graph_->images()[image.id];
    check(outside, Failure::internal, "image '", wanted.name, "' is imported from nowhere");
    const ImageDesc& found = outside->desc;
    const bool fits = found.format == wanted.format && found.width == wanted.width &&
                      found.height == wanted.height && found.layers == wanted.layers &&
                      found.mips == wanted.mips;
    if (!fits)
        fail(Failure::internal, "image '", wanted.name, "' is imported as ", describe_image(wanted),
             ", found ", describe_image(found));
    return *outside;
}

VkBuffer FrameRecorder::vulkan_buffer(BufferHandle buffer) const {
    if (!graph_->is_imported(buffer)) return shape_->vulkan_buffer(buffer, slot_index_);
    const gpu::Buffer* const outside = graph_->imported(buffer);
    check(outside, Failure::internal, "buffer '", graph_->buffers()[buffer.id].name,
          "' is imported from nowhere");
    return outside->handle();
}

void FrameRecorder::add_attachment(const ImageUse& use, bool unread, std::uint32_t first_layer,
                                   std::uint32_t layer_count) {
    const gpu::ImageViewType shape = layer_count > 1 ? gpu::ImageViewType::flat_array
                                                     : gpu::ImageViewType::flat;
    VkRenderingAttachmentInfo info{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    info.imageView = physical_image(use.image).view(device_, shape,
                                                    use.image.layers(first_layer, layer_count));
    info.imageLayout = image_layout(use.use);
    info.loadOp = use.clear ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD;
    info.storeOp = !use.write ? VK_ATTACHMENT_STORE_OP_NONE
                   : unread   ? VK_ATTACHMENT_STORE_OP_DONT_CARE
                              : VK_ATTACHMENT_STORE_OP_STORE;
    if (use.clear && use.use == ResourceUse::colour)
        std::ranges::copy(*use.clear, info.clearValue.color.float32);
    if (use.clear && use.use == ResourceUse::depth)
        info.clearValue.depthStencil = {(*use.clear)[0], 0};
    if (use.use == ResourceUse::colour)
        colours_.push_back(info);
    else
        depth_ = info;
}

void FrameRecorder::count_traffic(const Pass& pass, const VkRenderingInfo& rendering) {
    std::size_t colour = 0;
    for (const ImageUse& use : pass.images) {
        if (use.use != ResourceUse::colour && use.use != ResourceUse::depth) continue;
        const VkRenderingAttachmentInfo& attachment = use.use == ResourceUse::depth
                                                          ? depth_
                                                          : colours_[colour++];
        work_->add(WorkKind::bytes,
                   attachment_bytes(attachment, graph_->images()[use.image.id].format, rendering));
    }
}

/// Records one rendering scope over some layers of the pass's attachments.
void FrameRecorder::record_raster_pass(const PlannedPass& planned, std::uint32_t first_layer,
                                       std::uint32_t layer_count) {
    const Pass& pass = graph_->passes()[planned.pass];
    colours_.clear();
    depth_ = {};
    for (std::size_t i = 0; i < pass.images.size(); ++i)
        if (pass.images[i].use == ResourceUse::colour || pass.images[i].use == ResourceUse::depth)
            add_attachment(pass.images[i], i < 32 && (planned.unread >> i & 1), first_layer,
                           layer_count);
    const VkExtent2D extent = framebuffer_extent(*graph_, pass);
    VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
    rendering.renderArea = pass_area(pass, extent);
    rendering.layerCount = layer_count;
    rendering.colorAttachmentCount = static_cast<std::uint32_t>(colours_.size());
    rendering.pColorAttachments = colours_.data();
    rendering.pDepthAttachment = depth_.imageView ? &depth_ : nullptr;
    if (work_) count_traffic(pass, rendering);
    vkCmdBeginRendering(commands_, &rendering);
    const VkViewport viewport{
        0, 0, static_cast<float>(extent.width), static_cast<float>(extent.height), 0, 1};
    vkCmdSetViewport(commands_, 0, 1, &viewport);
    vkCmdSetScissor(commands_, 0, 1, &rendering.renderArea);
    PassCommands commands(*this, *graph_, pass, commands_, first_layer, layer_count);
    pass.body(commands);
    vkCmdEndRendering(commands_);
}

} // namespace catoptric::graph
