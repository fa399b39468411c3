#pragma once

#include "graph/physical.hpp"
#include "graph/plan.hpp"

namespace catoptric::graph {

/// Memory that a device wants for images and buffers of the graph. The device must outlive it.
Sizer sizer_of(const gpu::Device& device);

/// A buffer of the graph without memory.
gpu::UniqueBuffer make_buffer(const gpu::Device& device, const BufferDesc& desc);

/// An image with memory of its own.
struct OwnedImage {
    gpu::UniqueMemory memory; // destroyed after the image
    Physical image;
};
/// For whoever imports it into graphs; its contents are undefined.
OwnedImage make_image(const gpu::Device& device, const ImageDesc& desc);

} // namespace catoptric::graph
