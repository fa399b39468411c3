#pragma once

#include "core/export.hpp"
#include "session/engine.hpp"
#include "session/session.hpp"

#include <cstdint>

#include <vulkan/vulkan.h>

/// Runs sessions on the caller's Vulkan device, and renders into the caller's images.
namespace catoptric::embed {

/// Features that the device must be created with, for Vulkan 1.3. VkDeviceCreateInfo::pNext must
/// point to `core`, which chains them, and pEnabledFeatures must be null. No extension is needed.
struct RequiredFeatures {
    /// Fills the chain. Throws `no_device` with the names of features that the device lacks.
    CATOPTRIC_API explicit RequiredFeatures(VkPhysicalDevice device);
    RequiredFeatures(const RequiredFeatures&) = delete;
    RequiredFeatures& operator=(const RequiredFeatures&) = delete;
    VkPhysicalDeviceFeatures2 core{};
    VkPhysicalDeviceVulkan11Features v11{};
    VkPhysicalDeviceVulkan12Features v12{};
    VkPhysicalDeviceVulkan13Features v13{};
};

/// Vulkan handles of the caller, which must outlive the engine. The queue's family must support
/// graphics, compute and timestamps. While a function of the library runs, no other thread may use
/// the queue.
struct Device {
    VkInstance instance = VK_NULL_HANDLE; ///< of apiVersion 1.3 or above
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    std::uint32_t queue_family = 0;
};
/// Makes an engine on the caller's device. Ignores the options `device` and `validate`. Throws
/// `usage` for missing handles, and `no_device` for a device that is not suitable.
CATOPTRIC_API session::Engine make_engine(const Device& device,
                                          const session::EngineOptions& options = {});

/// An image of the caller, whose contents are lost: 2D, one layer, mip and sample, optimal tiling,
/// of the frame's size, with VK_IMAGE_USAGE_TRANSFER_DST_BIT, not shared by queue families. Format:
/// VK_FORMAT_R8G8B8A8_UNORM or _SRGB (its bytes are sRGB either way).
struct Target {
    VkImage image = VK_NULL_HANDLE;
    /// Layout after the frame: SHADER_READ_ONLY_OPTIMAL, TRANSFER_SRC_OPTIMAL, GENERAL or, for an
    /// image of a swapchain, PRESENT_SRC_KHR.
    VkImageLayout leaves = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
};
/// Renders a frame of one technique as Session::frame does, and writes the displayed picture into
/// the image. All work submitted to the queue before has ended when the frame ends. Work submitted
/// afterwards sees the picture without a semaphore. Wait for an acquired image of a swapchain in a
/// submit of your own before the frame, and signal for presenting in one after it. The image must
/// live until Frame::times is known. Throws `usage` for several techniques or a wrong image.
CATOPTRIC_API session::Frame render_into(session::Session& session, const session::FrameSpec& spec,
                                         const Target& target);

} // namespace catoptric::embed
