#include "graph/memory_placement.hpp"

#include <algorithm>
#include <tuple>

namespace catoptric::graph {

namespace {

struct ResourceToPlaceInHeap {
    MemoryPlacement* placement = nullptr;
    int rank = 0; ///< order in the heap: 0 shares, 1 is an output, 2 outlives the frame
};

std::uint64_t align_up_to_multiple(std::uint64_t value, std::uint64_t alignment) {
    return (value + alignment - 1) / alignment * alignment;
}

std::uint64_t end_of_placement(const MemoryPlacement& p) { return p.offset + p.bytes; }

/// The images and buffers that are placed at one memory offset. No two of them are in use at the
/// same time.
struct HeapShelf {
    struct PassLifetimeInterval {
        std::uint32_t first, last;
        std::uint64_t end; ///< offset in the heap
    };
    std::uint64_t offset = 0;
    std::vector<PassLifetimeInterval> lives; ///< lifetimes of passes, the earliest first

    /// Returns the end, in the heap, of the memory of all resources at this offset that are in use
    /// at the same time as `placement`; 0 if there are none.
    std::uint64_t end_of_overlapping_memory(const MemoryPlacement& placement) const {
        auto life = std::ranges::lower_bound(lives, placement.first, {},
                                             &PassLifetimeInterval::last);
        std::uint64_t end = 0;
        for (; life != lives.end() && life->first <= placement.last; ++life)
            end = std::max(end, life->end);
        return end;
    }
};
using HeapShelves = std::vector<HeapShelf>; // shelves of one heap, from the lowest

/// Returns the lowest aligned offset at which `item` overlaps no resource that is in use at the
/// same time.
std::uint64_t find_first_fitting_offset(const ResourceToPlaceInHeap& item,
                                        const HeapShelves& shelves) {
    std::uint64_t offset = 0;
    for (const HeapShelf& shelf : shelves) {
        if (offset + item.placement->bytes <= shelf.offset) break;
        const std::uint64_t end = shelf.end_of_overlapping_memory(*item.placement);
        if (end > 0)
            offset = std::max(offset, align_up_to_multiple(end, item.placement->alignment));
    }
    return offset;
}

void place_resource_at_shared_offset(HeapShelves& shelves, const MemoryPlacement& placement) {
    auto shelf = std::ranges::lower_bound(shelves, placement.offset, {}, &HeapShelf::offset);
    if (shelf == shelves.end() || shelf->offset != placement.offset)
        shelf = shelves.insert(shelf, {placement.offset, {}});
    const HeapShelf::PassLifetimeInterval life{placement.first, placement.last,
                                               end_of_placement(placement)};
    const auto after = std::ranges::upper_bound(shelf->lives, life.first, {},
                                                &HeapShelf::PassLifetimeInterval::first);
    shelf->lives.insert(after, life);
}

ResourceToPlaceInHeap make_resource_to_place(MemoryPlacement& placement,
                                             const MemoryRequirements& wanted, Lifetime lifetime) {
    const std::uint64_t alignment = std::max<std::uint64_t>(wanted.alignment, 1);
    placement.heap = wanted.heap;
    placement.alignment = alignment;
    placement.bytes = lifetime == Lifetime::previous
                          ? 2 * align_up_to_multiple(wanted.bytes, alignment)
                          : wanted.bytes;
    return {&placement, lifetime != Lifetime::frame ? 2 : placement.alone ? 1 : 0};
}

/// Returns the used resources by rank, then the largest first, so that small ones fill the gaps.
std::vector<ResourceToPlaceInHeap>
list_resources_largest_first(const Graph& graph, const MemoryRequirementQueries& sizer,
                             GraphPlan& plan) {
    std::vector<ResourceToPlaceInHeap> items;
    for (std::uint32_t i = 0; i < plan.images.size(); ++i)
        if (plan.images[i].used && graph.image_lifetime(i) != Lifetime::imported)
            items.push_back(make_resource_to_place(
                plan.images[i], sizer.image(graph.list_images()[i]), graph.image_lifetime(i)));
    for (std::uint32_t b = 0; b < plan.buffers.size(); ++b)
        if (plan.buffers[b].used && !graph.is_imported({b}))
            items.push_back(make_resource_to_place(
                plan.buffers[b], sizer.buffer(graph.list_buffers()[b]), graph.buffer_lifetime(b)));
    std::ranges::stable_sort(
        items, [](const ResourceToPlaceInHeap& a, const ResourceToPlaceInHeap& b) {
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

void find_resource_lifetimes(const Graph& graph, const GraphAccesses& all, GraphPlan& plan) {
    plan.images.assign(graph.list_images().size(), {});
    plan.buffers.assign(graph.list_buffers().size(), {});
    for (std::uint32_t position = 0; position < plan.passes.size(); ++position)
        for (const ResourceAccess& a : all.accesses_of_pass(plan.passes[position].pass))
            extend_lifetime(a.is_buffer ? plan.buffers[a.id] : plan.images[a.id], position);
    for (std::uint32_t i = 0; i < plan.images.size(); ++i)
        plan.images[i].alone = plan.images[i].used && graph.image_lifetime(i) != Lifetime::frame;
    for (std::uint32_t b = 0; b < plan.buffers.size(); ++b)
        plan.buffers[b].alone = plan.buffers[b].used && graph.buffer_lifetime(b) != Lifetime::frame;
    for (const ImageHandle& image : graph.list_output_images()) plan.images[image.id].alone = true;
    for (const BufferHandle& buffer : graph.list_output_buffers())
        plan.buffers[buffer.id].alone = true;
}

void place_resources_in_memory(const Graph& graph, const MemoryRequirementQueries& sizer,
                               GraphPlan& plan) {
    std::vector<std::uint64_t> unshared; // bytes of each heap if no memory were shared
    std::vector<HeapShelves> shelves;    // allocator of each heap
    for (const ResourceToPlaceInHeap& item : list_resources_largest_first(graph, sizer, plan)) {
        MemoryPlacement& placement = *item.placement;
        if (placement.heap >= unshared.size()) {
            unshared.resize(placement.heap + 1, 0);
            shelves.resize(placement.heap + 1);
            plan.heap_bytes.resize(placement.heap + 1, 0);
        }
        std::uint64_t& heap = plan.heap_bytes[placement.heap];
        placement.offset = placement.alone
                               ? align_up_to_multiple(heap, item.placement->alignment)
                               : find_first_fitting_offset(item, shelves[placement.heap]);
        heap = std::max(heap, end_of_placement(placement));
        std::uint64_t& alone = unshared[placement.heap];
        alone = align_up_to_multiple(alone, item.placement->alignment) + placement.bytes;
        if (!placement.alone) place_resource_at_shared_offset(shelves[placement.heap], placement);
    }
    for (const std::uint64_t bytes : plan.heap_bytes) plan.bytes += bytes;
    for (const std::uint64_t bytes : unshared) plan.bytes_unshared += bytes;
}

} // namespace catoptric::graph
