#pragma once

#include "gpu/vulkan.hpp"
#include "graph/plan.hpp"

namespace catoptric::graph {

/// The pipeline stages and memory accesses of a touch.
struct Scope {
    VkPipelineStageFlags2 stages = VK_PIPELINE_STAGE_2_NONE;
    VkAccessFlags2 access = VK_ACCESS_2_NONE;
};
Scope scope_of(const Touch& touch);

/// Returns the layout that an image has during this use.
VkImageLayout layout_of(Use use);

} // namespace catoptric::graph
