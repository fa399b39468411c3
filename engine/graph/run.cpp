#include "graph/run.hpp"

#include "graph/stamps.hpp"
#include "graph/sync.hpp"

#include <algorithm>
#include <chrono>

namespace catoptric::graph {

namespace {

using Clock = std::chrono::steady_clock;

double milliseconds(Clock::duration duration) {
    return std::chrono::duration<double, std::milli>(duration).count();
}

gpu::UniqueSampler make_sampler(const gpu::Device& device, Filter filter) {
    VkSamplerCreateInfo create{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    create.magFilter = create.minFilter = filter == Filter::nearest ? VK_FILTER_NEAREST
                                                                    : VK_FILTER_LINEAR;
    create.addressModeU = create.addressModeV = create.addressModeW =
        VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    create.compareEnable = filter == Filter::compare;
    create.compareOp = VK_COMPARE_OP_GREATER_OR_EQUAL; // reversed depth: not behind what is stored
    VkSampler sampler = VK_NULL_HANDLE;
    gpu::check_vk(vkCreateSampler(device.handle(), &create, nullptr, &sampler), "create a sampler");
    return {device.handle(), sampler};
}

VkCommandBuffer make_commands(const gpu::Device& device, gpu::UniqueCommandPool& pool) {
    VkCommandPoolCreateInfo create{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    create.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    create.queueFamilyIndex = device.queue_family();
    VkCommandPool handle = VK_NULL_HANDLE;
    gpu::check_vk(vkCreateCommandPool(device.handle(), &create, nullptr, &handle),
                  "create a command pool");
    pool = {device.handle(), handle};
    VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    allocate.commandPool = handle;
    allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    allocate.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    gpu::check_vk(vkAllocateCommandBuffers(device.handle(), &allocate, &commands),
                  "allocate a command buffer");
    return commands;
}

gpu::UniqueSemaphore make_timeline(const gpu::Device& device) {
    VkSemaphoreTypeCreateInfo type{VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO};
    type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
    const VkSemaphoreCreateInfo create{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, &type, 0};
    VkSemaphore semaphore = VK_NULL_HANDLE;
    gpu::check_vk(vkCreateSemaphore(device.handle(), &create, nullptr, &semaphore),
                  "create a semaphore");
    return {device.handle(), semaphore};
}

VkExtent2D extent_of(const Graph& graph, const Pass& pass) {
    const ImageDesc& desc =
        graph.images()[std::ranges::find_if(pass.images, [](const ImageUse& use) {
                           return use.use == Use::colour || use.use == Use::depth;
                       })->image.id];
    return {desc.width, desc.height};
}

} // namespace

Runner::Runner(gpu::Device& device, gpu::Pipelines& pipelines)
    : device_(device), pipelines_(pipelines) {
    for (Filter filter : {Filter::nearest, Filter::linear, Filter::compare})
        samplers_[static_cast<std::size_t>(filter)] = make_sampler(device, filter);
    commands_ = make_commands(device, pool_);
    timeline_ = make_timeline(device);
    if (!device.has_labels()) return;
    begin_label_ = reinterpret_cast<PFN_vkCmdBeginDebugUtilsLabelEXT>(
        vkGetDeviceProcAddr(device.handle(), "vkCmdBeginDebugUtilsLabelEXT"));
    end_label_ = reinterpret_cast<PFN_vkCmdEndDebugUtilsLabelEXT>(
        vkGetDeviceProcAddr(device.handle(), "vkCmdEndDebugUtilsLabelEXT"));
}

FrameTimes Runner::run(const Graph& graph, const Plan& plan, Timing timing, bool stays) {
    device_.check_usable();
    prepare(graph, plan);
    const auto start = Clock::now();
    record(graph, plan, timing);
    const double record_ms = milliseconds(Clock::now() - start);
    const double wall_ms = submit_and_wait(graph, plan);
    FrameTimes times = read_times(graph, plan, timing);
    times.record_ms = record_ms;
    times.wall_ms = wall_ms;
    if (stays) return times;
    for (const std::uint32_t id : kept_ids_) {
        Kept& kept = kept_.at(graph.images()[id].name);
        kept.last = 1 - kept.last;
        kept.valid = true;
    }
    return times;
}

void Runner::record(const Graph& graph, const Plan& plan, Timing timing) {
    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    gpu::check_vk(vkBeginCommandBuffer(commands_, &begin), "begin a command buffer");
    next_query_ = 0;
    full_barrier();
    if (timing == Timing::isolated) stamp(timing);
    for (const PlannedPass& planned : plan.passes) {
        const Pass& pass = graph.passes()[planned.pass];
        if (timing == Timing::pipelined) stamp(timing);
        barriers(graph, plan, planned.barriers, false);
        record_pass(graph, pass);
        stamp(timing);
    }
    barriers(graph, plan, plan.last, true);
    gpu::check_vk(vkEndCommandBuffer(commands_), "end a command buffer");
}

/// Everything before is done and visible to everything after: divides frames and read-backs.
void Runner::full_barrier() {
    VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    barrier.srcStageMask = barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands_, &dependency);
}

/// A stamp is only true when an execution barrier follows it: without, a software driver takes it
/// after the next pass's work.
void Runner::stamp(Timing timing) {
    vkCmdWriteTimestamp2(commands_, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_, next_query_++);
    if (timing == Timing::isolated)
        vkCmdPipelineBarrier(commands_, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                             VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0, nullptr, 0,
                             nullptr);
}

void Runner::barriers(const Graph& graph, const Plan&, const std::vector<Barrier>& list,
                      bool last) {
    std::vector<VkImageMemoryBarrier2> images;
    std::vector<VkBufferMemoryBarrier2> buffers;
    for (const Barrier& barrier : list) {
        Scope before = scope_of(barrier.before);
        for (const Touch& touch : barrier.shared) {
            const Scope scope = scope_of(touch);
            before.stages |= scope.stages, before.access |= scope.access;
        }
        Scope after = scope_of(barrier.after);
        if (last) after = {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT};
        // First touch of the frame: chains on to the barrier that divides it from the frame before.
        if (before.stages == VK_PIPELINE_STAGE_2_NONE) before.stages = after.stages;
        if (barrier.is_buffer) {
            VkBufferMemoryBarrier2 b{VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER_2};
            b.srcStageMask = before.stages, b.srcAccessMask = before.access;
            b.dstStageMask = after.stages, b.dstAccessMask = after.access;
            b.buffer = buffers_[barrier.id];
            b.size = VK_WHOLE_SIZE;
            buffers.push_back(b);
            continue;
        }
        VkImageMemoryBarrier2 b{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
        b.srcStageMask = before.stages, b.srcAccessMask = before.access;
        b.dstStageMask = after.stages, b.dstAccessMask = after.access;
        b.oldLayout = barrier.before.nothing ? VK_IMAGE_LAYOUT_UNDEFINED
                                             : layout_of(barrier.before.use);
        b.newLayout = layout_of(barrier.after.use);
        b.image = physical({barrier.id, 0, 0, barrier.previous}).image;
        b.subresourceRange = {aspect_of(graph.images()[barrier.id].format), 0, 1,
                              barrier.first_layer, barrier.layer_count};
        images.push_back(b);
    }
    if (images.empty() && buffers.empty()) return;
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.imageMemoryBarrierCount = static_cast<std::uint32_t>(images.size());
    dependency.pImageMemoryBarriers = images.data();
    dependency.bufferMemoryBarrierCount = static_cast<std::uint32_t>(buffers.size());
    dependency.pBufferMemoryBarriers = buffers.data();
    vkCmdPipelineBarrier2(commands_, &dependency);
}

void Runner::record_pass(const Graph& graph, const Pass& pass) {
    if (begin_label_) {
        VkDebugUtilsLabelEXT label{VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT};
        label.pLabelName = pass.name.c_str();
        begin_label_(commands_, &label);
    }
    if (!pass.is_raster()) {
        Commands commands(*this, graph, pass, commands_, 0, 1);
        pass.body(commands);
    } else if (pass.layer_count == 1 || device_.layered()) {
        render(graph, pass, 0, pass.layer_count);
    } else {
        for (std::uint32_t layer = 0; layer < pass.layer_count; ++layer)
            render(graph, pass, layer, 1);
    }
    if (end_label_) end_label_(commands_);
}

/// One rendering scope over some layers of the pass's attachments.
void Runner::render(const Graph& graph, const Pass& pass, std::uint32_t first_layer,
                    std::uint32_t layer_count) {
    std::vector<VkRenderingAttachmentInfo> colours;
    VkRenderingAttachmentInfo depth{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    bool has_depth = false;
    const gpu::ImageShape shape = layer_count > 1 ? gpu::ImageShape::flat_array
                                                  : gpu::ImageShape::flat;
    for (const ImageUse& use : pass.images) {
        if (use.use != Use::colour && use.use != Use::depth) continue;
        VkRenderingAttachmentInfo info{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
        info.imageView = physical(use.image).view(device_, shape,
                                                  use.image.first_layer + first_layer, layer_count);
        info.imageLayout = layout_of(use.use);
        info.loadOp = use.clear ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD;
        info.storeOp = use.write ? VK_ATTACHMENT_STORE_OP_STORE : VK_ATTACHMENT_STORE_OP_NONE;
        if (use.clear && use.use == Use::colour)
            std::ranges::copy(*use.clear, info.clearValue.color.float32);
        if (use.clear && use.use == Use::depth) info.clearValue.depthStencil = {(*use.clear)[0], 0};
        if (use.use == Use::colour)
            colours.push_back(info);
        else
            depth = info, has_depth = true;
    }
    const VkExtent2D extent = extent_of(graph, pass);
    VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
    rendering.renderArea = {{0, 0}, extent};
    rendering.layerCount = layer_count;
    rendering.colorAttachmentCount = static_cast<std::uint32_t>(colours.size());
    rendering.pColorAttachments = colours.data();
    rendering.pDepthAttachment = has_depth ? &depth : nullptr;
    vkCmdBeginRendering(commands_, &rendering);
    const VkViewport viewport{
        0, 0, static_cast<float>(extent.width), static_cast<float>(extent.height), 0, 1};
    const VkRect2D scissor{{0, 0}, extent};
    vkCmdSetViewport(commands_, 0, 1, &viewport);
    vkCmdSetScissor(commands_, 0, 1, &scissor);
    Commands commands(*this, graph, pass, commands_, first_layer, layer_count);
    pass.body(commands);
    vkCmdEndRendering(commands_);
}

/// The number of the frame and its passes: which of them a device was lost in, nobody knows.
std::string Runner::name_of_frame(const Graph& graph, const Plan& plan) const {
    std::string name = "frame " + std::to_string(frame_) + " (passes";
    for (const PlannedPass& planned : plan.passes)
        name += " '" + graph.passes()[planned.pass].name + "'";
    return name + ")";
}

double Runner::submit_and_wait(const Graph& graph, const Plan& plan) {
    VkCommandBufferSubmitInfo commands{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
    commands.commandBuffer = commands_;
    VkSemaphoreSubmitInfo signal{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO};
    signal.semaphore = timeline_;
    signal.value = ++frame_;
    signal.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
    submit.commandBufferInfoCount = 1;
    submit.pCommandBufferInfos = &commands;
    submit.signalSemaphoreInfoCount = 1;
    submit.pSignalSemaphoreInfos = &signal;
    const std::string doing = "run " + name_of_frame(graph, plan);

    const auto start = Clock::now();
    device_.check_alive(vkQueueSubmit2(device_.queue(), 1, &submit, VK_NULL_HANDLE), doing);
    const VkSemaphore semaphore = timeline_;
    VkSemaphoreWaitInfo wait{VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO};
    wait.semaphoreCount = 1;
    wait.pSemaphores = &semaphore;
    wait.pValues = &frame_;
    device_.check_waited(vkWaitSemaphores(device_.handle(), &wait, ~std::uint64_t{0}), doing);
    return milliseconds(Clock::now() - start);
}

FrameTimes Runner::read_times(const Graph& graph, const Plan& plan, Timing timing) const {
    std::vector<std::uint64_t> stamps(next_query_);
    device_.check_alive(vkGetQueryPoolResults(device_.handle(), queries_, 0, next_query_,
                                              stamps.size() * 8, stamps.data(), 8,
                                              VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
                        "read the time stamps of " + name_of_frame(graph, plan));
    const std::vector<double> at = milliseconds_since_first(
        stamps, device_.timestamp_bits(), static_cast<double>(device_.limits().timestampPeriod));
    FrameTimes times;
    for (std::size_t i = 0; i < plan.passes.size(); ++i) {
        const bool isolated = timing == Timing::isolated;
        times.passes.push_back({graph.passes()[plan.passes[i].pass].name,
                                isolated ? at[i] : at[2 * i],
                                isolated ? at[i + 1] : at[2 * i + 1]});
        times.span_ms = std::max(times.span_ms, times.passes.back().end_ms);
    }
    return times;
}

} // namespace catoptric::graph
