#pragma once

#include "core/error.hpp"
#include "core/format.hpp"

#include <vulkan/vulkan.h>

#include <bit>
#include <cstdint>
#include <string>
#include <utility>

namespace catoptric::gpu {

/// Throws unless `result` is VK_SUCCESS: `exhausted` without memory, `device_lost` for a device
/// that is lost or gives no answer, `no_device` for a missing feature, else `internal`. `doing`
/// completes "Vulkan: cannot ".
void check_vk(VkResult result, const std::string& doing);
const char* vk_result_name(VkResult result);

VkFormat to_vk_format(TexelFormat format);

/// Stages and kinds of access of the work on one side of a barrier.
struct AccessScope {
    VkPipelineStageFlags2 stages = 0;
    VkAccessFlags2 access = 0;
};
inline constexpr AccessScope kTransferWrite{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                                            VK_ACCESS_2_TRANSFER_WRITE_BIT};
/// Records a barrier that makes the writes of earlier work visible to later work, in all memory.
void memory_barrier(VkCommandBuffer commands, const AccessScope& earlier, const AccessScope& later);
void image_barrier(VkCommandBuffer commands, const VkImageMemoryBarrier2& barrier);

/// Returns the surface for the number that window libraries pass for it.
inline VkSurfaceKHR to_surface(std::uint64_t number) { return std::bit_cast<VkSurfaceKHR>(number); }

/// A device handle for objects made from the device, with its abandoned flag.
struct DeviceHandle {
    VkDevice device = VK_NULL_HANDLE;
    /// The flag of Device::is_abandoned(); null: the device is never abandoned.
    const bool* abandoned = nullptr;
    operator VkDevice() const { return device; }
};

/// A Vulkan object of a device, destroyed with this value. If the device was abandoned the object
/// is not destroyed, because the driver may still use it.
template <typename Handle, auto Destroy>
class UniqueHandle {
public:
    UniqueHandle() = default;
    UniqueHandle(DeviceHandle device, Handle handle) : device_(device), handle_(handle) {}
    UniqueHandle(UniqueHandle&& other) noexcept
        : device_(other.device_), handle_(std::exchange(other.handle_, Handle{})) {}
    UniqueHandle& operator=(UniqueHandle&& other) noexcept {
        std::swap(device_, other.device_), std::swap(handle_, other.handle_);
        return *this;
    }
    ~UniqueHandle() {
        const bool abandoned = device_.abandoned && *device_.abandoned;
        if (handle_ && !abandoned) Destroy(device_, handle_, nullptr);
    }
    operator Handle() const { return handle_; }

private:
    DeviceHandle device_;
    Handle handle_{};
};

using UniqueBuffer = UniqueHandle<VkBuffer, vkDestroyBuffer>;
using UniqueBufferView = UniqueHandle<VkBufferView, vkDestroyBufferView>;
using UniqueCommandPool = UniqueHandle<VkCommandPool, vkDestroyCommandPool>;
using UniqueDescriptorPool = UniqueHandle<VkDescriptorPool, vkDestroyDescriptorPool>;
using UniqueDescriptorSetLayout = UniqueHandle<VkDescriptorSetLayout, vkDestroyDescriptorSetLayout>;
using UniqueImage = UniqueHandle<VkImage, vkDestroyImage>;
using UniqueImageView = UniqueHandle<VkImageView, vkDestroyImageView>;
using UniqueMemory = UniqueHandle<VkDeviceMemory, vkFreeMemory>;
using UniquePipeline = UniqueHandle<VkPipeline, vkDestroyPipeline>;
using UniquePipelineCache = UniqueHandle<VkPipelineCache, vkDestroyPipelineCache>;
using UniquePipelineLayout = UniqueHandle<VkPipelineLayout, vkDestroyPipelineLayout>;
using UniqueQueryPool = UniqueHandle<VkQueryPool, vkDestroyQueryPool>;
using UniqueSampler = UniqueHandle<VkSampler, vkDestroySampler>;
using UniqueSemaphore = UniqueHandle<VkSemaphore, vkDestroySemaphore>;
using UniqueSwapchain = UniqueHandle<VkSwapchainKHR, vkDestroySwapchainKHR>;
using UniqueShaderModule = UniqueHandle<VkShaderModule, vkDestroyShaderModule>;

} // namespace catoptric::gpu
