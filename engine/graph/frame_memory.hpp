#pragma once

#include "graph/compiled_graph.hpp"

#include <functional>
#include <memory>

namespace catoptric::graph {

/// Memory that the shapes of a runner use in turn, as large as the largest shape needs. Resources
/// that live within a frame share one arena, because frames run one after another. Outputs of a
/// frame have one arena per slot and stay until the slot's next frame is submitted.
class SharedGraphMemoryArena {
public:
    explicit SharedGraphMemoryArena(const gpu::GpuDevice& device) : memory_device_(device) {}

    /// Makes the resources that `shape` runs with in this slot, unless they exist. `shapes`: all
    /// shapes that need memory. Calls `wait` before it destroys anything that frames in flight may
    /// use.
    void find_or_allocate_heap_memory(CompiledRenderGraph& shape, std::size_t slot,
                                      std::span<const std::shared_ptr<CompiledRenderGraph>> shapes,
                                      const std::function<void()>& wait);

    /// Returns the bytes of device memory that are allocated.
    std::uint64_t allocated_device_bytes() const;

private:
    /// The bytes of each heap and the memory allocated for them.
    struct DeviceHeapAllocations {
        std::vector<std::uint64_t> bytes;
        std::vector<gpu::UniqueMemory> heaps;
    };
    void allocate(DeviceHeapAllocations& arena, std::vector<std::uint64_t> bytes);
    void create_resources(CompiledRenderGraph& shape, CompiledGraphResources& resources,
                          const DeviceHeapAllocations& arena, bool alone);

    const gpu::GpuDevice& memory_device_;
    DeviceHeapAllocations shared_;
    std::array<DeviceHeapAllocations, kMaxFramesInFlight> own_;
};

} // namespace catoptric::graph
