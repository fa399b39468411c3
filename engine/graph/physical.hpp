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
    gpu::UniqueImage image;

    VkImageView view(const gpu::Device& device, gpu::ImageShape shape, std::uint32_t first_layer,
                     std::uint32_t layer_count);

private:
    using Key = std::tuple<gpu::ImageShape, std::uint32_t, std::uint32_t>;
    std::map<Key, gpu::UniqueImageView> views_;
};

/// The create info for any image of the graph: every use that its format allows.
VkImageCreateInfo image_create_info(const ImageDesc& desc);
Physical make_physical(const gpu::Device& device, const ImageDesc& desc);
VkImageAspectFlags aspect_of(Format format);

} // namespace catoptric::graph
