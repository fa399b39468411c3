#include "graph/graph_runner.hpp"

#include "core/stopwatch.hpp"
#include "graph/device_memory.hpp"
#include "graph/graph_shape.hpp"
#include "graph/timestamps.hpp"

#include <algorithm>
#include <array>
#include <chrono>

namespace catoptric::graph {

namespace {

constexpr std::size_t kMaxCachedGraphs = 8;

std::vector<std::string> pass_names(const CompiledGraph& shape) {
    std::vector<std::string> names;
    for (const PlannedPass& planned : shape.plan.passes)
        names.push_back(shape.outline.passes()[planned.pass].name);
    return names;
}

/// Fills passes and span from the timestamps of a frame that has ended.
void read_timestamps(gpu::Device& device, FrameSlot& slot, GraphFrameTimes& times) {
    const CompiledGraph& shape = *slot.shape;
    const VkResult result = slot.read_stamps();
    if (result != VK_SUCCESS)
        device.check_result(result, "read the time stamps of " + describe_frame(slot.frame, shape));
    std::vector<double> at = to_milliseconds(slot.stamps, device.timestamp_bits(),
                                             static_cast<double>(device.limits().timestampPeriod));
    if (!slot.piece_begins.empty()) at = remove_gaps(at, slot.piece_begins);
    for (std::size_t i = 0; i < shape.plan.passes.size(); ++i) {
        const bool isolated = slot.timing == PassTiming::isolated;
        times.passes.push_back({shape.outline.passes()[shape.plan.passes[i].pass].name,
                                isolated ? at[i] : at[2 * i],
                                isolated ? at[i + 1] : at[2 * i + 1]});
        times.span_ms = std::max(times.span_ms, times.passes.back().end_ms);
    }
}

} // namespace

GraphRunner::GraphRunner(gpu::Device& device, gpu::PipelineStore& pipelines,
                         std::uint32_t in_flight, RetainedResources* retained)
    : device_(device), recorder_(device, pipelines), pieces_(device),
      timeline_(make_timeline(device)), memory_(device),
      kept_(device, retained ? *retained : own_retained_) {
    check(in_flight >= 1 && in_flight <= kMaxFramesInFlight, Failure::usage,
          "frames in flight must be 1 to ", kMaxFramesInFlight, ", not ", in_flight);
    slots_.reserve(in_flight);
    for (std::uint32_t i = 0; i < in_flight; ++i) slots_.emplace_back(device);
}

GraphRunner::~GraphRunner() {
    if (device_.is_abandoned()) return;
    try {
        finish_frames();
    } catch (const std::exception&) {
        // The device counts as abandoned after a failed wait, so none of its objects is destroyed.
    }
}

void GraphRunner::release_retained() {
    finish_frames();
    for (FrameSlot& slot : slots_)
        if (slot.shape) slot.shape->release_retained();
}

void GraphRunner::discard_contents() {
    release_retained();
    kept_.release_all();
}

GraphLimits GraphRunner::limits() const {
    const VkPhysicalDeviceLimits& limits = device_.limits();
    return {limits.maxImageDimension2D,  limits.maxImageDimensionCube, limits.maxImageArrayLayers,
            limits.maxFramebufferLayers, device_.largest_heap_bytes(), device_.max_allocation()};
}

CompiledGraph& GraphRunner::compile(const Graph& graph) {
    const SteadyClock::time_point begin = SteadyClock::now();
    const std::uint64_t hash = hash_shape(graph);
    auto found = std::ranges::find_if(shapes_, [&](const std::shared_ptr<CompiledGraph>& shape) {
        return shape->hash == hash && same_declarations(graph, shape->outline);
    });
    if (found == shapes_.end()) {
        auto made = std::make_shared<CompiledGraph>();
        made->plan = plan_graph(graph, limits(), device_sizer(device_));
        made->outline = graph.copy_declarations();
        made->hash = hash;
        ++plan_count_;
        // Frames in flight share ownership of their planned graph, so removing the graph from this
        // list is safe.
        if (shapes_.size() == kMaxCachedGraphs) shapes_.pop_back();
        found = shapes_.insert(shapes_.end(), std::move(made));
    }
    std::rotate(shapes_.begin(), found, found + 1);
    compile_ms_ += ms_since(begin);
    return *shapes_.front();
}

FrameTicket GraphRunner::submit_frame(const Graph& graph, PassTiming timing, bool stays,
                                      const ExternalSemaphores& outside, bool counts_work) {
    has_dropped_contents_ = false;
    device_.check_not_abandoned();
    const double waited_before = wait_ms_;
    CompiledGraph& shape = compile(graph);
    const std::size_t index = slot_index_of(frame_ + 1);
    FrameSlot& slot = slots_[index];
    finish_frame(slot);
    slot.frame = 0; // the outputs of the slot's last frame may be replaced now
    slot.reset_commands();
    const SteadyClock::time_point begin = SteadyClock::now();
    const double waited_for_place = wait_ms_;
    const auto wait = [this] { finish_frames(); };
    memory_.ensure_resources(shape, index, shapes_, wait);
    kept_.find_or_create(shape,
                         [this](const PersistentImage* image, const PersistentBuffer* buffer) {
                             finish_frames();
                             for (FrameSlot& other : slots_) {
                                 if (!other.shape) continue;
                                 std::ranges::replace(other.shape->kept, image, nullptr);
                                 std::ranges::replace(other.shape->kept_buffers, buffer, nullptr);
                             }
                         });
    slot.reset(static_cast<std::uint32_t>(2 * shape.plan.passes.size() + 2));
    GraphFrameTimes times;
    times.compile_ms = compile_ms_ + ms_since(begin) - (wait_ms_ - waited_for_place);
    times.wait_ms = wait_ms_ - waited_before;
    compile_ms_ = 0;

    const SteadyClock::time_point record_begin = SteadyClock::now();
    slot.work = counts_work ? std::make_unique<WorkCounter>(device_, pass_names(shape)) : nullptr;
    record_frame(graph, shape, slot, index, timing, outside.wait);
    times.record_ms = ms_since(record_begin) - pieces_.wait_ms();
    times.wall_ms = pieces_.wait_ms(); // without the recording between pieces
    times.wait_ms += pieces_.wait_ms(), wait_ms_ += pieces_.wait_ms();
    slot.times = times;
    slot.timing = timing, slot.stays = stays;
    submit_frame(slot, shape, {pieces_.wait_semaphore(), outside.signal});
    slot.shape = shapes_.front();
    kept_.store_hashes(graph, shape);
    if (!stays) kept_.swap_copies(shape);
    return {frame_};
}

void GraphRunner::record_frame(const Graph& graph, CompiledGraph& shape, FrameSlot& slot,
                               std::size_t slot_index, PassTiming timing, VkSemaphore wait) {
    std::uint64_t rays = 0;
    for (const PlannedPass& planned : shape.plan.passes)
        rays += graph.passes()[planned.pass].most_rays;
    pieces_.begin_frame(slot, shape, frame_ + 1, wait, rays);
    try {
        recorder_.record_frame(graph, shape, slot, slot_index, timing, slot.work.get(), pieces_);
    } catch (...) {
        // The pieces before have changed images that outlive the frame, and their layouts.
        if (pieces_.submitted() > 0 && !device_.is_abandoned()) {
            has_dropped_contents_ = true;
            shape.release_retained();
            discard_contents();
        }
        throw;
    }
}

void GraphRunner::submit_frame(FrameSlot& slot, const CompiledGraph& shape,
                               const ExternalSemaphores& outside) {
    VkCommandBufferSubmitInfo commands{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
    commands.commandBuffer = slot.commands;
    const auto at = [](VkSemaphore semaphore, std::uint64_t value) {
        VkSemaphoreSubmitInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO};
        info.semaphore = semaphore;
        info.value = value;
        info.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        return info;
    };
    const VkSemaphoreSubmitInfo wait = at(outside.wait, 0);
    const std::array signals{at(timeline_, frame_ + 1), at(outside.signal, 0)};
    VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
    submit.commandBufferInfoCount = 1;
    submit.pCommandBufferInfos = &commands;
    submit.waitSemaphoreInfoCount = outside.wait ? 1 : 0;
    submit.pWaitSemaphoreInfos = &wait;
    submit.signalSemaphoreInfoCount = outside.signal ? 2 : 1;
    submit.pSignalSemaphoreInfos = signals.data();
    device_.submit_uploads();
    slot.submitted = SteadyClock::now();
    const VkResult result = vkQueueSubmit2(device_.queue(), 1, &submit, VK_NULL_HANDLE);
    if (result != VK_SUCCESS)
        device_.check_result(result, "run " + describe_frame(frame_ + 1, shape));
    slot.frame = ++frame_;
    slot.ended = false;
}

/// Waits for the end of the slot's frame, unless the host has waited for this frame before.
void GraphRunner::finish_frame(FrameSlot& slot) {
    if (slot.ended) return;
    const SteadyClock::time_point begin = SteadyClock::now();
    const VkSemaphore semaphore = timeline_;
    VkSemaphoreWaitInfo wait{VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO};
    wait.semaphoreCount = 1;
    wait.pSemaphores = &semaphore;
    wait.pValues = &slot.frame;
    const VkResult result = vkWaitSemaphores(device_.handle(), &wait, ~std::uint64_t{0});
    if (result != VK_SUCCESS)
        device_.check_wait(result, "run " + describe_frame(slot.frame, *slot.shape));
    const double waited = ms_since(begin);
    const double ran = ms_since(slot.submitted);
    slot.times.wall_ms += ran;
    pieces_.note_submission_ms(ran);
    slot.times.wait_ms += waited;
    wait_ms_ += waited;
    slot.ended = true;
    read_timestamps(device_, slot, slot.times);
}

void GraphRunner::finish_frames() {
    for (FrameSlot& slot : slots_) finish_frame(slot);
}

FrameSlot& GraphRunner::slot_of(FrameTicket ticket) {
    check(ticket.frame >= 1 && ticket.frame <= frame_, Failure::internal, "frame ", ticket.frame,
          " is asked for, but ", frame_, " were submitted");
    FrameSlot& slot = slots_[slot_index_of(ticket.frame)];
    check(slot.frame == ticket.frame, Failure::internal, "frame ", ticket.frame,
          " is gone: its place was taken by ",
          slot.frame ? "frame " + std::to_string(slot.frame) : "a frame that failed", ", with ",
          slots_.size(), " in flight");
    return slot;
}

bool GraphRunner::has_ended(FrameTicket ticket) {
    const FrameSlot& slot = slots_[slot_index_of(ticket.frame)];
    if (slot.frame != ticket.frame || slot.ended)
        return true; // a later frame has the slot, or the frame was waited for
    const VkSemaphore semaphore = timeline_;
    VkSemaphoreWaitInfo wait{VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO};
    wait.semaphoreCount = 1;
    wait.pSemaphores = &semaphore;
    wait.pValues = &ticket.frame;
    const VkResult result = vkWaitSemaphores(device_.handle(), &wait, 0);
    if (result != VK_SUCCESS && result != VK_TIMEOUT)
        device_.check_wait(result, "run " + describe_frame(slot.frame, *slot.shape));
    return result == VK_SUCCESS;
}

std::vector<PassWork> GraphRunner::work_counts(FrameTicket ticket) {
    FrameSlot& slot = slot_of(ticket);
    finish_frame(slot);
    return slot.work ? slot.work->read() : std::vector<PassWork>();
}

const GraphFrameTimes& GraphRunner::wait_for(FrameTicket ticket) {
    FrameSlot& slot = slot_of(ticket);
    finish_frame(slot);
    return slot.times;
}

} // namespace catoptric::graph
