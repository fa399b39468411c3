#pragma once

#include "graph/physical.hpp"
#include "graph/plan.hpp"

#include <array>
#include <span>

namespace catoptric::graph {

/// The most frames that may be in flight at once.
constexpr std::uint32_t kMaxFramesInFlight = 3;

/// An image that outlives the frame: a persistent image, or one with a `previous`.
struct PersistentImage {
    Lifetime lifetime = Lifetime::previous;
    /// Device images: this frame's and the last frame's if the image has a `previous`, else one.
    std::vector<PhysicalImage> copies;
    gpu::UniqueMemory memory;
    std::uint64_t bytes = 0; ///< bytes of `memory`
    std::size_t last = 0;    ///< index of the copy that holds the last frame
    bool valid = false;      ///< whether a last frame exists
    LayerHashes stamps;      ///< content hashes of a persistent image

    PhysicalImage& copy(bool previous) {
        return lifetime == Lifetime::persistent ? copies[0] : copies[previous ? last : 1 - last];
    }
};

/// A buffer with a `previous`.
struct PersistentBuffer {
    BufferDesc desc;
    std::array<gpu::UniqueBuffer, 2> copies; ///< this frame's and the last frame's
    gpu::UniqueMemory memory;
    std::uint64_t bytes = 0; ///< bytes of `memory`
    std::size_t last = 0;    ///< index of the copy that holds the last frame
    bool valid = false;      ///< whether a last frame exists
};

/// Device images and buffers of a graph, indexed by their number in the graph. Entries are empty if
/// their memory is owned elsewhere.
struct GraphResources {
    std::vector<PhysicalImage> images;
    std::vector<gpu::UniqueBuffer> buffers;
    bool made = false;
};

/// A planned graph. After its first frame, it also has the images and buffers with which its frames
/// run.
struct CompiledGraph {
    Graph outline; ///< the graph without the passes' callbacks
    std::uint64_t hash = 0;
    GraphPlan plan;
    /// Whether a frame with this plan has run. Only such plans count for the size of memory.
    bool ran = false;

    GraphResources shared; ///< resources that live within a frame
    std::array<GraphResources, kMaxFramesInFlight>
        own; ///< outputs of a frame, a copy for each slot
    /// For each image number, the image that outlives frames, as the last submitted frame used it;
    /// null for other images.
    std::vector<PersistentImage*> kept;
    std::vector<PersistentBuffer*> kept_buffers; ///< the same for each buffer number

    /// Returns whether the image has its own memory across frames. A persistent image always does:
    /// it may be read after a frame whose passes do not touch it.
    bool outlives_frames(std::uint32_t image) const {
        const Lifetime lifetime = outline.image_lifetime(image);
        return lifetime == Lifetime::persistent ||
               (lifetime == Lifetime::previous && plan.images[image].used);
    }
    bool outlives_frames(BufferHandle buffer) const {
        return outline.buffer_lifetime(buffer.id) == Lifetime::previous &&
               plan.buffers[buffer.id].used;
    }
    /// Forgets the resources that outlive frames.
    void release_retained() {
        kept.assign(kept.size(), nullptr);
        kept_buffers.assign(kept_buffers.size(), nullptr);
    }
    /// Returns whether the image is used and the runner owns its memory.
    bool owns_memory(std::uint32_t image) const {
        return plan.images[image].used && outline.image_lifetime(image) != Lifetime::imported;
    }
    bool owns_memory(BufferHandle buffer) const {
        return plan.buffers[buffer.id].used && !outline.is_imported(buffer);
    }
    /// Returns the device image for `image` in a frame of this slot (frame in flight).
    PhysicalImage& physical_image(ImageHandle image, std::size_t slot) {
        if (PersistentImage* const k = kept[image.id]) return k->copy(image.previous);
        return (plan.images[image.id].alone ? own[slot] : shared).images[image.id];
    }
    VkBuffer vulkan_buffer(BufferHandle buffer, std::size_t slot) const {
        if (const PersistentBuffer* const k = kept_buffers[buffer.id])
            return k->copies[buffer.previous ? k->last : 1 - k->last];
        return (plan.buffers[buffer.id].alone ? own[slot] : shared).buffers[buffer.id];
    }
};

} // namespace catoptric::graph
