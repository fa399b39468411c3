#include "gpu/uploads.hpp"

#include "gpu/buffer.hpp"

#include <algorithm>

namespace catoptric::gpu {

namespace {

constexpr std::uint64_t kBlockBytes = 4 << 20;
constexpr const char* kUploadActivity = "write buffers";

} // namespace

StagedUploads::StagedUploads(Device& device) : device_(device) {
    VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    pool.queueFamilyIndex = device.queue_family();
    VkCommandPool pool_handle = VK_NULL_HANDLE;
    check_vk(vkCreateCommandPool(device.handle(), &pool, nullptr, &pool_handle),
             "create a command pool");
    pool_ = {device.handle(), pool_handle};
    VkSemaphoreTypeCreateInfo type{VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO};
    type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
    VkSemaphoreCreateInfo semaphore{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, &type};
    VkSemaphore semaphore_handle = VK_NULL_HANDLE;
    check_vk(vkCreateSemaphore(device.handle(), &semaphore, nullptr, &semaphore_handle),
             "create a semaphore");
    timeline_ = {device.handle(), semaphore_handle};
    for (StagingBlock& block : blocks_) {
        block.staging = std::make_unique<Buffer>(device, "staging", kBlockBytes,
                                                 BufferUsage::staging);
        VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
        allocate.commandPool = pool_;
        allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
        allocate.commandBufferCount = 1;
        check_vk(vkAllocateCommandBuffers(device.handle(), &allocate, &block.commands),
                 "allocate a command buffer");
    }
}

/// Waits for the submitted uploads. All buffers that were written are destroyed already, and have
/// waited for their own uploads.
StagedUploads::~StagedUploads() {
    if (device_.is_abandoned() || ended_ == submitted_) return;
    try {
        wait(submitted_);
    } catch (const Error&) { // the device is abandoned now
    }
}

void StagedUploads::wait(WriteTicket ticket) {
    if (ticket <= ended_) return;
    const VkSemaphore semaphore = timeline_;
    VkSemaphoreWaitInfo wait{VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO};
    wait.semaphoreCount = 1;
    wait.pSemaphores = &semaphore;
    wait.pValues = &ticket;
    device_.check_wait(vkWaitSemaphores(device_.handle(), &wait, ~std::uint64_t{0}),
                       kUploadActivity);
    ended_ = ticket;
}

/// Returns a block that is recording and has room.
StagedUploads::StagingBlock& StagedUploads::open_block() {
    if (is_recording_ && blocks_[current_].used < kBlockBytes) return blocks_[current_];
    submit();
    StagingBlock& block = blocks_[current_];
    wait(block.ends);
    block.used = 0, block.targets.clear();
    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check_vk(vkBeginCommandBuffer(block.commands, &begin), kUploadActivity);
    is_recording_ = true;
    return block;
}

/// Adds a barrier if a write overlaps an earlier one, so that writes happen in the order of their
/// calls.
void StagedUploads::order_writes(StagingBlock& block, const WriteRange& target) {
    const bool overlaps = std::ranges::any_of(block.targets, [&](const WriteRange& other) {
        return other.buffer == target.buffer && other.first < target.end &&
               target.first < other.end;
    });
    if (overlaps) {
        memory_barrier(block.commands, kTransferWrite, kTransferWrite);
        block.targets.clear();
    }
    block.targets.push_back(target);
}

StagedUploads::WriteTicket StagedUploads::stage_write(VkBuffer to, std::uint64_t offset,
                                                      std::span<const std::byte> data) {
    device_.check_not_abandoned();
    while (!data.empty()) {
        StagingBlock& block = open_block();
        const auto part = data.first(
            std::min<std::uint64_t>(data.size(), kBlockBytes - block.used));
        block.staging->write(block.used, part);
        order_writes(block, {to, offset, offset + part.size()});
        const VkBufferCopy region{block.used, offset, part.size()};
        vkCmdCopyBuffer(block.commands, block.staging->handle(), to, 1, &region);
        block.used += part.size(), offset += part.size();
        data = data.subspan(part.size());
    }
    return submitted_ + 1;
}

void StagedUploads::submit() {
    if (!is_recording_) return;
    StagingBlock& block = blocks_[current_];
    memory_barrier(block.commands, kTransferWrite,
                   {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                    VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT});
    is_recording_ = false;
    check_vk(vkEndCommandBuffer(block.commands), kUploadActivity);
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
    device_.check_result(vkQueueSubmit2(device_.queue(), 1, &submit, VK_NULL_HANDLE),
                         kUploadActivity);
    block.ends = ++submitted_;
    current_ = (current_ + 1) % blocks_.size();
}

void StagedUploads::wait_for(WriteTicket ticket) {
    if (ticket > submitted_) submit();
    // A write that was never submitted is not waited for.
    wait(std::min(ticket, submitted_));
}

PendingUpload::~PendingUpload() {
    if (ticket_ == 0 || device_->is_abandoned()) return;
    try {
        device_->uploads().wait_for(ticket_);
    } catch (const Error&) { // the device is abandoned now, or the write was not submitted
    }
}

} // namespace catoptric::gpu
