#include "graph/memory_users.hpp"

#include <bit>

namespace catoptric::graph {

namespace {

bool shares_memory(const MemoryPlacement& placement) {
    return placement.used && !placement.alone && placement.bytes > 0;
}

} // namespace

MemoryUsers::MemoryUsers(const GraphPlan& plan) : heaps_(plan.heap_bytes.size()) {
    const auto add = [&](const std::vector<MemoryPlacement>& placements) {
        for (const MemoryPlacement& placement : placements) {
            if (!shares_memory(placement)) continue;
            std::vector<std::uint64_t>& ends = heaps_[placement.heap].ends;
            ends.push_back(placement.offset);
            ends.push_back(placement.offset + placement.bytes);
        }
    };
    add(plan.images);
    add(plan.buffers);
    for (SegmentTree& heap : heaps_) heap.resize_tree();
}

void MemoryUsers::SegmentTree::resize_tree() {
    std::ranges::sort(ends);
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    whole.assign(2 * std::bit_ceil(ends.size()), 0);
    below = whole;
}

std::size_t MemoryUsers::SegmentTree::leaf(std::uint64_t offset) const {
    return static_cast<std::size_t>(std::ranges::lower_bound(ends, offset) - ends.begin()) +
           whole.size() / 2;
}

void MemoryUsers::record(const MemoryPlacement& placement, AccessSet touches) {
    if (!shares_memory(placement)) return;
    SegmentTree& heap = heaps_[placement.heap];
    const std::size_t first = heap.leaf(placement.offset);
    const std::size_t end = heap.leaf(placement.offset + placement.bytes);
    for (std::size_t a = first, b = end; a < b; a /= 2, b /= 2) {
        if (a % 2 == 1) heap.whole[a] |= touches, heap.below[a] |= touches, ++a;
        if (b % 2 == 1) --b, heap.whole[b] |= touches, heap.below[b] |= touches;
    }
    for (std::size_t node = first / 2; node > 0; node /= 2) heap.below[node] |= touches;
    for (std::size_t node = (end - 1) / 2; node > 0; node /= 2) heap.below[node] |= touches;
}

AccessSet MemoryUsers::unfinished_accesses(const MemoryPlacement& placement) const {
    if (!shares_memory(placement)) return 0;
    const SegmentTree& heap = heaps_[placement.heap];
    const std::size_t first = heap.leaf(placement.offset);
    const std::size_t end = heap.leaf(placement.offset + placement.bytes);
    AccessSet touches = 0;
    for (std::size_t a = first, b = end; a < b; a /= 2, b /= 2) {
        if (a % 2 == 1) touches |= heap.below[a++];
        if (b % 2 == 1) touches |= heap.below[--b];
    }
    for (std::size_t node = first / 2; node > 0; node /= 2) touches |= heap.whole[node];
    for (std::size_t node = (end - 1) / 2; node > 0; node /= 2) touches |= heap.whole[node];
    return touches;
}

} // namespace catoptric::graph
