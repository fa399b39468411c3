#pragma once

#include "gpu/vulkan.hpp"
#include "graph/plan.hpp"

namespace catoptric::graph {

/// What a touch means to the device.
struct Scope {
    VkPipelineStageFlags2 stages = VK_PIPELINE_STAGE_2_NONE;
    VkAccessFlags2 access = VK_ACCESS_2_NONE;
};
Scope scope_of(const Touch& touch);

/// The layout that an image is in while it is used like this.
VkImageLayout layout_of(Use use);

} // namespace catoptric::graph
