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
class FrameInFlightResources {
public:
    explicit FrameInFlightResources(const gpu::GpuDevice& device);
    /// Empties the command buffer. A frame that failed has left it unfinished, with commands that
    /// use resources which the next frame may destroy.
    void reset_commands();
    /// Empties the descriptor pools and makes room for `stamps` timestamps.
    void reset(std::uint32_t stamps);
    VkDescriptorSet allocate_descriptor_set(VkDescriptorSetLayout layout);

    VkCommandBuffer commands = VK_NULL_HANDLE;
    gpu::UniqueQueryPool queries;
    std::uint32_t next_query = 0;

    // The frame that was submitted last from this slot.
    std::uint64_t frame =
        0; ///< number of the slot's last frame, from 1; 0: none yet, or a later one failed
    bool ended = true; ///< whether the host has waited for the slot's last frame
    bool stays = false;
    PassTiming timing = PassTiming::isolated;
    std::shared_ptr<CompiledRenderGraph> shape;
    SteadyClock::time_point submitted;
    GraphFrameTimes times;
    std::unique_ptr<WorkCounter> work; ///< null: the frame does not count its work

private:
    const gpu::GpuDevice& slot_device_;
    gpu::UniqueCommandPool pool_;
    std::uint32_t query_count_ = 0;
    std::vector<gpu::UniqueDescriptorPool> descriptor_pools_;
    std::size_t next_pool_ = 0;
};

} // namespace catoptric::graph
