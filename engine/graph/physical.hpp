#pragma once

#include "gpu/device.hpp"
#include "gpu/shader.hpp"
#include "graph/graph.hpp"

#include <map>
#include <tuple>

namespace catoptric::graph {

/// An image of the graph on the device, with the views that were asked for.
struct Physical {
    ImageDesc desc;
    gpu::UniqueImage owned; ///< empty where somebody else owns the image
    VkImage image = VK_NULL_HANDLE;

    /// Of the part's layers and mips.
    VkImageView view(const gpu::Device& device, gpu::ImageShape shape, const Image& part);

private:
    using Key =
        std::tuple<gpu::ImageShape, std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;
    std::map<Key, gpu::UniqueImageView> views_;
};

/// The create info for any image of the graph: every use that its format allows.
VkImageCreateInfo image_create_info(const ImageDesc& desc);
Physical make_physical(const gpu::Device& device, const ImageDesc& desc);
/// Somebody else's image, to be imported; it must outlive this, which holds its views.
Physical adopt(const ImageDesc& desc, VkImage image);
VkImageAspectFlags aspect_of(Format format);
/// Of the part's layers and its first mip, from or to the beginning of a buffer.
VkBufferImageCopy copy_region(const ImageDesc& desc, const Image& part);

} // namespace catoptric::graph
