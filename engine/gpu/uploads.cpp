#include "gpu/uploads.hpp"

#include "gpu/buffer.hpp"

#include <algorithm>

namespace catoptric::gpu {

namespace {

constexpr std::uint64_t kStagingBlockBytes = 4 << 20;
constexpr const char* kUploadActivityForErrors = "write buffers";

} // namespace

StagedUploads::StagedUploads(GpuDevice& device) : upload_device_(device) {
    VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    pool.queueFamilyIndex = device.queue_family_index();
    VkCommandPool pool_handle = VK_NULL_HANDLE;
    throw_unless_vk_success(
        vkCreateCommandPool(device.device_handle(), &pool, nullptr, &pool_handle),
        "create a command pool");
    pool_ = {device.device_handle(), pool_handle};
    VkSemaphoreTypeCreateInfo type{VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO};
    type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
    VkSemaphoreCreateInfo semaphore{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, &type};
    VkSemaphore semaphore_handle = VK_NULL_HANDLE;
    throw_unless_vk_success(
        vkCreateSemaphore(device.device_handle(), &semaphore, nullptr, &semaphore_handle),
        "create a semaphore");
    timeline_ = {device.device_handle(), semaphore_handle};
    for (StagingBlock& block : blocks_) {
        block.staging = std::make_unique<GpuBuffer>(device, "staging", kStagingBlockBytes,
                                                    BufferUsage::staging);
        VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
        allocate.commandPool = pool_;
        allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
        allocate.commandBufferCount = 1;
        throw_unless_vk_success(
            vkAllocateCommandBuffers(device.device_handle(), &allocate, &block.commands),
            "allocate a command buffer");
    }
}

/// Waits for the submitted uploads. All buffers that were written are destroyed already, and have
/// waited for their own uploads.
StagedUploads::~StagedUploads() {
    if (upload_device_.is_abandoned() || ended_ == submitted_) return;
    try {
        wait(submitted_);
    } catch (const Error&) { // the device is abandoned now
    }
}

void StagedUploads::wait(StagedWriteTicket ticket) {
    if (ticket <= ended_) return;
    const VkSemaphore semaphore = timeline_;
    VkSemaphoreWaitInfo wait{VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO};
    wait.semaphoreCount = 1;
    wait.pSemaphores = &semaphore;
    wait.pValues = &ticket;
    upload_device_.check_wait_or_abandon(
        vkWaitSemaphores(upload_device_.device_handle(), &wait, ~std::uint64_t{0}),
        kUploadActivityForErrors);
    ended_ = ticket;
}

/// Returns a block that is recording and has room.
StagedUploads::StagingBlock& StagedUploads::open_staging_block() {
    if (is_recording_ && blocks_[current_].used < kStagingBlockBytes) return blocks_[current_];
    submit();
    StagingBlock& block = blocks_[current_];
    wait(block.ends);
    block.used = 0, block.targets.clear();
    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    throw_unless_vk_success(vkBeginCommandBuffer(block.commands, &begin), kUploadActivityForErrors);
    is_recording_ = true;
    return block;
}

/// Adds a barrier if a write overlaps an earlier one, so that writes happen in the order of their
/// calls.
void StagedUploads::order_overlapping_staged_writes(StagingBlock& block,
                                                    const UploadWriteRange& target) {
    const bool overlaps = std::ranges::any_of(block.targets, [&](const UploadWriteRange& other) {
        return other.buffer == target.buffer && other.first < target.end &&
               target.first < other.end;
    });
    if (overlaps) {
        record_memory_barrier(block.commands, kTransferWriteAccessScope, kTransferWriteAccessScope);
        block.targets.clear();
    }
    block.targets.push_back(target);
}

StagedUploads::StagedWriteTicket StagedUploads::stage_write(VkBuffer to, std::uint64_t offset,
                                                            std::span<const std::byte> data) {
    upload_device_.check_device_not_abandoned();
    while (!data.empty()) {
        StagingBlock& block = open_staging_block();
        const auto part = data.first(
            std::min<std::uint64_t>(data.size(), kStagingBlockBytes - block.used));
        block.staging->write_contents(block.used, part);
        order_overlapping_staged_writes(block, {to, offset, offset + part.size()});
        const VkBufferCopy region{block.used, offset, part.size()};
        vkCmdCopyBuffer(block.commands, block.staging->buffer_handle(), to, 1, &region);
        block.used += part.size(), offset += part.size();
        data = data.subspan(part.size());
    }
    return submitted_ + 1;
}

void StagedUploads::submit() {
    if (!is_recording_) return;
    StagingBlock& block = blocks_[current_];
    record_memory_barrier(block.commands, kTransferWriteAccessScope,
                          {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                           VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT});
    is_recording_ = false;
    throw_unless_vk_success(vkEndCommandBuffer(block.commands), kUploadActivityForErrors);
    VkCommandBufferSubmitInfo commands{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
    commands.commandBuffer = block.commands;
    VkSemaphoreSubmitInfo signal{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO};
    signal.semaphore = timeline_;
    signal.value = submitted_ + 1;
    signal.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
    submit.commandBufferInfoCount = 1;
    submit.pCommandBufferInfos = &commands;
    submit.signalSemaphoreInfoCount = 1;
    submit.pSignalSemaphoreInfos = &signal;
    upload_device_.check_result_and_abandon_if_lost(
        vkQueueSubmit2(upload_device_.vulkan_queue(), 1, &submit, VK_NULL_HANDLE),
        kUploadActivityForErrors);
    block.ends = ++submitted_;
    current_ = (current_ + 1) % blocks_.size();
}

void StagedUploads::wait_for_staged_write(StagedWriteTicket ticket) {
    if (ticket > submitted_) submit();
    // A write that was never submitted is not waited for.
    wait(std::min(ticket, submitted_));
}

PendingUpload::~PendingUpload() {
    if (ticket_ == 0 || device_->is_abandoned()) return;
    try {
        device_->uploads().wait_for_staged_write(ticket_);
    } catch (const Error&) { // the device is abandoned now, or the write was not submitted
    }
}

} // namespace catoptric::gpu
