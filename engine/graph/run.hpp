#pragma once

#include "gpu/buffer.hpp"
#include "gpu/pipeline.hpp"
#include "graph/frame_memory.hpp"
#include "graph/persistent_images.hpp"
#include "graph/record.hpp"

namespace catoptric::graph {

/// A frame that was submitted, by its number from 1. Valid with the runner that gave it.
struct Ticket {
    std::uint64_t frame = 0;
};

/// Somebody else's semaphores: the frame begins after the one and ends with the other; null: none.
struct ExternalSync {
    VkSemaphore wait = VK_NULL_HANDLE;
    VkSemaphore signal = VK_NULL_HANDLE;
};

/// Runs graphs: each shape is planned once, each frame is one command buffer and one submit, and
/// one timeline semaphore tells when it has ended. Frames run in order, each after all of the one
/// before. Images, memory and history stay between frames. One run of a technique = one Runner.
class Runner {
public:
    /// `in_flight`: how many frames may be submitted before the first of them is waited for, 1 to
    /// kMostInFlight; each has its own commands and its own copy of what is wanted of a frame.
    Runner(gpu::Device& device, gpu::Pipelines& pipelines, std::uint32_t in_flight = 1);
    Runner(const Runner&) = delete;
    Runner& operator=(const Runner&) = delete;
    /// Waits for what is in flight.
    ~Runner();

    /// What the next Graph must be told about the last frame.
    History history() const { return kept_.history(); }
    /// Drops all that was kept of earlier frames: the next one is as the first. Waits for what is
    /// in flight.
    void forget();
    /// All that was kept of earlier frames, taken away: the next frame is as the first. Waits for
    /// what is in flight.
    RetainedImages suspend();
    /// The next frame goes on from what was set aside; what is kept now is dropped. Waits for what
    /// is in flight.
    void resume(RetainedImages leavings);
    Limits limits() const;
    /// The plan of the graph's shape: found among those of the last 8 shapes, or made. Valid until
    /// 8 others were asked for. Throws what graph::plan throws.
    const Plan& compiled(const Graph& graph) { return compile(graph).plan; }
    std::uint64_t plans_made() const { return plans_made_; }
    /// Bytes of the device's memory that images and buffers of its graphs take: as much as the
    /// largest of the last 8 shapes that ran, and all that is kept.
    std::uint64_t memory_bytes() const { return memory_.bytes() + kept_.bytes(); }

    /// Records and submits. Waits only where all places in flight are taken, for the oldest frame.
    /// `stays`: a frame beside the sequence; the next one has the history that this one had.
    /// Throws `exhausted`; `device_lost` where it had to wait or the device refused the frame.
    Ticket submit(const Graph& graph, Timing timing, bool stays = false,
                  const ExternalSync& outside = {});
    /// Waits until the frame has ended; at once when that was done before. Throws `device_lost`
    /// (naming the frame's passes), and `internal` when its place was taken by a later frame.
    const FrameTimes& wait(Ticket ticket);
    /// Whether the frame has ended, without waiting. Throws `device_lost`.
    bool has_ended(Ticket ticket);
    FrameTimes run(const Graph& graph, Timing timing, bool stays = false) {
        return wait(submit(graph, timing, stays));
    }

    /// Texels of a wanted image of the frame, which is waited for: rows top down, layer after
    /// layer, mip after mip. There until its place is taken by a later frame; what outlives frames
    /// is there until the next one is submitted.
    std::vector<std::byte> read(Ticket ticket, Image image);
    std::vector<std::byte> read(Ticket ticket, Buffer buffer);
    /// The same of the frame that was submitted last.
    std::vector<std::byte> read(Image image) { return read(Ticket{frame_}, image); }
    std::vector<std::byte> read(Buffer buffer) { return read(Ticket{frame_}, buffer); }
    /// Everything that the next frame can see of the last one: texels of the images that have a
    /// `previous`, one after the other. Empty where nothing is remembered.
    std::vector<std::byte> read_history();

private:
    Compiled& compile(const Graph& graph);
    Slot& slot_of(Ticket ticket);
    std::size_t index_of(std::uint64_t frame) const { return (frame - 1) % slots_.size(); }
    void submit(Slot& slot, const Compiled& shape, const ExternalSync& outside);
    void finish(Slot& slot);
    void finish_all();
    void release_persistent();

    gpu::Device& device_;
    Recorder recorder_;
    gpu::UniqueSemaphore timeline_;
    FrameMemory memory_;
    PersistentImages kept_;
    std::vector<std::shared_ptr<Compiled>> shapes_; ///< the one that was asked for last comes first
    std::vector<Slot> slots_;
    std::uint64_t frame_ = 0; ///< of the last submit
    std::uint64_t plans_made_ = 0;
    double compile_ms_ = 0; ///< since the last submit
    double wait_ms_ = 0;    ///< in all
};

} // namespace catoptric::graph
