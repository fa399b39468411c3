#pragma once

#include "core/math.hpp"
#include "gpu/device.hpp"

#include <optional>
#include <vector>

namespace catoptric::gpu {

/// A window's images, which its system shows in turn. Presented in order, none left out.
class Swapchain {
public:
    /// Of a device that was made with a surface. Throws `no_device` where the window takes no
    /// colours of 8 bits.
    explicit Swapchain(Device& device);

    /// Until the device does nothing any more: before `make`, and before views of its images go.
    void wait();
    /// Images of this size, or of the one that the window system demands.
    /// False: the window has no pixels now (it is minimised), or is gone: `lost`.
    bool make(uvec2 size);
    /// The surface went away with its window: only another device with another surface helps.
    bool lost() const { return lost_; }
    Format format() const { return format_; }
    uvec2 size() const { return size_; }
    const std::vector<VkImage>& images() const { return images_; }

    /// The image to be drawn next; waits for the window system where none is free. Nothing: the
    /// window has changed, and `make` is to be called.
    std::optional<std::uint32_t> acquire();
    /// For the frame that draws the image that was acquired last: begins after the one, signals
    /// the other.
    VkSemaphore acquired() const { return acquired_[turn_]; }
    VkSemaphore rendered(std::uint32_t image) const { return rendered_[image]; }
    /// False: as for `acquire`.
    bool present(std::uint32_t image);

private:
    bool check(VkResult result, const std::string& doing);

    Device& device_;
    VkSurfaceFormatKHR colours_{};
    Format format_ = Format::bgra8_unorm;
    UniqueSwapchain chain_;
    uvec2 size_{0, 0};
    std::vector<VkImage> images_;
    std::vector<UniqueSemaphore> acquired_, rendered_;
    std::size_t turn_ = 0;
    bool lost_ = false;
};

} // namespace catoptric::gpu
