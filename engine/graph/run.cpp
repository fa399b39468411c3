#include "graph/run.hpp"

#include "core/stopwatch.hpp"
#include "graph/device_memory.hpp"
#include "graph/shape.hpp"
#include "graph/stamps.hpp"

#include <algorithm>
#include <array>
#include <chrono>

namespace catoptric::graph {

namespace {

constexpr std::size_t kShapes = 8;

double milliseconds_since(SteadyClock::time_point begin) {
    return std::chrono::duration<double, std::milli>(SteadyClock::now() - begin).count();
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

/// Returns the number of the frame and the names of all its passes. A lost device does not tell
/// which pass was running.
std::string name_of_frame(std::uint64_t frame, const CompiledGraph& shape) {
    std::string name = "frame " + std::to_string(frame) + " (passes";
    for (const PlannedPass& planned : shape.plan.passes)
        name += " '" + shape.outline.passes()[planned.pass].name + "'";
    return name + ")";
}

/// Fills passes and span from the timestamps of a frame that has ended.
void read_stamps(gpu::Device& device, const Slot& slot, GraphFrameTimes& times) {
    const CompiledGraph& shape = *slot.shape;
    std::vector<std::uint64_t> stamps(slot.next_query);
    const VkResult result = vkGetQueryPoolResults(
        device.handle(), slot.queries, 0, slot.next_query, stamps.size() * 8, stamps.data(), 8,
        VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);
    if (result != VK_SUCCESS)
        device.check_alive(result, "read the time stamps of " + name_of_frame(slot.frame, shape));
    const std::vector<double> at = milliseconds_since_first(
        stamps, device.timestamp_bits(), static_cast<double>(device.limits().timestampPeriod));
    for (std::size_t i = 0; i < shape.plan.passes.size(); ++i) {
        const bool isolated = slot.timing == PassTiming::isolated;
        times.passes.push_back({shape.outline.passes()[shape.plan.passes[i].pass].name,
                                isolated ? at[i] : at[2 * i],
                                isolated ? at[i + 1] : at[2 * i + 1]});
        times.span_ms = std::max(times.span_ms, times.passes.back().end_ms);
    }
}

} // namespace

Runner::Runner(gpu::Device& device, gpu::Pipelines& pipelines, std::uint32_t in_flight)
    : device_(device), recorder_(device, pipelines), timeline_(make_timeline(device)),
      memory_(device), kept_(device) {
    check(in_flight >= 1 && in_flight <= kMostInFlight, Failure::usage,
          "frames in flight must be 1 to ", kMostInFlight, ", not ", in_flight);
    slots_.reserve(in_flight);
    for (std::uint32_t i = 0; i < in_flight; ++i) slots_.emplace_back(device);
}

Runner::~Runner() {
    if (device_.abandoned()) return;
    try {
        finish_all();
    } catch (const std::exception&) {
        // The device is abandoned now, so none of its objects is destroyed.
    }
}

/// Waits for all frames, and removes the references of ended frames to images that outlive frames.
void Runner::release_persistent() {
    finish_all();
    for (Slot& slot : slots_)
        if (slot.shape) slot.shape->kept.assign(slot.shape->kept.size(), nullptr);
}

void Runner::forget() {
    release_persistent();
    kept_.forget();
}

RetainedImages Runner::suspend() {
    release_persistent();
    return kept_.take();
}

void Runner::resume(RetainedImages leavings) {
    release_persistent();
    kept_.put(std::move(leavings));
}

GraphLimits Runner::limits() const {
    const VkPhysicalDeviceLimits& limits = device_.limits();
    return {limits.maxImageDimension2D,  limits.maxImageDimensionCube, limits.maxImageArrayLayers,
            limits.maxFramebufferLayers, device_.memory_budget(),      device_.max_allocation()};
}

CompiledGraph& Runner::compile(const Graph& graph) {
    const SteadyClock::time_point begin = SteadyClock::now();
    const std::uint64_t hash = shape_hash(graph);
    auto found = std::ranges::find_if(shapes_, [&](const std::shared_ptr<CompiledGraph>& shape) {
        return shape->hash == hash && has_shape(graph, shape->outline);
    });
    if (found == shapes_.end()) {
        auto made = std::make_shared<CompiledGraph>();
        made->plan = plan(graph, limits(), sizer_of(device_));
        made->outline = graph.without_bodies();
        made->hash = hash;
        ++plans_made_;
        // Frames in flight share ownership of their shape, so removing it here is safe.
        if (shapes_.size() == kShapes) shapes_.pop_back();
        found = shapes_.insert(shapes_.end(), std::move(made));
    }
    std::rotate(shapes_.begin(), found, found + 1);
    compile_ms_ += milliseconds_since(begin);
    return *shapes_.front();
}

Ticket Runner::submit(const Graph& graph, PassTiming timing, bool stays,
                      const ExternalSync& outside) {
    device_.check_usable();
    const double waited_before = wait_ms_;
    CompiledGraph& shape = compile(graph);
    const std::size_t index = index_of(frame_ + 1);
    Slot& slot = slots_[index];
    finish(slot);
    const SteadyClock::time_point begin = SteadyClock::now();
    const double waited_for_place = wait_ms_;
    const auto wait = [this] { finish_all(); };
    memory_.provide(shape, index, shapes_, wait);
    kept_.provide(shape, wait);
    slot.reset(static_cast<std::uint32_t>(2 * shape.plan.passes.size() + 2));
    GraphFrameTimes times;
    times.compile_ms = compile_ms_ + milliseconds_since(begin) - (wait_ms_ - waited_for_place);
    times.wait_ms = wait_ms_ - waited_before;
    compile_ms_ = 0;

    const SteadyClock::time_point record_begin = SteadyClock::now();
    recorder_.record(graph, shape, slot, index, timing);
    times.record_ms = milliseconds_since(record_begin);
    slot.times = times;
    slot.timing = timing, slot.stays = stays;
    submit(slot, shape, outside);
    slot.shape = shapes_.front();
    kept_.write(graph, shape);
    if (!stays) kept_.advance(shape);
    return {frame_};
}

void Runner::submit(Slot& slot, const CompiledGraph& shape, const ExternalSync& outside) {
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
        device_.check_alive(result, "run " + name_of_frame(frame_ + 1, shape));
    slot.frame = ++frame_;
    slot.ended = false;
}

/// Waits for the frame of the slot, unless it was waited for before.
void Runner::finish(Slot& slot) {
    if (slot.ended) return;
    const SteadyClock::time_point begin = SteadyClock::now();
    const VkSemaphore semaphore = timeline_;
    VkSemaphoreWaitInfo wait{VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO};
    wait.semaphoreCount = 1;
    wait.pSemaphores = &semaphore;
    wait.pValues = &slot.frame;
    const VkResult result = vkWaitSemaphores(device_.handle(), &wait, ~std::uint64_t{0});
    if (result != VK_SUCCESS)
        device_.check_waited(result, "run " + name_of_frame(slot.frame, *slot.shape));
    const double waited = milliseconds_since(begin);
    slot.times.wall_ms = milliseconds_since(slot.submitted);
    slot.times.wait_ms += waited;
    wait_ms_ += waited;
    slot.ended = true;
    read_stamps(device_, slot, slot.times);
}

void Runner::finish_all() {
    for (Slot& slot : slots_) finish(slot);
}

Slot& Runner::slot_of(Ticket ticket) {
    check(ticket.frame >= 1 && ticket.frame <= frame_, Failure::internal, "frame ", ticket.frame,
          " is asked for, but ", frame_, " were submitted");
    Slot& slot = slots_[index_of(ticket.frame)];
    check(slot.frame == ticket.frame, Failure::internal, "frame ", ticket.frame,
          " is gone: its place was taken by frame ", slot.frame, ", with ", slots_.size(),
          " in flight");
    return slot;
}

bool Runner::has_ended(Ticket ticket) {
    const Slot& slot = slots_[index_of(ticket.frame)];
    if (slot.frame != ticket.frame || slot.ended)
        return true; // a later frame has the slot, or the frame was waited for
    const VkSemaphore semaphore = timeline_;
    VkSemaphoreWaitInfo wait{VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO};
    wait.semaphoreCount = 1;
    wait.pSemaphores = &semaphore;
    wait.pValues = &ticket.frame;
    const VkResult result = vkWaitSemaphores(device_.handle(), &wait, 0);
    if (result != VK_SUCCESS && result != VK_TIMEOUT)
        device_.check_waited(result, "run " + name_of_frame(slot.frame, *slot.shape));
    return result == VK_SUCCESS;
}

const GraphFrameTimes& Runner::wait(Ticket ticket) {
    Slot& slot = slot_of(ticket);
    finish(slot);
    return slot.times;
}

} // namespace catoptric::graph
