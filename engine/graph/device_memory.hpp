#pragma once

#include "graph/physical.hpp"
#include "graph/plan.hpp"

namespace catoptric::graph {

/// Returns functions that tell how much memory the device needs for images and buffers of a graph.
/// The device must outlive the returned functions.
MemorySizer device_sizer(const gpu::Device& device);

/// Creates a buffer of the graph without memory.
gpu::UniqueBuffer make_unbound_buffer(const gpu::Device& device, const BufferDesc& desc);

/// An image with its own memory.
struct ImageWithMemory {
    gpu::UniqueMemory memory; // destroyed after the image
    PhysicalImage image;
};
/// Creates an image to be imported into graphs. Its contents are undefined.
ImageWithMemory make_importable_image(const gpu::Device& device, const ImageDesc& desc);

} // namespace catoptric::graph
