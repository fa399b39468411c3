#include "graph/memory_placement.hpp"

#include <algorithm>
#include <tuple>

namespace catoptric::graph {

namespace {

struct HeapItem {
    MemoryPlacement* placement = nullptr;
    int rank = 0; ///< order in the heap: 0 shares, 1 is an output, 2 outlives the frame
};

std::uint64_t align_up(std::uint64_t value, std::uint64_t alignment) {
    return (value + alignment - 1) / alignment * alignment;
}

std::uint64_t placement_end(const MemoryPlacement& p) { return p.offset + p.bytes; }

/// The images and buffers that are placed at one memory offset. No two of them are in use at the
/// same time.
struct HeapShelf {
    struct PassInterval {
        std::uint32_t first, last;
        std::uint64_t end; ///< offset in the heap
    };
    std::uint64_t offset = 0;
    std::vector<PassInterval> lives; ///< lifetimes of passes, the earliest first

    /// Returns the end, in the heap, of the memory of all resources at this offset that are in use
    /// at the same time as `placement`; 0 if there are none.
    std::uint64_t overlap_end(const MemoryPlacement& placement) const {
        auto life = std::ranges::lower_bound(lives, placement.first, {}, &PassInterval::last);
        std::uint64_t end = 0;
        for (; life != lives.end() && life->first <= placement.last; ++life)
            end = std::max(end, life->end);
        return end;
    }
};
using HeapShelves = std::vector<HeapShelf>; // shelves of one heap, from the lowest

/// Returns the lowest aligned offset at which `item` overlaps no resource that is in use at the
/// same time.
std::uint64_t first_fit(const HeapItem& item, const HeapShelves& shelves) {
    std::uint64_t offset = 0;
    for (const HeapShelf& shelf : shelves) {
        if (offset + item.placement->bytes <= shelf.offset) break;
        const std::uint64_t end = shelf.overlap_end(*item.placement);
        if (end > 0) offset = std::max(offset, align_up(end, item.placement->alignment));
    }
    return offset;
}

void add_to_shelf(HeapShelves& shelves, const MemoryPlacement& placement) {
    auto shelf = std::ranges::lower_bound(shelves, placement.offset, {}, &HeapShelf::offset);
    if (shelf == shelves.end() || shelf->offset != placement.offset)
        shelf = shelves.insert(shelf, {placement.offset, {}});
    const HeapShelf::PassInterval life{placement.first, placement.last, placement_end(placement)};
    const auto after = std::ranges::upper_bound(shelf->lives, life.first, {},
                                                &HeapShelf::PassInterval::first);
    shelf->lives.insert(after, life);
}

HeapItem make_item(MemoryPlacement& placement, const MemoryRequirements& wanted,
                   Lifetime lifetime) {
    const std::uint64_t alignment = std::max<std::uint64_t>(wanted.alignment, 1);
    placement.heap = wanted.heap;
    placement.alignment = alignment;
    placement.bytes = lifetime == Lifetime::previous ? 2 * align_up(wanted.bytes, alignment)
                                                     : wanted.bytes;
    return {&placement, lifetime != Lifetime::frame ? 2 : placement.alone ? 1 : 0};
}

/// Returns the used resources by rank, then the largest first, so that small ones fill the gaps.
std::vector<HeapItem> largest_first(const Graph& graph, const MemorySizer& sizer, GraphPlan& plan) {
    std::vector<HeapItem> items;
    for (std::uint32_t i = 0; i < plan.images.size(); ++i)
        if (plan.images[i].used && graph.image_lifetime(i) != Lifetime::imported)
            items.push_back(
                make_item(plan.images[i], sizer.image(graph.images()[i]), graph.image_lifetime(i)));
    for (std::uint32_t b = 0; b < plan.buffers.size(); ++b)
        if (plan.buffers[b].used && !graph.is_imported({b}))
            items.push_back(make_item(plan.buffers[b], sizer.buffer(graph.buffers()[b]),
                                      graph.buffer_lifetime(b)));
    std::ranges::stable_sort(items, [](const HeapItem& a, const HeapItem& b) {
        return std::tuple(a.rank, b.placement->bytes) < std::tuple(b.rank, a.placement->bytes);
    });
    return items;
}

void extend_lifetime(MemoryPlacement& placement, std::uint32_t position) {
    if (!placement.used) placement.first = position;
    placement.used = true;
    placement.last = position;
}

} // namespace

void find_lifetimes(const Graph& graph, const GraphAccesses& all, GraphPlan& plan) {
    plan.images.assign(graph.images().size(), {});
    plan.buffers.assign(graph.buffers().size(), {});
    for (std::uint32_t position = 0; position < plan.passes.size(); ++position)
        for (const ResourceAccess& a : all.of_pass(plan.passes[position].pass))
            extend_lifetime(a.is_buffer ? plan.buffers[a.id] : plan.images[a.id], position);
    for (std::uint32_t i = 0; i < plan.images.size(); ++i)
        plan.images[i].alone = plan.images[i].used && graph.image_lifetime(i) != Lifetime::frame;
    for (std::uint32_t b = 0; b < plan.buffers.size(); ++b)
        plan.buffers[b].alone = plan.buffers[b].used && graph.buffer_lifetime(b) != Lifetime::frame;
    for (const ImageHandle& image : graph.output_images()) plan.images[image.id].alone = true;
    for (const BufferHandle& buffer : graph.output_buffers()) plan.buffers[buffer.id].alone = true;
}

void place_resources(const Graph& graph, const MemorySizer& sizer, GraphPlan& plan) {
    std::vector<std::uint64_t> unshared; // bytes of each heap if no memory were shared
    std::vector<HeapShelves> shelves;    // allocator of each heap
    for (const HeapItem& item : largest_first(graph, sizer, plan)) {
        MemoryPlacement& placement = *item.placement;
        if (placement.heap >= unshared.size()) {
            unshared.resize(placement.heap + 1, 0);
            shelves.resize(placement.heap + 1);
            plan.heap_bytes.resize(placement.heap + 1, 0);
        }
        std::uint64_t& heap = plan.heap_bytes[placement.heap];
        placement.offset = placement.alone ? align_up(heap, item.placement->alignment)
                                           : first_fit(item, shelves[placement.heap]);
        heap = std::max(heap, placement_end(placement));
        std::uint64_t& alone = unshared[placement.heap];
        alone = align_up(alone, item.placement->alignment) + placement.bytes;
        if (!placement.alone) add_to_shelf(shelves[placement.heap], placement);
    }
    for (const std::uint64_t bytes : plan.heap_bytes) plan.bytes += bytes;
    for (const std::uint64_t bytes : unshared) plan.bytes_unshared += bytes;
}

} // namespace catoptric::graph
