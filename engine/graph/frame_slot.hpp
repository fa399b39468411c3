#pragma once

#include "core/stopwatch.hpp"
#include "gpu/device.hpp"
#include "graph/compiled_graph.hpp"
#include "graph/frame_times.hpp"
#include "graph/work_counter.hpp"

#include <memory>

namespace catoptric::graph {

/// The resources of one frame in flight: command buffer, timestamps, descriptors. They are reused
/// once the frame has ended.
class FrameSlot {
public:
    explicit FrameSlot(const gpu::Device& device);
    /// Empties the command buffer. A frame that failed has left it unfinished, with commands that
    /// use resources which the next frame may destroy.
    void reset_commands();
    /// Empties the descriptor pools and makes room for `most_stamps` timestamps.
    void reset(std::uint32_t most_stamps);
    /// Reads the timestamps that the commands wrote, and empties the command buffer and the
    /// descriptor pools, for the next piece of the same frame. The piece must have ended.
    void end_piece();
    /// Appends the timestamps since the last call to `stamps`.
    VkResult read_stamps();
    VkDescriptorSet allocate_descriptor_set(VkDescriptorSetLayout layout);

    VkCommandBuffer commands = VK_NULL_HANDLE;
    gpu::UniqueQueryPool queries;
    std::uint32_t next_query = 0;
    std::vector<std::uint64_t> stamps; ///< of the frame so far
    /// Positions in `stamps` of the first of each piece but the frame's first piece.
    std::vector<std::size_t> piece_begins;

    // The frame that was submitted last from this slot.
    std::uint64_t frame =
        0; ///< number of the slot's last frame, from 1; 0: none yet, or a later one failed
    bool ended = true; ///< whether the host has waited for the slot's last frame
    bool stays = false;
    PassTiming timing = PassTiming::isolated;
    std::shared_ptr<CompiledGraph> shape;
    SteadyClock::time_point submitted;
    GraphFrameTimes times;
    std::unique_ptr<WorkCounter> work; ///< null: the frame does not count its work

private:
    void reset_descriptors();

    const gpu::Device& device_;
    gpu::UniqueCommandPool pool_;
    std::uint32_t query_count_ = 0;
    std::vector<gpu::UniqueDescriptorPool> descriptor_pools_;
    std::size_t next_pool_ = 0;
};

} // namespace catoptric::graph
