#include "graph/frame_pieces.hpp"

#include "core/watch.hpp"

#include <algorithm>
#include <utility>

namespace catoptric::graph {

namespace {

constexpr std::uint64_t kFirstRaysOnProcessor = std::uint64_t{1} << 15,
                        kMostRaysOnProcessor = std::uint64_t{1} << 18,
                        kMostRaysOnOtherDevices = std::uint64_t{1} << 24;
/// Milliseconds of a frame's slowest piece below which the next frame's pieces hold twice as many
/// rays, and above which they hold half as many.
constexpr double kShortPiece = 50, kLongPiece = 200;

} // namespace

std::string describe_frame(std::uint64_t frame, const CompiledGraph& shape) {
    std::string name = "frame " + std::to_string(frame) + " (passes";
    for (const PlannedPass& planned : shape.plan.passes)
        name += " '" + shape.outline.passes()[planned.pass].name + "'";
    return name + ")";
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

FramePieces::FramePieces(gpu::Device& device)
    : device_(device), timeline_(make_timeline(device)),
      fitted_rays_(device.is_cpu() ? kFirstRaysOnProcessor : kMostRaysOnOtherDevices) {}

std::uint64_t fit_rays(std::uint64_t rays, double slowest_ms, bool has_several) {
    if (slowest_ms > kLongPiece) return std::max(rays / 2, kFirstRaysOnProcessor);
    if (slowest_ms < kShortPiece && has_several) return std::min(rays * 2, kMostRaysOnProcessor);
    return rays;
}

void FramePieces::begin_frame(FrameSlot& slot, const CompiledGraph& shape, std::uint64_t frame,
                              VkSemaphore wait, std::uint64_t all_rays) {
    slot_ = &slot, shape_ = &shape, frame_ = frame, wait_ = wait;
    if (device_.is_cpu())
        fitted_rays_ = fit_rays(fitted_rays_, std::exchange(slowest_ms_, 0), submitted_ > 0);
    const WorkWatch* const watch = current_watch();
    most_rays_ = watch != nullptr && watch->most_rays > 0 ? watch->most_rays : fitted_rays_;
    all_rays_ = all_rays;
    rays_ = traced_ = ended_ = submitted_ = 0;
    wait_ms_ = 0;
}

void FramePieces::submit_and_wait() {
    const auto at = [](VkSemaphore semaphore, std::uint64_t value) {
        VkSemaphoreSubmitInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO};
        info.semaphore = semaphore;
        info.value = value;
        info.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        return info;
    };
    const VkSemaphore outside = wait_semaphore(), timeline = timeline_;
    const VkSemaphoreSubmitInfo begin = at(outside, 0), end = at(timeline, ++piece_);
    VkCommandBufferSubmitInfo commands{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
    commands.commandBuffer = slot_->commands;
    VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
    submit.commandBufferInfoCount = 1;
    submit.pCommandBufferInfos = &commands;
    submit.waitSemaphoreInfoCount = outside ? 1 : 0;
    submit.pWaitSemaphoreInfos = &begin;
    submit.signalSemaphoreInfoCount = 1;
    submit.pSignalSemaphoreInfos = &end;
    device_.submit_uploads();
    const SteadyClock::time_point start = SteadyClock::now();
    ++submitted_;
    const std::string doing = "run piece " + std::to_string(submitted_) + " of " +
                              describe_frame(frame_, *shape_);
    device_.check_result(vkQueueSubmit2(device_.queue(), 1, &submit, VK_NULL_HANDLE), doing);
    VkSemaphoreWaitInfo wait{VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO};
    wait.semaphoreCount = 1;
    wait.pSemaphores = &timeline;
    wait.pValues = &piece_;
    device_.check_wait(vkWaitSemaphores(device_.handle(), &wait, ~std::uint64_t{0}), doing);
    const double ms = ms_since(start);
    wait_ms_ += ms;
    note_submission_ms(ms);
    slot_->end_piece();
    traced_ += rays_, rays_ = 0;
    if (const WorkWatch* const watch = current_watch(); watch != nullptr && watch->on_piece)
        watch->on_piece(std::min(ended_ + traced_, all_rays_), all_rays_);
    look_at_stop();
}

} // namespace catoptric::graph
