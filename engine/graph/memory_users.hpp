#pragma once

#include "graph/touch_list.hpp"

namespace catoptric::graph {

/// Records the last accesses to each part of the shared memory, from the first pass of a frame to
/// the last. Each call takes O(log n) for n placements.
class MemoryUsers {
public:
    explicit MemoryUsers(const GraphPlan& plan);
    /// Records that no later pass uses the resource at this placement. `touches` are the last
    /// accesses to the resource.
    void record(const MemoryPlacement& placement, AccessSet touches);
    /// Returns the last accesses of all earlier resources that overlap this placement in memory.
    AccessSet unfinished_accesses(const MemoryPlacement& placement) const;

private:
    /// A segment tree over the pieces between the ends of all placements. Node n has the children
    /// 2n and 2n + 1.
    struct SegmentTree {
        std::vector<std::uint64_t> ends; // sorted, each once
        std::vector<AccessSet> whole;    // accesses in all of the node
        std::vector<AccessSet> below;    // accesses in some part of the node
        std::size_t leaf(std::uint64_t offset) const;
        void resize_tree();
    };
    std::vector<SegmentTree> heaps_;
};

} // namespace catoptric::graph
