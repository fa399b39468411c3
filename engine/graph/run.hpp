#pragma once

#include "gpu/buffer.hpp"
#include "gpu/pipeline.hpp"
#include "graph/commands.hpp"
#include "graph/physical.hpp"
#include "graph/plan.hpp"

#include <array>
#include <map>
#include <memory>

namespace catoptric::graph {

/// isolated: an execution barrier follows each stamp, so the times of passes add up and no two
/// passes overlap. pipelined: only the barriers that the plan needs; believe the span, not the
/// parts.
enum class Timing { isolated, pipelined };

struct PassTime {
    std::string name;
    double begin_ms = 0; ///< from the frame's first stamp
    double end_ms = 0;
    double ms() const { return end_ms - begin_ms; }
};

/// One frame on the clock. On a cpu device "gpu" time is processor time of the driver's threads.
struct FrameTimes {
    std::vector<PassTime> passes; ///< in order of execution
    double span_ms = 0;           ///< first to last stamp
    double record_ms = 0;         ///< filling the command buffer, host clock
    double wall_ms = 0;           ///< submit until the device has finished, host clock
};

/// Executes plans: one command buffer, one submit, one timeline semaphore a frame. Keeps images,
/// memory and history between frames of the same shape. One run of a technique = one Runner.
class Runner {
public:
    Runner(gpu::Device& device, gpu::Pipelines& pipelines);
    Runner(const Runner&) = delete;
    Runner& operator=(const Runner&) = delete;

    /// What the next Graph must be told about the last frame.
    History history() const;
    /// The next frame begins without history.
    void forget();
    Limits limits() const;
    Sizer sizer() const;
    Plan plan(const Graph& graph) const { return graph::plan(graph, limits(), sizer()); }

    /// Records, submits and waits. Throws `exhausted`, `device_lost` (naming the frame's passes).
    /// `stays`: a frame beside the sequence; the next one has the history that this one had.
    FrameTimes run(const Graph& graph, const Plan& plan, Timing timing, bool stays = false);

    /// Texels of a wanted image of the graph that ran last: rows top down, layers one after the
    /// other.
    std::vector<std::byte> read(Image image);
    std::vector<std::byte> read(Buffer buffer);
    /// Everything that the next frame can see of the last one: texels of the images that have a
    /// `previous`, one after the other. Empty where nothing is remembered.
    std::vector<std::byte> read_history();

    // For Commands only.
    gpu::Device& device() { return device_; }
    gpu::Pipelines& pipelines() { return pipelines_; }
    Physical& physical(Image image);
    VkBuffer buffer(Buffer buffer) const { return buffers_[buffer.id]; }
    VkSampler sampler(Filter filter) const { return samplers_[static_cast<std::size_t>(filter)]; }
    VkDescriptorSet descriptor_set(VkDescriptorSetLayout layout);

private:
    /// An image that outlives the frame: this frame's and the last one's.
    struct Kept {
        std::array<Physical, 2> copies;
        gpu::UniqueMemory memory;
        int last = 0; ///< index of the copy that holds the last frame
        bool valid = false;
    };
    void prepare(const Graph& graph, const Plan& plan);
    void make_kept(const ImageDesc& desc);
    void record(const Graph& graph, const Plan& plan, Timing timing);
    void record_pass(const Graph& graph, const Pass& pass);
    void render(const Graph& graph, const Pass& pass, std::uint32_t first_layer,
                std::uint32_t layer_count);
    void barriers(const Graph& graph, const Plan& plan, const std::vector<Barrier>& list,
                  bool last);
    void full_barrier();
    void stamp(Timing timing);
    std::string name_of_frame(const Graph& graph, const Plan& plan) const;
    double submit_and_wait(const Graph& graph, const Plan& plan);
    FrameTimes read_times(const Graph& graph, const Plan& plan, Timing timing) const;

    gpu::Device& device_;
    gpu::Pipelines& pipelines_;
    std::array<gpu::UniqueSampler, 3> samplers_;
    gpu::UniqueCommandPool pool_;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    gpu::UniqueSemaphore timeline_;
    std::uint64_t frame_ = 0;
    gpu::UniqueQueryPool queries_;
    std::uint32_t query_count_ = 0, next_query_ = 0;
    std::vector<gpu::UniqueDescriptorPool> descriptor_pools_;
    std::size_t next_pool_ = 0;

    std::vector<ImageDesc> image_descs_; ///< what `images_` was made for
    std::vector<BufferDesc> buffer_descs_;
    std::vector<std::uint64_t> offsets_;
    std::vector<gpu::UniqueMemory> heaps_;
    std::vector<Physical> images_;
    std::vector<gpu::UniqueBuffer> owned_buffers_;
    std::vector<VkBuffer> buffers_;
    std::map<std::string, Kept> kept_;
    std::set<std::uint32_t> kept_ids_;
    PFN_vkCmdBeginDebugUtilsLabelEXT begin_label_ = nullptr;
    PFN_vkCmdEndDebugUtilsLabelEXT end_label_ = nullptr;
};

} // namespace catoptric::graph
