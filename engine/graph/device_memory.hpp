#pragma once

#include "graph/physical.hpp"
#include "graph/plan.hpp"

namespace catoptric::graph {

/// Returns functions that tell how much memory the device needs for images and buffers of a graph.
/// The device must outlive the returned functions.
MemorySizer device_sizer(const gpu::Device& device);

gpu::UniqueBuffer make_unbound_buffer(const gpu::Device& device, const BufferDesc& desc);

struct ImageWithMemory {
    gpu::UniqueMemory memory; // destroyed after the image
    PhysicalImage image;
};
/// The contents of the image are undefined.
ImageWithMemory make_importable_image(const gpu::Device& device, const ImageDesc& desc);

} // namespace catoptric::graph
