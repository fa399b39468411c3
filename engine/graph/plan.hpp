#pragma once

#include "graph/graph.hpp"

#include <functional>

namespace catoptric::graph {

/// What a device allows; the plan refuses what is over it.
struct Limits {
    std::uint32_t max_size_2d = 16384;
    std::uint32_t max_size_cube = 16384;
    std::uint32_t max_layers = 2048;
    std::uint32_t max_framebuffer_layers = 2048;
    std::uint64_t max_memory = ~std::uint64_t{0};
    std::uint64_t max_allocation = ~std::uint64_t{0}; ///< bytes in one piece
};

/// Memory that a device wants for one image or buffer. Resources of different `heap` never share.
struct Requirements {
    std::uint64_t bytes = 0;
    std::uint64_t alignment = 1;
    std::uint32_t heap = 0;
};
struct Sizer {
    std::function<Requirements(const ImageDesc&)> image;
    std::function<Requirements(const BufferDesc&)> buffer;
};
/// Texels times bytes, 256-byte aligned, one heap: for tests and for `graph` without a device.
Sizer plain_sizer();

/// How something was last, or will next be, touched. `nothing` = contents do not matter.
struct Touch {
    bool nothing = true;
    Use use = Use::sampled;
    bool write = false;
    bool raster = false; ///< by a raster pass (which shader stages) or by a compute or copy pass
    friend bool operator==(const Touch&, const Touch&) = default;
};

/// One dependency: everything in `before` and `shared` is complete and visible to `after`, in the
/// layout that `after` wants. The layout until then is always that of `before`.
struct Barrier {
    bool is_buffer = false;
    std::uint32_t id = 0;
    bool previous = false; ///< the image's contents of the last frame
    std::uint32_t first_layer = 0;
    std::uint32_t layer_count = 0;
    std::uint32_t first_mip = 0;
    std::uint32_t mip_count = 1;
    Touch before; ///< `nothing`: the old contents are discarded
    Touch after;
    /// More to wait for: other readers before a write or a change of layout; with
    /// `before.nothing`, the last touches of what used the same memory earlier in the frame.
    std::vector<Touch> shared;
};

struct PlannedPass {
    std::uint32_t pass = 0;        ///< index into Graph::passes()
    std::vector<Barrier> barriers; ///< to be executed before it
    /// Bit i: nobody reads what attachment Pass::images[i] is left with, so it need not be stored.
    std::uint32_t unread = 0;
};

/// Where an image or buffer lies and when it is alive, in positions of `Plan::passes`.
struct Placement {
    bool used = false;
    bool alone = false; ///< outlives the frame or is wanted: shares no memory
    std::uint32_t first = 0, last = 0;
    std::uint32_t heap = 0;
    /// In the heap; `alone` ones start after the shared part. An image with a `previous` has two
    /// copies, at `offset` and at `offset + bytes / 2`. Imported ones take no bytes.
    std::uint64_t offset = 0, bytes = 0;
    std::uint64_t alignment = 1;
};

struct Culled {
    std::uint32_t pass = 0;
    std::string reason;
};

struct Plan {
    std::vector<PlannedPass> passes;
    /// After the final pass: wanted -> copy_from, all layers of what has a `previous` -> sampled
    /// (if both: sampled). One for each layer even where the layout is right already: `after` means
    /// every stage, of the next frame too, where `previous` is sampled without a barrier. What was
    /// touched of kept images -> sampled, all of imported ones -> as they are to be left.
    std::vector<Barrier> last;
    std::vector<Culled> culled;
    std::vector<Placement> images;         ///< one per Graph::images()
    std::vector<Placement> buffers;        ///< one per Graph::buffers()
    std::vector<std::uint64_t> heap_bytes; ///< size of each heap
    std::uint64_t bytes = 0;               ///< of all heaps together
    std::uint64_t bytes_unshared = 0;      ///< what it would be without sharing
    int scene_passes = 0;                  ///< executed passes tagged Tag::scene
};

/// Validates, culls, places and orders. Pure: no device. Passes run in order of declaration.
/// Throws `Failure::internal` naming pass, image and both uses for a graph that cannot mean
/// anything, `Failure::exhausted` naming the limit, the wanted and the allowed number.
/// Costs O(n log n) in the uses of all passes, however many layers they have.
Plan plan(const Graph& graph, const Limits& limits, const Sizer& sizer);

} // namespace catoptric::graph
