#pragma once

#include "graph/compiled_graph.hpp"

#include <functional>
#include <map>
#include <string>

namespace catoptric::graph {

/// Images that earlier frames left for later frames, by name. The device must outlive them.
using RetainedImages = std::map<std::string, PersistentImage>;

/// Makes the images that outlive frames, and follows what frames do to them.
class PersistentImages {
public:
    /// `all`: where the images are; must outlive this object.
    PersistentImages(gpu::GpuDevice& device, RetainedImages& all)
        : image_device_(device), all_(all) {}

    /// Called before an image is destroyed that frames in flight and planned graphs may use.
    using ReplaceHandler = std::function<void(const PersistentImage&)>;
    /// Finds or makes the persistent images that the planned graph uses. An image whose description
    /// or lifetime differs is replaced, after a call of `release`.
    void find_or_create_images(CompiledRenderGraph& shape, const ReplaceHandler& release);
    /// Stores the content hashes that the submitted frame sets.
    void store_content_hashes(const Graph& graph, const CompiledRenderGraph& shape);
    /// Swaps the two copies of each image that has a `previous`: the frame just submitted becomes
    /// the last frame.
    void swap_previous_copies(const CompiledRenderGraph& shape);
    /// Drops all images. Must not be called while frames are in flight.
    void release_all_images() { all_.clear(); }
    GraphHistory make_history() const;
    /// Returns the bytes of device memory that are allocated.
    std::uint64_t allocated_device_bytes() const;

private:
    void create_image(const ImageDesc& desc, PersistentImage& kept);
    PersistentImage& find_or_create_images(const ImageDesc& desc, ImageLifetime lifetime,
                                           const ReplaceHandler& release);

    gpu::GpuDevice& image_device_;
    RetainedImages& all_;
};

} // namespace catoptric::graph
