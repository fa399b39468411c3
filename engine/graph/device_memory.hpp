#pragma once

#include "graph/physical.hpp"
#include "graph/plan.hpp"

namespace catoptric::graph {

/// Returns functions that tell how much memory the device needs for images and buffers of a graph.
/// The device must outlive them.
Sizer sizer_of(const gpu::Device& device);

/// Creates a buffer of the graph without memory.
gpu::UniqueBuffer make_buffer(const gpu::Device& device, const BufferDesc& desc);

/// An image with its own memory.
struct OwnedImage {
    gpu::UniqueMemory memory; // destroyed after the image
    Physical image;
};
/// Creates an image to be imported into graphs. Its contents are undefined.
OwnedImage make_image(const gpu::Device& device, const ImageDesc& desc);

} // namespace catoptric::graph
