#include "gpu/swapchain.hpp"

#include <algorithm>

namespace catoptric::gpu {

namespace {

/// Semaphores for acquired images: one for each frame in flight, and one for the frame being
/// recorded.
constexpr std::size_t kAcquireSemaphoreCount = 4;

UniqueSemaphore make_semaphore(const GpuDevice& device) {
    const VkSemaphoreCreateInfo create{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    VkSemaphore semaphore = VK_NULL_HANDLE;
    throw_unless_vk_success(vkCreateSemaphore(device.device_handle(), &create, nullptr, &semaphore),
                            "create a semaphore");
    return {device.device_handle(), semaphore};
}

VkSurfaceFormatKHR choose_surface_format(const GpuDevice& device) {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceSurfaceFormatsKHR(device.physical_device(), device.window_surface(), &count,
                                         nullptr);
    std::vector<VkSurfaceFormatKHR> formats(count);
    vkGetPhysicalDeviceSurfaceFormatsKHR(device.physical_device(), device.window_surface(), &count,
                                         formats.data());
    for (const VkFormat wanted : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM})
        for (const VkSurfaceFormatKHR& format : formats)
            if (format.format == wanted) return format;
    fail(Failure::no_device, "the window takes no colours of 8 bits that are written as they are (",
         count, " formats of device '", device.device_properties().name, "')");
}

VkExtent2D choose_swapchain_extent(const VkSurfaceCapabilitiesKHR& can, uvec2 wanted) {
    constexpr std::uint32_t kAnySurfaceExtent = 0xFFFFFFFF;
    if (can.currentExtent.width != kAnySurfaceExtent) return can.currentExtent;
    return {std::clamp(wanted.x, can.minImageExtent.width, can.maxImageExtent.width),
            std::clamp(wanted.y, can.minImageExtent.height, can.maxImageExtent.height)};
}

} // namespace

Swapchain::Swapchain(GpuDevice& device)
    : presenting_device_(device), colours_(choose_surface_format(device)) {
    if (colours_.format == VK_FORMAT_R8G8B8A8_UNORM) format_ = TexelFormat::rgba8_unorm;
}

bool Swapchain::check_swapchain_result(VkResult result, const std::string& doing) {
    if (result == VK_SUCCESS) return true;
    lost_ |= result == VK_ERROR_SURFACE_LOST_KHR;
    if (lost_ || result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR ||
        result == VK_TIMEOUT || result == VK_NOT_READY)
        return false; // the next frame tries again
    presenting_device_.check_result_and_abandon_if_lost(result, doing);
    return false;
}

void Swapchain::wait_idle() {
    presenting_device_.check_device_not_abandoned();
    presenting_device_.check_wait_or_abandon(vkQueueWaitIdle(presenting_device_.vulkan_queue()),
                                             "wait for the window's pictures");
}

bool Swapchain::create_swapchain_images(uvec2 size) {
    VkSurfaceCapabilitiesKHR can{};
    if (!check_swapchain_result(
            vkGetPhysicalDeviceSurfaceCapabilitiesKHR(presenting_device_.physical_device(),
                                                      presenting_device_.window_surface(), &can),
            "ask what the window can show"))
        return false;
    const VkExtent2D extent = choose_swapchain_extent(can, size);
    images_.clear();
    if (extent.width == 0 || extent.height == 0) return false;
    VkSwapchainCreateInfoKHR create{VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR};
    create.surface = presenting_device_.window_surface();
    create.minImageCount = std::max(can.minImageCount, 3u);
    if (can.maxImageCount > 0)
        create.minImageCount = std::min(create.minImageCount, can.maxImageCount);
    create.imageFormat = colours_.format;
    create.imageColorSpace = colours_.colorSpace;
    create.imageExtent = extent;
    create.imageArrayLayers = 1;
    create.imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    create.preTransform = can.currentTransform;
    create.compositeAlpha = can.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                                ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                                : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
    create.presentMode = VK_PRESENT_MODE_FIFO_KHR;
    create.clipped = true;
    create.oldSwapchain = chain_;
    VkSwapchainKHR chain = VK_NULL_HANDLE;
    if (!check_swapchain_result(
            vkCreateSwapchainKHR(presenting_device_.device_handle(), &create, nullptr, &chain),
            "make the window's images"))
        return false;
    chain_ = {presenting_device_.device_handle(), chain};
    std::uint32_t count = 0;
    throw_unless_vk_success(
        vkGetSwapchainImagesKHR(presenting_device_.device_handle(), chain_, &count, nullptr),
        "count the window's images");
    images_.resize(count);
    throw_unless_vk_success(
        vkGetSwapchainImagesKHR(presenting_device_.device_handle(), chain_, &count, images_.data()),
        "get the window's images");
    // Semaphores of images that were acquired but not drawn are still signalled, so they cannot be
    // used again.
    acquired_.clear(), rendered_.clear();
    for (std::size_t i = 0; i < kAcquireSemaphoreCount; ++i)
        acquired_.push_back(make_semaphore(presenting_device_));
    for (std::size_t i = 0; i < images_.size(); ++i)
        rendered_.push_back(make_semaphore(presenting_device_));
    size_ = {extent.width, extent.height};
    return true;
}

std::optional<std::uint32_t> Swapchain::acquire_image() {
    const std::size_t turn = (turn_ + 1) % acquired_.size();
    std::uint32_t image = 0;
    const VkResult result = vkAcquireNextImageKHR(presenting_device_.device_handle(), chain_,
                                                  ~std::uint64_t{0}, acquired_[turn],
                                                  VK_NULL_HANDLE, &image);
    // A suboptimal image is drawn all the same, because its semaphore will be signalled.
    if (result != VK_SUBOPTIMAL_KHR &&
        !check_swapchain_result(result, "get the window's next image"))
        return {};
    turn_ = turn;
    return image;
}

bool Swapchain::present_image(std::uint32_t image) {
    const VkSemaphore wait = rendered_[image];
    const VkSwapchainKHR chain = chain_;
    VkPresentInfoKHR present{VK_STRUCTURE_TYPE_PRESENT_INFO_KHR};
    present.waitSemaphoreCount = 1;
    present.pWaitSemaphores = &wait;
    present.swapchainCount = 1;
    present.pSwapchains = &chain;
    present.pImageIndices = &image;
    return check_swapchain_result(vkQueuePresentKHR(presenting_device_.vulkan_queue(), &present),
                                  "show a picture in the window");
}

} // namespace catoptric::gpu
