#include "gpu/swapchain.hpp"

#include <algorithm>

namespace catoptric::gpu {

namespace {

/// Semaphores for acquired images: one for each frame in flight, and one for the frame being
/// recorded.
constexpr std::size_t kAcquireSemaphoreCount = 4;

UniqueSemaphore make_semaphore(const Device& device) {
    const VkSemaphoreCreateInfo create{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    VkSemaphore semaphore = VK_NULL_HANDLE;
    check_vk(vkCreateSemaphore(device.handle(), &create, nullptr, &semaphore),
             "create a semaphore");
    return {device.handle(), semaphore};
}

VkSurfaceFormatKHR choose_surface_format(const Device& device) {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceSurfaceFormatsKHR(device.physical_device(), device.surface(), &count,
                                         nullptr);
    std::vector<VkSurfaceFormatKHR> formats(count);
    vkGetPhysicalDeviceSurfaceFormatsKHR(device.physical_device(), device.surface(), &count,
                                         formats.data());
    for (const VkFormat wanted : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM})
        for (const VkSurfaceFormatKHR& format : formats)
            if (format.format == wanted) return format;
    fail(Failure::no_device, "the window takes no colours of 8 bits that are written as they are (",
         count, " formats of device '", device.info().name, "')");
}

VkExtent2D choose_extent(const VkSurfaceCapabilitiesKHR& can, uvec2 wanted) {
    constexpr std::uint32_t kAnySurfaceExtent = 0xFFFFFFFF;
    if (can.currentExtent.width != kAnySurfaceExtent) return can.currentExtent;
    return {std::clamp(wanted.x, can.minImageExtent.width, can.maxImageExtent.width),
            std::clamp(wanted.y, can.minImageExtent.height, can.maxImageExtent.height)};
}

} // namespace

Swapchain::Swapchain(Device& device) : device_(device), colours_(choose_surface_format(device)) {
    if (colours_.format == VK_FORMAT_R8G8B8A8_UNORM) format_ = TexelFormat::rgba8_unorm;
}

bool Swapchain::check_result(VkResult result, const std::string& doing) {
    if (result == VK_SUCCESS) return true;
    lost_ |= result == VK_ERROR_SURFACE_LOST_KHR;
    if (lost_ || result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR ||
        result == VK_TIMEOUT || result == VK_NOT_READY)
        return false; // the next frame tries again
    device_.check_result(result, doing);
    return false;
}

void Swapchain::wait_idle() {
    device_.check_not_abandoned();
    device_.check_wait(vkQueueWaitIdle(device_.queue()), "wait for the window's pictures");
}

bool Swapchain::create_images(uvec2 size) {
    VkSurfaceCapabilitiesKHR can{};
    if (!check_result(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device_.physical_device(),
                                                                device_.surface(), &can),
                      "ask what the window can show"))
        return false;
    const VkExtent2D extent = choose_extent(can, size);
    images_.clear();
    if (extent.width == 0 || extent.height == 0) return false;
    VkSwapchainCreateInfoKHR create{VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR};
    create.surface = device_.surface();
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
    if (!check_result(vkCreateSwapchainKHR(device_.handle(), &create, nullptr, &chain),
                      "make the window's images"))
        return false;
    chain_ = {device_.handle(), chain};
    std::uint32_t count = 0;
    check_vk(vkGetSwapchainImagesKHR(device_.handle(), chain_, &count, nullptr),
             "count the window's images");
    images_.resize(count);
    check_vk(vkGetSwapchainImagesKHR(device_.handle(), chain_, &count, images_.data()),
             "get the window's images");
    // Semaphores of images that were acquired but not drawn are still signalled, so they cannot be
    // used again.
    acquired_.clear(), rendered_.clear();
    for (std::size_t i = 0; i < kAcquireSemaphoreCount; ++i)
        acquired_.push_back(make_semaphore(device_));
    for (std::size_t i = 0; i < images_.size(); ++i) rendered_.push_back(make_semaphore(device_));
    size_ = {extent.width, extent.height};
    return true;
}

std::optional<std::uint32_t> Swapchain::acquire_image() {
    const std::size_t turn = (turn_ + 1) % acquired_.size();
    std::uint32_t image = 0;
    const VkResult result = vkAcquireNextImageKHR(device_.handle(), chain_, ~std::uint64_t{0},
                                                  acquired_[turn], VK_NULL_HANDLE, &image);
    // A suboptimal image is drawn all the same, because its semaphore will be signalled.
    if (result != VK_SUBOPTIMAL_KHR && !check_result(result, "get the window's next image"))
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
    return check_result(vkQueuePresentKHR(device_.queue(), &present),
                        "show a picture in the window");
}

} // namespace catoptric::gpu
