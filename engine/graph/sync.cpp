#include "graph/sync.hpp"

namespace catoptric::graph {

namespace {

constexpr VkPipelineStageFlags2 kDepthTestStages = VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT |
                                                   VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;

} // namespace

gpu::AccessScope sync_scope(const AccessState& access) {
    if (access.nothing) return {};
    const VkPipelineStageFlags2 shaders = access.raster
                                              ? VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT |
                                                    VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT
                                              : VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    switch (access.use) {
    case ResourceUse::sampled: return {shaders, VK_ACCESS_2_SHADER_READ_BIT};
    case ResourceUse::storage_read: return {shaders, VK_ACCESS_2_SHADER_STORAGE_READ_BIT};
    case ResourceUse::storage_write:
    case ResourceUse::storage:
        return {shaders,
                VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};
    case ResourceUse::colour:
        return {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT};
    case ResourceUse::depth:
        return {kDepthTestStages, VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT |
                                      VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT};
    case ResourceUse::copy_from:
        return {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT};
    case ResourceUse::copy_to:
        return {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};
    case ResourceUse::indirect:
        return {VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT};
    case ResourceUse::present: return {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_NONE};
    }
    return {};
}

VkImageLayout image_layout(ResourceUse use) {
    switch (use) {
    case ResourceUse::sampled: return VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    case ResourceUse::storage_read:
    case ResourceUse::storage_write:
    case ResourceUse::storage:
    case ResourceUse::indirect: return VK_IMAGE_LAYOUT_GENERAL;
    case ResourceUse::colour: return VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    case ResourceUse::depth: return VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    case ResourceUse::copy_from: return VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    case ResourceUse::copy_to: return VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    case ResourceUse::present: return VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
    }
    return VK_IMAGE_LAYOUT_UNDEFINED;
}

} // namespace catoptric::graph
