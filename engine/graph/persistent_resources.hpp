#pragma once

#include "graph/compiled_graph.hpp"

#include <functional>
#include <map>
#include <string>

namespace catoptric::graph {

/// Images and buffers that earlier frames left for later frames, by name. The device must outlive
/// them.
struct RetainedResources {
    std::map<std::string, PersistentImage> images;
    std::map<std::string, PersistentBuffer> buffers;
};

/// Makes the images and buffers that outlive frames, and follows what frames do to them.
class PersistentResources {
public:
    /// `all`: where they are; must outlive this object.
    PersistentResources(gpu::Device& device, RetainedResources& all) : device_(device), all_(all) {}

    /// Called before an image or a buffer is destroyed that frames in flight and planned graphs may
    /// use. The other pointer is null.
    using ReplaceHandler = std::function<void(const PersistentImage*, const PersistentBuffer*)>;
    /// Finds or makes the images and buffers that outlive the planned graph's frames. One whose
    /// description or lifetime differs is replaced, after a call of `release`.
    void find_or_create(CompiledGraph& shape, const ReplaceHandler& release);
    /// Stores the content hashes that the submitted frame sets.
    void store_hashes(const Graph& graph, const CompiledGraph& shape);
    /// Swaps the two copies of each image and buffer that has a `previous`: the frame just
    /// submitted becomes the last frame.
    void swap_copies(const CompiledGraph& shape);
    /// Drops all of them. Must not be called while frames are in flight.
    void release_all() { all_ = {}; }
    GraphHistory make_history() const;
    std::uint64_t allocated_bytes() const;

private:
    void create_image(const ImageDesc& desc, PersistentImage& kept);
    PersistentImage& find_or_create(const ImageDesc& desc, Lifetime lifetime,
                                    const ReplaceHandler& release);
    PersistentBuffer& find_or_create(const BufferDesc& desc, const ReplaceHandler& release);

    gpu::Device& device_;
    RetainedResources& all_;
};

} // namespace catoptric::graph
