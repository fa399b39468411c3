#include "graph/sync.hpp"

namespace catoptric::graph {

namespace {

constexpr VkPipelineStageFlags2 kDepthStages = VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT |
                                               VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;

} // namespace

Scope scope_of(const Touch& touch) {
    if (touch.nothing) return {};
    const VkPipelineStageFlags2 shaders = touch.raster ? VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT |
                                                             VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT
                                                       : VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    switch (touch.use) {
    case Use::sampled: return {shaders, VK_ACCESS_2_SHADER_READ_BIT};
    case Use::storage_read: return {shaders, VK_ACCESS_2_SHADER_STORAGE_READ_BIT};
    case Use::storage_write:
    case Use::storage:
        return {shaders,
                VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};
    case Use::colour:
        return {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT};
    case Use::depth:
        return {kDepthStages, VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT |
                                  VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT};
    case Use::copy_from:
        return {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT};
    case Use::copy_to:
        return {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};
    case Use::indirect:
        return {VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT};
    case Use::present: return {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_NONE};
    }
    return {};
}

VkImageLayout layout_of(Use use) {
    switch (use) {
    case Use::sampled: return VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    case Use::storage_read:
    case Use::storage_write:
    case Use::storage:
    case Use::indirect: return VK_IMAGE_LAYOUT_GENERAL;
    case Use::colour: return VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    case Use::depth: return VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    case Use::copy_from: return VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    case Use::copy_to: return VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    case Use::present: return VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
    }
    return VK_IMAGE_LAYOUT_UNDEFINED;
}

} // namespace catoptric::graph
