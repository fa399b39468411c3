#pragma once

#include "graph/graph.hpp"

#include <functional>

namespace catoptric::graph {

/// Limits of a device. A graph that exceeds a limit is refused.
struct GraphLimits {
    std::uint32_t max_size_2d = 16384;
    std::uint32_t max_size_cube = 16384;
    std::uint32_t max_layers = 2048;
    std::uint32_t max_framebuffer_layers = 2048;
    std::uint64_t max_memory = ~std::uint64_t{0};
    std::uint64_t max_allocation = ~std::uint64_t{0}; ///< bytes of one allocation
};

/// Memory that a device needs for one image or buffer. Resources with different `heap` never share
/// memory.
struct MemoryRequirements {
    std::uint64_t bytes = 0;
    std::uint64_t alignment = 1;
    std::uint32_t heap = 0;
};
struct MemorySizer {
    std::function<MemoryRequirements(const ImageDesc&)> image;
    std::function<MemoryRequirements(const BufferDesc&)> buffer;
};
/// Returns sizes without a device, for tests and for `graph`: texels times bytes, 256-byte aligned,
/// one heap.
MemorySizer default_sizer();

/// The last or the next access to a resource. With `nothing` the contents of the resource do not
/// matter.
struct AccessState {
    bool nothing = true;
    ResourceUse use = ResourceUse::sampled;
    bool write = false;
    /// Whether a raster pass makes the access, and not a compute or copy pass. Selects shader
    /// stages of barriers.
    bool raster = false;
    friend bool operator==(const AccessState&, const AccessState&) = default;
};

/// One dependency between passes. The accesses `before` and `shared` are complete and visible to
/// the access `after`. The image changes from the layout of `before` to the layout of `after`.
struct PlannedBarrier {
    bool is_buffer = false;
    std::uint32_t id = 0;
    bool previous = false; ///< the contents in the last frame
    std::uint32_t first_layer = 0;
    std::uint32_t layer_count = 0;
    std::uint32_t first_mip = 0;
    std::uint32_t mip_count = 1;
    AccessState before; ///< `nothing`: the old contents are discarded
    AccessState after;
    /// Further accesses to wait for: other readers before a write or a change of layout. If
    /// `before.nothing` is set, also the last accesses to earlier resources in the same memory.
    std::vector<AccessState> shared;
};

struct PlannedPass {
    std::uint32_t pass = 0;               ///< index of the pass in Graph::passes()
    std::vector<PlannedBarrier> barriers; ///< executed before the pass
    /// Bit i is set if the result in attachment Pass::images[i] is never read and need not be
    /// stored.
    std::uint32_t unread = 0;
};

/// Where an image or buffer lies in memory, and its first and last pass as positions in
/// `GraphPlan::passes`.
struct MemoryPlacement {
    bool used = false;
    bool alone = false; ///< outlives the frame or is an output: shares no memory
    std::uint32_t first = 0, last = 0;
    std::uint32_t heap = 0;
    /// Bytes in the heap. Resources with `alone` set start after the shared part. A resource with a
    /// `previous` has two copies, at `offset` and at `offset + bytes / 2`. Imported resources take
    /// no bytes.
    std::uint64_t offset = 0, bytes = 0;
    std::uint64_t alignment = 1;
};

struct CulledPass {
    std::uint32_t pass = 0;
    std::string reason;
};

struct GraphPlan {
    std::vector<PlannedPass> passes;
    /// Barriers after the final pass, with the use that each resource is left for:
    /// - outputs: copy_from
    /// - all layers of images with a `previous`: sampled, also if they are outputs
    /// - touched layers of persistent images: sampled
    /// - imported images: as the import says
    /// - touched buffers that are imported or have a `previous`: copy_from
    ///
    /// A layer gets a barrier even if its layout is right already. `after` means every stage, also
    /// of the next frame, where `previous` is sampled without a barrier.
    std::vector<PlannedBarrier> last;
    std::vector<CulledPass> culled;
    std::vector<MemoryPlacement> images;   ///< one per Graph::images()
    std::vector<MemoryPlacement> buffers;  ///< one per Graph::buffers()
    std::vector<std::uint64_t> heap_bytes; ///< size of each heap
    std::uint64_t bytes = 0;               ///< sum over all heaps
    std::uint64_t bytes_unshared = 0;      ///< the sum if no memory were shared
    int scene_passes = 0;                  ///< executed passes with PassPurpose::scene
};

/// Validates, culls, places and orders a graph. Needs no device. Passes run in order of
/// declaration. Throws `internal` for an invalid graph, naming pass, image and both uses. Throws
/// `exhausted` over a limit, naming the limit, the required and the allowed number. Costs O(n log
/// n) in the uses of all passes, however many layers they have.
GraphPlan plan_graph(const Graph& graph, const GraphLimits& limits, const MemorySizer& sizer);

} // namespace catoptric::graph
