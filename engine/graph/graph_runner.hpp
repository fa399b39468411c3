#pragma once

#include "gpu/buffer.hpp"
#include "gpu/pipeline.hpp"
#include "graph/frame_memory.hpp"
#include "graph/frame_pieces.hpp"
#include "graph/frame_recorder.hpp"
#include "graph/persistent_resources.hpp"

namespace catoptric::graph {

/// A submitted frame, by its number from 1. Valid with the runner that returned it.
struct FrameTicket {
    std::uint64_t frame = 0;
};

/// Semaphores of the caller. The frame begins after `wait` and signals `signal` at its
/// end; null: none.
struct ExternalSemaphores {
    VkSemaphore wait = VK_NULL_HANDLE;
    VkSemaphore signal = VK_NULL_HANDLE;
};

/// Runs graphs. Each shape is planned once. Each frame is one command buffer and one submit, unless
/// it traces many rays (frame_pieces.hpp), and one timeline semaphore tells when it has ended.
/// Frames run in order, each after all work of the one before. Images, memory and history stay
/// between frames. Each run of a technique has its own GraphRunner.
class GraphRunner {
public:
    /// `in_flight`: frames that may be submitted before the first of them is waited for, 1 to
    /// kMaxFramesInFlight. Each has its own command buffer and its own copy of the outputs.
    /// `retained`: where images and buffers that outlive frames are; null: in the runner. The
    /// caller may exchange them for those of other frames after `release_retained`.
    GraphRunner(gpu::Device& device, gpu::PipelineStore& pipelines, std::uint32_t in_flight = 1,
                RetainedResources* retained = nullptr);
    GraphRunner(const GraphRunner&) = delete;
    GraphRunner& operator=(const GraphRunner&) = delete;
    /// Waits for the frames in flight.
    ~GraphRunner();

    /// Returns the history to construct the next Graph with.
    GraphHistory make_history() const { return kept_.make_history(); }
    /// Drops all contents of earlier frames, so that the next frame is like the first. Waits for
    /// the frames in flight.
    void discard_contents();
    /// Waits for the frames in flight, and forgets the images and buffers that outlive frames. The
    /// caller may then exchange them: the next frame continues from the contents it finds.
    void release_retained();
    GraphLimits limits() const;
    /// Returns the plan of the graph. The plans of the last 8 different graphs are cached. The
    /// reference is valid until 8 other graphs were planned. Throws the errors of
    /// graph::plan_graph.
    const GraphPlan& plan(const Graph& graph) { return compile(graph).plan; }
    std::uint64_t plan_count() const { return plan_count_; }
    /// Returns the bytes of device memory for images and buffers: as much as the largest of the
    /// last 8 graphs that ran, plus all that outlive frames.
    std::uint64_t allocated_bytes() const {
        return memory_.allocated_bytes() + kept_.allocated_bytes();
    }

    /// Records and submits a frame. If `in_flight` frames are on the device, waits for the oldest.
    /// `stays`: the frame does not advance the history, so that the next frame sees the same last
    /// frame. `counts_work`: the frame counts its work, which makes it slower. Of a frame in
    /// pieces, waits for all but the last. Throws `exhausted`, and what the watch of the thread
    /// throws between pieces. Throws `device_lost` if a wait fails or the device refuses the frame.
    FrameTicket submit_frame(const Graph& graph, PassTiming timing, bool stays = false,
                             const ExternalSemaphores& outside = {}, bool counts_work = false);
    /// Returns whether the last call of submit_frame, which threw, has dropped the contents of
    /// earlier frames, because pieces of the frame had run.
    bool has_dropped_contents() const { return has_dropped_contents_; }
    /// Waits until the frame has ended, and returns its times. Returns at once if it was waited for
    /// before. Throws `device_lost`, naming the frame's passes. Throws `internal` if a later frame
    /// has taken its slot.
    const GraphFrameTimes& wait_for(FrameTicket ticket);
    /// Returns whether the frame has ended, without waiting. Throws `device_lost`.
    bool has_ended(FrameTicket ticket);
    GraphFrameTimes run_and_wait(const Graph& graph, PassTiming timing, bool stays = false) {
        return wait_for(submit_frame(graph, timing, stays));
    }

    /// Waits for the frame and returns the work of its passes, in order of execution. Empty if the
    /// frame did not count its work.
    std::vector<PassWork> work_counts(FrameTicket ticket);

    /// Waits for the frame and returns the texels of one of its outputs: rows from the top down,
    /// layer after layer, mip after mip. An output can be read until a later frame uses the same
    /// slot (frame in flight). An image that outlives frames can be read until the next frame is
    /// submitted.
    std::vector<std::byte> read_back(FrameTicket ticket, ImageHandle image);
    std::vector<std::byte> read_back(FrameTicket ticket, BufferHandle buffer);
    /// Reads from the frame that was submitted last.
    std::vector<std::byte> read_back(ImageHandle image) {
        return read_back(FrameTicket{frame_}, image);
    }
    std::vector<std::byte> read_back(BufferHandle buffer) {
        return read_back(FrameTicket{frame_}, buffer);
    }
    /// Returns all images and buffers with `previous` contents, one after another. These are all
    /// contents of the last frame that the next frame can read. Empty if there are none.
    std::vector<std::byte> read_history();

private:
    CompiledGraph& compile(const Graph& graph);
    FrameSlot& slot_of(FrameTicket ticket);
    std::size_t slot_index_of(std::uint64_t frame) const { return (frame - 1) % slots_.size(); }
    void submit_frame(FrameSlot& slot, const CompiledGraph& shape,
                      const ExternalSemaphores& outside);
    void finish_frame(FrameSlot& slot);
    void finish_frames();
    /// Records the frame, and submits all its pieces but the last.
    void record_frame(const Graph& graph, CompiledGraph& shape, FrameSlot& slot,
                      std::size_t slot_index, PassTiming timing, VkSemaphore wait);

    gpu::Device& device_;
    FrameRecorder recorder_;
    FramePieces pieces_;
    gpu::UniqueSemaphore timeline_;
    FrameMemory memory_;
    RetainedResources own_retained_;
    PersistentResources kept_;
    /// Compiled graphs, the most recently used first.
    std::vector<std::shared_ptr<CompiledGraph>> shapes_;
    std::vector<FrameSlot> slots_;
    std::uint64_t frame_ = 0; ///< number of the frame submitted last
    std::uint64_t plan_count_ = 0;
    bool has_dropped_contents_ = false;
    double compile_ms_ = 0; ///< since the last submit
    double wait_ms_ = 0;    ///< total
};

} // namespace catoptric::graph
