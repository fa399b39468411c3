#pragma once

#include "gpu/vulkan.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace catoptric::gpu {

class Buffer;
class Device;

/// Writes to buffers that the host cannot map, through a ring of staging blocks. A write copies its
/// bytes into a block and records a copy on the device. It waits only if the whole ring is in
/// flight. Copies are submitted before the next frame. Work submitted after them sees their writes.
class StagedUploads {
public:
    /// The number of the submit that ends a write; 0: none. Larger numbers end later.
    using WriteTicket = std::uint64_t;

    explicit StagedUploads(Device& device);
    ~StagedUploads();

    /// Writes `data` to `to` from `offset` bytes on. `to` must live until the ticket has ended.
    /// Throws as Device::check_result and check_wait do.
    WriteTicket stage_write(VkBuffer to, std::uint64_t offset, std::span<const std::byte> data);
    /// Submits the recorded copies that are not submitted yet.
    void submit();
    void wait_for(WriteTicket ticket);

private:
    /// Bytes of `buffer` that a block's commands write.
    struct WriteRange {
        VkBuffer buffer;
        std::uint64_t first, end;
    };
    struct StagingBlock {
        std::unique_ptr<Buffer> staging;
        VkCommandBuffer commands = VK_NULL_HANDLE;
        std::uint64_t used = 0;          ///< bytes used in `staging`
        WriteTicket ends = 0;            ///< timeline value at which the block is free again
        std::vector<WriteRange> targets; ///< writes since the last barrier
    };
    StagingBlock& open_block();
    void wait(WriteTicket ticket);
    void order_writes(StagingBlock& block, const WriteRange& target);

    Device& device_;
    UniqueCommandPool pool_;
    UniqueSemaphore timeline_;
    std::array<StagingBlock, 3> blocks_;
    std::size_t current_ = 0;
    bool is_recording_ = false;
    WriteTicket submitted_ = 0, ended_ = 0;
};

/// The last upload to a buffer. Its destructor waits until the upload has ended, so that the buffer
/// may be destroyed.
class PendingUpload {
public:
    PendingUpload() = default;
    PendingUpload(PendingUpload&& other) noexcept { swap_uploads(other); }
    PendingUpload& operator=(PendingUpload&& other) noexcept {
        swap_uploads(other);
        return *this;
    }
    ~PendingUpload();
    /// Replaces the ticket with that of a later write to the same buffer.
    void set_ticket(Device& device, StagedUploads::WriteTicket ticket) {
        device_ = &device, ticket_ = ticket;
    }

private:
    void swap_uploads(PendingUpload& other) noexcept {
        std::swap(device_, other.device_), std::swap(ticket_, other.ticket_);
    }

    Device* device_ = nullptr;
    StagedUploads::WriteTicket ticket_ = 0;
};

} // namespace catoptric::gpu
