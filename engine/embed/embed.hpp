#pragma once

#include "../app/engine.hpp"
#include "../app/session.hpp"
#include "../core/export.hpp"
#include "../core/math.hpp"

#include <cstdint>

#include <vulkan/vulkan.h>

/// Sessions on a Vulkan device of the caller's, that render into images of the caller's. The only
/// public header with Vulkan's names.
namespace catoptric::embed {

/// What the device must have been made with: Vulkan 1.3, and these features, chained in `core`,
/// which stands in VkDeviceCreateInfo::pNext (pEnabledFeatures null). Others may be switched on in
/// it, too. No extension is needed.
struct Features {
    /// Throws `no_device` naming what the device lacks.
    CATOPTRIC_API explicit Features(VkPhysicalDevice device);
    Features(const Features&) = delete;
    Features& operator=(const Features&) = delete;
    VkPhysicalDeviceFeatures2 core{};
    VkPhysicalDeviceVulkan11Features v11{};
    VkPhysicalDeviceVulkan12Features v12{};
    VkPhysicalDeviceVulkan13Features v13{};
};

/// The caller's, all of it: it must outlive the engine. The queue's family draws, dispatches and
/// has timestamps. While a function of the library runs, no other thread uses the queue.
struct Device {
    VkInstance instance = VK_NULL_HANDLE; ///< of apiVersion 1.3 or above
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    std::uint32_t queue_family = 0;
};
/// An engine on it. Of the options `device` and `validate` mean nothing: both were chosen by the
/// caller. Throws `usage` for what is missing of it, `no_device` for a device that will not do.
CATOPTRIC_API app::Engine make_engine(const Device& device, const app::EngineOptions& options = {});

/// An image of the caller's: 2D, one layer, mip and sample, optimal tiling, of the frame's size,
/// VK_FORMAT_R8G8B8A8_UNORM or _SRGB (its bytes are sRGB either way), with
/// VK_IMAGE_USAGE_TRANSFER_DST_BIT, not shared by queue families. Its contents before are lost.
struct Target {
    VkImage image = VK_NULL_HANDLE;
    /// That the frame leaves it in: SHADER_READ_ONLY_OPTIMAL, TRANSFER_SRC_OPTIMAL, GENERAL or, for
    /// an image of a swapchain, PRESENT_SRC_KHR.
    VkImageLayout leaves = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
};
/// Session::frame of one technique, which also writes what the screen shows into the image. All
/// work that was submitted to the queue before has ended when it does, and what is submitted
/// afterwards sees the picture, without a semaphore. Acquiring and presenting a swapchain's image
/// are no such work: wait for the one in a submit of your own before, signal for the other in one
/// after. The image must live until the frame has ended (Frame::times). Throws `usage` for several
/// techniques, no image, and another layout.
CATOPTRIC_API app::Frame frame_into(app::Session& session, const app::FrameSpec& spec,
                                    const Target& target);

} // namespace catoptric::embed
