#pragma once

#include "gpu/device.hpp"
#include "gpu/shader.hpp"
#include "graph/graph.hpp"

#include <map>
#include <tuple>

namespace catoptric::graph {

/// A device image of the graph, with the views that were asked for.
struct PhysicalImage {
    ImageDesc desc;
    gpu::UniqueImage owned; ///< empty if the image is owned outside the runner
    VkImage image = VK_NULL_HANDLE;

    /// Each view is made once.
    VkImageView view(const gpu::Device& device, gpu::ImageViewType shape, const ImageHandle& part);

private:
    using ViewKey =
        std::tuple<gpu::ImageViewType, std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;
    std::map<ViewKey, gpu::UniqueImageView> views_;
};

/// Returns the create info of an image of the graph, with every usage that its format allows.
VkImageCreateInfo image_create_info(const ImageDesc& desc);
PhysicalImage make_physical_image(const gpu::Device& device, const ImageDesc& desc);
/// Wraps an image that is owned elsewhere, to be imported into graphs. The image must outlive the
/// result, which holds its views.
PhysicalImage wrap_image(const ImageDesc& desc, VkImage image);
VkImageAspectFlags image_aspect(TexelFormat format);
/// Returns the region that copies the part's layers and first mip from or to the start of a buffer.
VkBufferImageCopy copy_region(const ImageDesc& desc, const ImageHandle& part);

} // namespace catoptric::graph
