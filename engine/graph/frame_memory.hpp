#pragma once

#include "graph/compiled.hpp"

#include <functional>
#include <memory>

namespace catoptric::graph {

/// Memory that the shapes of a runner use in turn: what lives within a frame lies in one place for
/// all, since frames follow one another; what is wanted of a frame in one place for each slot,
/// until a frame is submitted there again. As large as the largest shape asks for.
class FrameMemory {
public:
    explicit FrameMemory(const gpu::Device& device) : device_(device) {}

    /// Makes what `shape` runs with from this slot; nothing when that is there. `shapes`: all that
    /// have claims. Calls `wait` before anything is destroyed that frames in flight may use.
    void provide(Compiled& shape, std::size_t slot,
                 std::span<const std::shared_ptr<Compiled>> shapes,
                 const std::function<void()>& wait);

    /// Bytes that are taken of the device.
    std::uint64_t bytes() const;

private:
    /// Bytes of each heap, with their memory.
    struct Arena {
        std::vector<std::uint64_t> bytes;
        std::vector<gpu::UniqueMemory> heaps;
    };
    void allocate(Arena& arena, std::vector<std::uint64_t> bytes);
    void make(Compiled& shape, Resources& resources, const Arena& arena, bool alone);

    const gpu::Device& device_;
    Arena shared_;
    std::array<Arena, kMostInFlight> own_;
};

} // namespace catoptric::graph
