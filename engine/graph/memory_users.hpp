#pragma once

#include "graph/touch_list.hpp"

namespace catoptric::graph {

/// The last touches of each part of the shared memory while a frame is walked from first to last
/// pass. Each call costs O(log n) in the number of placements.
class LastUsersOfSharedMemory {
public:
    explicit LastUsersOfSharedMemory(const GraphPlan& plan);
    /// Records that the resource at this placement is not touched again. `touches` were its last
    /// touches.
    void record_last_accesses_to_memory(const MemoryPlacement& placement, AccessStateSet touches);
    /// Returns all touches that earlier resources left in this memory.
    AccessStateSet unfinished_accesses_in_memory(const MemoryPlacement& placement) const;

private:
    /// A segment tree over the pieces between the ends of all placements. Node n has the children
    /// 2n and 2n + 1.
    struct HeapAccessSegmentTree {
        std::vector<std::uint64_t> ends;   // sorted, each once
        std::vector<AccessStateSet> whole; // touches left in all of the node
        std::vector<AccessStateSet> below; // touches left in some part of the node
        std::size_t leaf(std::uint64_t offset) const;
        void resize_tree();
    };
    std::vector<HeapAccessSegmentTree> heaps_;
};

} // namespace catoptric::graph
