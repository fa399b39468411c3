#pragma once

#include "graph/compiled_graph.hpp"

#include <functional>
#include <memory>

namespace catoptric::graph {

/// Device memory that all planned graphs of a runner use in turn. The memory is as large as the
/// largest graph needs. Images and buffers that live within a frame share one block, because frames
/// run one after another. Outputs have one block for each slot (frame in flight), and stay until
/// the slot's next frame is recorded.
class FrameMemory {
public:
    explicit FrameMemory(const gpu::Device& device) : device_(device) {}

    /// Makes the images and buffers with which the planned graph `shape` runs in this slot, unless
    /// they exist. `shapes`: all planned graphs that need memory. Calls `wait` before it destroys
    /// an image or buffer that frames in flight may use.
    void ensure_resources(CompiledGraph& shape, std::size_t slot,
                          std::span<const std::shared_ptr<CompiledGraph>> shapes,
                          const std::function<void()>& wait);

    std::uint64_t allocated_bytes() const;

private:
    struct HeapAllocations {
        std::vector<std::uint64_t> bytes;
        std::vector<gpu::UniqueMemory> heaps;
    };
    void allocate(HeapAllocations& arena, std::vector<std::uint64_t> bytes);
    void create_resources(CompiledGraph& shape, GraphResources& resources,
                          const HeapAllocations& arena, bool alone);

    const gpu::Device& device_;
    HeapAllocations shared_;
    std::array<HeapAllocations, kMaxFramesInFlight> own_;
};

} // namespace catoptric::graph
