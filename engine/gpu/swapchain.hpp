#pragma once

#include "core/math.hpp"
#include "gpu/device.hpp"

#include <optional>
#include <vector>

namespace catoptric::gpu {

/// The images of a window, presented in order without dropping any (FIFO).
class Swapchain {
public:
    /// `device` must have a surface. Throws `no_device` if the window takes no colours of 8 bits.
    explicit Swapchain(Device& device);

    /// Call it before `create_images`, and before views of the images are destroyed.
    void wait_idle();
    /// Makes images of this size, in pixels, or of the size that the window system demands. Returns
    /// false if the window has no pixels now (it is minimised), or is gone (see `is_surface_lost`).
    bool create_images(uvec2 size);
    /// Returns whether the surface is lost together with its window. Only another device with
    /// another surface helps.
    bool is_surface_lost() const { return lost_; }
    TexelFormat texel_format() const { return format_; }
    uvec2 size() const { return size_; }
    const std::vector<VkImage>& images() const { return images_; }

    /// Returns the index of the image to draw next. Waits for the window system if none is free.
    /// Returns nothing if the window has changed and `create_images` must be called.
    std::optional<std::uint32_t> acquire_image();
    /// Semaphores for the frame that draws the image acquired last: the frame waits for
    /// `acquired_semaphore` and signals `rendered_semaphore`.
    VkSemaphore acquired_semaphore() const { return acquired_[turn_]; }
    VkSemaphore rendered_semaphore(std::uint32_t image) const { return rendered_[image]; }
    /// Returns false if the window has changed and `create_images` must be called.
    bool present_image(std::uint32_t image);

private:
    bool check_result(VkResult result, const std::string& doing);

    Device& device_;
    VkSurfaceFormatKHR colours_{};
    TexelFormat format_ = TexelFormat::bgra8_unorm;
    UniqueSwapchain chain_;
    uvec2 size_{0, 0};
    std::vector<VkImage> images_;
    std::vector<UniqueSemaphore> acquired_, rendered_;
    std::size_t turn_ = 0;
    bool lost_ = false;
};

} // namespace catoptric::gpu
