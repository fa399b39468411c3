#pragma once

#include "gpu/vulkan.hpp"
#include "graph/plan.hpp"

namespace catoptric::graph {

/// The pipeline stages and kinds of memory access of an access to an image or buffer.
struct SyncScope {
    VkPipelineStageFlags2 stages = VK_PIPELINE_STAGE_2_NONE;
    VkAccessFlags2 access = VK_ACCESS_2_NONE;
};
SyncScope sync_scope_of_access(const AccessState& touch);

/// Returns the layout that an image has during this use.
VkImageLayout image_layout_of_use(ResourceUse use);

} // namespace catoptric::graph
