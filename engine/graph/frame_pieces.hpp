#pragma once

#include "graph/frame_slot.hpp"

#include <algorithm>
#include <cstdint>
#include <string>

namespace catoptric::graph {

/// Returns the most rays of a piece in the next frame on a processor: 2^15 to 2^18. The pieces of
/// the last frame held up to `rays`, and the slowest took `slowest_ms`. `has_several`: whether it
/// had more than one piece.
std::uint64_t fit_rays(std::uint64_t rays, double slowest_ms, bool has_several);

/// Submits a frame that traces many rays in pieces, each after the end of the one before. Between
/// them the host looks whether the work is to stop (core/watch.hpp).
class FramePieces {
public:
    explicit FramePieces(gpu::Device& device);

    /// Begins a frame of a slot. `wait`: semaphore of the caller for the first piece; may be null.
    /// `all_rays`: most rays that the frame can trace.
    void begin_frame(FrameSlot& slot, const CompiledGraph& shape, std::uint64_t frame,
                     VkSemaphore wait, std::uint64_t all_rays);
    /// Returns the most rays of a piece: WorkWatch::most_rays, or 2^24 on a device that is no
    /// processor. On a processor, 2^15 in the first frame, which take up to a second of two slow
    /// cores; then up to 2^18, while every piece of the last frame took under 50 ms, because the
    /// time between two pieces is lost.
    std::uint64_t most_rays() const { return most_rays_; }
    /// Returns the rays that the present piece can still hold.
    std::uint64_t room() const { return most_rays_ - std::min(rays_, most_rays_); }
    void add_rays(std::uint64_t rays) { rays_ += rays; }
    /// Counts the rays of earlier passes for the progress.
    void end_pass(std::uint64_t most_rays) { ended_ += most_rays, traced_ = 0; }

    /// Submits the ended command buffer of the slot and waits for it. Empties the slot's command
    /// buffer and descriptors. Throws `device_lost`, and as look_at_stop() does.
    void submit_and_wait();
    void note_submission_ms(double ms) { slowest_ms_ = std::max(slowest_ms_, ms); }
    /// Returns the semaphore that the frame's last submission waits for; null: none.
    VkSemaphore wait_semaphore() const { return submitted_ == 0 ? wait_ : VK_NULL_HANDLE; }
    /// Returns the number of pieces submitted in this frame, without the last.
    std::uint64_t submitted() const { return submitted_; }
    /// Returns the time in which the host waited for them, milliseconds.
    double wait_ms() const { return wait_ms_; }

private:
    gpu::Device& device_;
    gpu::UniqueSemaphore timeline_;
    std::uint64_t fitted_rays_; ///< most rays of a piece without a watch's own bound
    double slowest_ms_ = 0;     ///< slowest submission since the last fit
    std::uint64_t piece_ = 0;   ///< value of the semaphore after the last piece of all frames

    // The present frame.
    FrameSlot* slot_ = nullptr;
    const CompiledGraph* shape_ = nullptr;
    std::uint64_t frame_ = 0;
    VkSemaphore wait_ = VK_NULL_HANDLE;
    std::uint64_t most_rays_ = 0, all_rays_ = 0;
    std::uint64_t rays_ = 0;   ///< rays of the present piece
    std::uint64_t traced_ = 0; ///< rays of the present pass in submitted pieces
    std::uint64_t ended_ = 0;  ///< most rays of the passes that ended
    std::uint64_t submitted_ = 0;
    double wait_ms_ = 0;
};

/// Returns the number of the frame and the names of all its passes. A lost device does not tell
/// which pass was running.
std::string describe_frame(std::uint64_t frame, const CompiledGraph& shape);

/// Creates a timeline semaphore with the value 0.
gpu::UniqueSemaphore make_timeline(const gpu::Device& device);

} // namespace catoptric::graph
