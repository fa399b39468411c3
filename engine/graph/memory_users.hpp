#pragma once

#include "graph/touch_list.hpp"

namespace catoptric::graph {

/// Records the last accesses to each part of the shared memory, from the first pass of a frame to
/// the last. Each call takes O(log n) for n placements.
class LastUsersOfSharedMemory {
public:
    explicit LastUsersOfSharedMemory(const GraphPlan& plan);
    /// Records that no later pass uses the resource at this placement. `touches` are the last
    /// accesses to the resource.
    void record_last_accesses_to_memory(const MemoryPlacement& placement, AccessStateSet touches);
    /// Returns the last accesses of all earlier resources that overlap this placement in memory.
    AccessStateSet unfinished_accesses_in_memory(const MemoryPlacement& placement) const;

private:
    /// A segment tree over the pieces between the ends of all placements. Node n has the children
    /// 2n and 2n + 1.
    struct HeapAccessSegmentTree {
        std::vector<std::uint64_t> ends;   // sorted, each once
        std::vector<AccessStateSet> whole; // accesses in all of the node
        std::vector<AccessStateSet> below; // accesses in some part of the node
        std::size_t leaf(std::uint64_t offset) const;
        void resize_tree();
    };
    std::vector<HeapAccessSegmentTree> heaps_;
};

} // namespace catoptric::graph
