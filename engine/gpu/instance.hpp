#pragma once

#include "gpu/device.hpp"

namespace catoptric::gpu {

/// `check_vk`, but a driver that is not there or cannot begin is `no_device`: `or_else` says what
/// that means and what to do.
void check_begun(VkResult result, const std::string& doing, const char* or_else);

/// Creates an instance, with the validation layer on request and VK_EXT_debug_utils where it
/// exists, and the extensions that are wanted. Throws `no_device` when no driver is installed, or
/// when the validation layer or an extension is absent, `exhausted` when there is no memory for
/// one.
VkInstance make_instance(bool validate, const std::vector<std::string>& wanted_extensions,
                         bool& has_debug_utils);

/// Physical devices in order of preference, at least one; errors as above.
std::vector<VkPhysicalDevice> physical_devices(VkInstance instance);

DeviceInfo describe(VkPhysicalDevice device);

/// Whether the device's queue can show pictures on the surface.
bool can_show(VkPhysicalDevice device, VkSurfaceKHR surface);

/// Bits of the vectors that the environment asks Mesa's software driver to compute with
/// (LP_NATIVE_VECTOR_WIDTH); none where that is unset or no number.
std::optional<long> vector_bits_asked();

/// Index of the queue family that can draw, dispatch and copy, or -1.
int find_queue_family(VkPhysicalDevice device);

/// The features that the engine switches on, as one chain; not copyable (it points into itself).
struct Features {
    Features();
    /// Switches them on; of those that not every device has, what this one has.
    void switch_on(VkPhysicalDevice device);
    Features(const Features&) = delete;
    Features& operator=(const Features&) = delete;
    /// Names of the required ones that `device` lacks, comma-separated.
    static std::string missing(VkPhysicalDevice device);
    /// Whether images of 32-bit floats can be sampled with linear filtering, which Vulkan leaves
    /// open.
    static bool filters_floats(VkPhysicalDevice device);
    VkPhysicalDeviceFeatures2 core{};
    VkPhysicalDeviceVulkan11Features v11{};
    VkPhysicalDeviceVulkan12Features v12{};
    VkPhysicalDeviceVulkan13Features v13{};
};

} // namespace catoptric::gpu
