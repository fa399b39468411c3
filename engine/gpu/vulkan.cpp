#include "gpu/vulkan.hpp"

namespace catoptric::gpu {

const char* vk_result_name(VkResult result) {
    switch (result) {
    case VK_SUCCESS: return "VK_SUCCESS";
    case VK_TIMEOUT: return "VK_TIMEOUT";
    case VK_NOT_READY: return "VK_NOT_READY";
    case VK_ERROR_OUT_OF_HOST_MEMORY: return "VK_ERROR_OUT_OF_HOST_MEMORY";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY: return "VK_ERROR_OUT_OF_DEVICE_MEMORY";
    case VK_ERROR_OUT_OF_POOL_MEMORY: return "VK_ERROR_OUT_OF_POOL_MEMORY";
    case VK_ERROR_FRAGMENTED_POOL: return "VK_ERROR_FRAGMENTED_POOL";
    case VK_ERROR_FRAGMENTATION: return "VK_ERROR_FRAGMENTATION";
    case VK_ERROR_TOO_MANY_OBJECTS: return "VK_ERROR_TOO_MANY_OBJECTS";
    case VK_ERROR_INITIALIZATION_FAILED: return "VK_ERROR_INITIALIZATION_FAILED";
    case VK_ERROR_DEVICE_LOST: return "VK_ERROR_DEVICE_LOST";
    case VK_ERROR_MEMORY_MAP_FAILED: return "VK_ERROR_MEMORY_MAP_FAILED";
    case VK_ERROR_LAYER_NOT_PRESENT: return "VK_ERROR_LAYER_NOT_PRESENT";
    case VK_ERROR_EXTENSION_NOT_PRESENT: return "VK_ERROR_EXTENSION_NOT_PRESENT";
    case VK_ERROR_FEATURE_NOT_PRESENT: return "VK_ERROR_FEATURE_NOT_PRESENT";
    case VK_ERROR_INCOMPATIBLE_DRIVER: return "VK_ERROR_INCOMPATIBLE_DRIVER";
    case VK_ERROR_FORMAT_NOT_SUPPORTED: return "VK_ERROR_FORMAT_NOT_SUPPORTED";
    case VK_ERROR_SURFACE_LOST_KHR: return "VK_ERROR_SURFACE_LOST_KHR";
    case VK_ERROR_NATIVE_WINDOW_IN_USE_KHR: return "VK_ERROR_NATIVE_WINDOW_IN_USE_KHR";
    case VK_ERROR_OUT_OF_DATE_KHR: return "VK_ERROR_OUT_OF_DATE_KHR";
    case VK_SUBOPTIMAL_KHR: return "VK_SUBOPTIMAL_KHR";
    default: return "an unnamed VkResult";
    }
}

void check_vk(VkResult result, const std::string& doing) {
    if (result == VK_SUCCESS) return;
    Failure failure = Failure::internal;
    switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
    case VK_ERROR_OUT_OF_POOL_MEMORY:
    case VK_ERROR_FRAGMENTED_POOL:
    case VK_ERROR_FRAGMENTATION:
    case VK_ERROR_MEMORY_MAP_FAILED:
    case VK_ERROR_TOO_MANY_OBJECTS: failure = Failure::exhausted; break;
    case VK_TIMEOUT:
    case VK_NOT_READY:
    case VK_ERROR_DEVICE_LOST: failure = Failure::device_lost; break;
    case VK_ERROR_LAYER_NOT_PRESENT:
    case VK_ERROR_EXTENSION_NOT_PRESENT:
    case VK_ERROR_FEATURE_NOT_PRESENT:
    case VK_ERROR_FORMAT_NOT_SUPPORTED: failure = Failure::no_device; break;
    default: break;
    }
    const bool is_late = result == VK_TIMEOUT || result == VK_NOT_READY;
    fail(failure, "Vulkan: cannot ", doing, ": ", vk_result_name(result), " (",
         static_cast<int>(result), ")",
         is_late ? ": the device gave no answer although the wait for it has no limit; try again, "
                   "or another device (--device)"
                 : "");
}

VkFormat to_vk_format(TexelFormat format) {
    switch (format) {
    case TexelFormat::r8_unorm: return VK_FORMAT_R8_UNORM;
    case TexelFormat::rgba8_unorm: return VK_FORMAT_R8G8B8A8_UNORM;
    case TexelFormat::bgra8_unorm: return VK_FORMAT_B8G8R8A8_UNORM;
    case TexelFormat::r16f: return VK_FORMAT_R16_SFLOAT;
    case TexelFormat::rgba16f: return VK_FORMAT_R16G16B16A16_SFLOAT;
    case TexelFormat::r32f: return VK_FORMAT_R32_SFLOAT;
    case TexelFormat::rgba32f: return VK_FORMAT_R32G32B32A32_SFLOAT;
    case TexelFormat::r32ui: return VK_FORMAT_R32_UINT;
    case TexelFormat::d32f: return VK_FORMAT_D32_SFLOAT;
    }
    return VK_FORMAT_UNDEFINED;
}

void memory_barrier(VkCommandBuffer commands, const AccessScope& earlier,
                    const AccessScope& later) {
    VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    barrier.srcStageMask = earlier.stages;
    barrier.srcAccessMask = earlier.access;
    barrier.dstStageMask = later.stages;
    barrier.dstAccessMask = later.access;
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &dependency);
}

void image_barrier(VkCommandBuffer commands, const VkImageMemoryBarrier2& barrier) {
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.imageMemoryBarrierCount = 1;
    dependency.pImageMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &dependency);
}

} // namespace catoptric::gpu
