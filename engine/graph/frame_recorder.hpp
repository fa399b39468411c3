#pragma once

#include "gpu/pipeline.hpp"
#include "graph/commands.hpp"
#include "graph/frame_pieces.hpp"
#include "graph/frame_slot.hpp"
#include "graph/work_counter.hpp"

namespace catoptric::graph {

/// Records a planned frame into the command buffer of a slot.
class FrameRecorder {
public:
    FrameRecorder(gpu::Device& device, gpu::PipelineStore& pipelines);

    /// `slot_index` selects the copy of the outputs that the frame writes. `work` counts the
    /// frame's work; null: nothing is counted. `pieces`: of this frame, which submits all of it but
    /// the last piece.
    void record_frame(const Graph& graph, CompiledGraph& shape, FrameSlot& slot,
                      std::size_t slot_index, PassTiming timing, WorkCounter* work,
                      FramePieces& pieces);

    /// Only PassCommands may call this function, while a pass records its commands.
    gpu::Device& recording_device() { return device_; }
    gpu::PipelineStore& pipeline_store() { return pipelines_; }
    /// Null: nothing is counted.
    WorkCounter* work_counter() { return work_; }
    FramePieces& frame_pieces() { return *pieces_; }
    /// Ends the piece of the frame that is being recorded, runs it, and begins the next. What was
    /// bound must be bound again. Not within a rendering scope.
    void run_piece();
    /// Returns a word of a buffer that earlier passes or this one wrote, after running the piece
    /// that is being recorded.
    std::uint32_t read_word(BufferHandle buffer, std::uint64_t offset);
    PhysicalImage& physical_image(ImageHandle image);
    VkBuffer vulkan_buffer(BufferHandle buffer) const;
    VkSampler sampler(TextureFilter filter) const {
        return samplers_[static_cast<std::size_t>(filter)];
    }
    VkDescriptorSet allocate_descriptor_set(VkDescriptorSetLayout layout) {
        return slot_->allocate_descriptor_set(layout);
    }

private:
    void record_pass(const PlannedPass& planned);
    void begin_label(const Pass& pass);
    void record_raster_pass(const PlannedPass& planned, std::uint32_t first_layer,
                            std::uint32_t layer_count);
    void add_attachment(const ImageUse& use, bool unread, std::uint32_t first_layer,
                        std::uint32_t layer_count);
    void count_traffic(const Pass& pass, const VkRenderingInfo& rendering);
    void record_barriers(const std::vector<PlannedBarrier>& list, bool last);
    void add_barrier(const PlannedBarrier& barrier, bool last);
    void begin_commands();
    void record_full_barrier();
    void write_timestamp(PassTiming timing);

    gpu::Device& device_;
    gpu::PipelineStore& pipelines_;
    std::array<gpu::UniqueSampler, 4> samplers_;
    PFN_vkCmdBeginDebugUtilsLabelEXT begin_label_ = nullptr;
    PFN_vkCmdEndDebugUtilsLabelEXT end_label_ = nullptr;

    // The frame that is being recorded.
    const Graph* graph_ = nullptr;
    CompiledGraph* shape_ = nullptr;
    FrameSlot* slot_ = nullptr;
    std::size_t slot_index_ = 0;
    WorkCounter* work_ = nullptr;
    FramePieces* pieces_ = nullptr;
    const Pass* pass_in_pieces_ = nullptr; ///< the pass that is being recorded, if it may be split
    PassTiming timing_ = PassTiming::isolated;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    // These lists are members and no local variables, so that their memory is used again.
    std::vector<VkImageMemoryBarrier2> image_barriers_;
    std::vector<VkBufferMemoryBarrier2> buffer_barriers_;
    std::vector<VkRenderingAttachmentInfo> colours_;
    VkRenderingAttachmentInfo depth_{};
};

} // namespace catoptric::graph
