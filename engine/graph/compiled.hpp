#pragma once

#include "graph/physical.hpp"
#include "graph/plan.hpp"

#include <array>
#include <span>

namespace catoptric::graph {

/// Frames that may be on their way at once.
constexpr std::uint32_t kMostInFlight = 3;

/// An image that outlives the frame.
struct PersistentImage {
    Lifetime lifetime = Lifetime::previous;
    std::vector<Physical> copies; ///< with `previous` this frame's and the last one's; else one
    gpu::UniqueMemory memory;
    std::uint64_t bytes = 0; ///< of it
    std::size_t last = 0;    ///< index of the copy that holds the last frame
    bool valid = false;      ///< there was one
    ContentHashes stamps;    ///< of a kept one

    Physical& copy(bool previous) {
        return lifetime == Lifetime::persistent ? copies[0] : copies[previous ? last : 1 - last];
    }
};

/// Images and buffers of a shape by their number in the graph; those that are elsewhere are empty.
struct Resources {
    std::vector<Physical> images;
    std::vector<gpu::UniqueBuffer> buffers;
    bool made = false;
};

/// A shape with its plan and, once it has run, what it runs with.
struct Compiled {
    Graph outline; ///< without bodies
    std::uint64_t hash = 0;
    Plan plan;
    bool ran = false; ///< it has claims on memory

    Resources shared;                         ///< what lives within a frame
    std::array<Resources, kMostInFlight> own; ///< what is wanted of a frame, one for each slot
    std::vector<PersistentImage*> kept;       ///< by image; of the frame that was submitted last

    /// Whether the image has memory of its own, through frames. A kept one may be read after a
    /// frame whose passes do not touch it.
    bool is_persistent(std::uint32_t image) const {
        const Lifetime lifetime = outline.lifetime(image);
        return lifetime == Lifetime::persistent ||
               (lifetime == Lifetime::previous && plan.images[image].used);
    }
    /// Whether its memory is the runner's.
    bool is_owned(std::uint32_t image) const {
        return plan.images[image].used && outline.lifetime(image) != Lifetime::imported;
    }
    bool is_owned(Buffer buffer) const {
        return plan.buffers[buffer.id].used && !outline.is_imported(buffer);
    }
    /// Where a frame of the slot has the image.
    Physical& physical(Image image, std::size_t slot) {
        if (PersistentImage* const k = kept[image.id]) return k->copy(image.previous);
        return (plan.images[image.id].alone ? own[slot] : shared).images[image.id];
    }
    VkBuffer buffer(Buffer buffer, std::size_t slot) const {
        return (plan.buffers[buffer.id].alone ? own[slot] : shared).buffers[buffer.id];
    }
};

} // namespace catoptric::graph
