#pragma once

#include "gpu/vulkan.hpp"
#include "graph/plan.hpp"

namespace catoptric::graph {

/// Returns the pipeline stages and kinds of memory access of an access to an image or buffer.
gpu::AccessScope sync_scope(const AccessState& access);

VkImageLayout image_layout(ResourceUse use);

} // namespace catoptric::graph
