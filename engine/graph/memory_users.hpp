#pragma once

#include "graph/touches.hpp"

namespace catoptric::graph {

/// Who touched which part of the shared memory last, while a frame is walked from top to bottom.
/// Each call costs the logarithm of the number of placements.
class MemoryUsers {
public:
    explicit MemoryUsers(const Plan& plan);
    /// What lay there is not touched again; `touches` were its last.
    void leave(const Placement& placement, TouchSet touches);
    /// All touches that were left in this memory.
    TouchSet left_in(const Placement& placement) const;

private:
    /// A tree over the pieces between all ends of placements; node n has children 2n and 2n + 1.
    struct Heap {
        std::vector<std::uint64_t> ends; // sorted, each once
        std::vector<TouchSet> whole;     // left in all of the node
        std::vector<TouchSet> below;     // left in some of it
        std::size_t leaf(std::uint64_t offset) const;
        void size();
    };
    std::vector<Heap> heaps_;
};

} // namespace catoptric::graph
