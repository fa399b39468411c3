#pragma once

#include "gpu/device.hpp"

namespace catoptric::gpu {

/// Throws as `check_vk` does, but throws `no_device` if the driver is missing or cannot start.
/// `or_else` is the text of this error: what happened and what to do.
void check_vk_started(VkResult result, const std::string& doing, const char* or_else);

/// Creates an instance with the wanted extensions, with VK_EXT_debug_utils where it exists, and
/// with the validation layer if `validate` is set. Throws `no_device` if no driver is installed, or
/// if the validation layer or an extension is absent. Throws `exhausted` without memory for an
/// instance.
VkInstance make_instance(bool validate, const std::vector<std::string>& wanted_extensions,
                         bool& has_debug_utils);

/// Returns the physical devices in order of preference, at least one. Throws the errors of
/// `make_instance`.
std::vector<VkPhysicalDevice> physical_devices(VkInstance instance);

DeviceProperties describe_device(VkPhysicalDevice device);

bool can_present(VkPhysicalDevice device, VkSurfaceKHR surface);

/// Returns the vector width in bits that the environment sets for Mesa's software driver
/// (LP_NATIVE_VECTOR_WIDTH). None if the variable is unset or no number.
std::optional<long> llvmpipe_vector_width();

/// Returns the index of the queue family that can draw, dispatch, copy and write timestamps, or -1.
int find_queue_family(VkPhysicalDevice device);

/// The device features that the engine enables, as one chain. Not copyable, because it points into
/// itself.
struct DeviceFeatures {
    DeviceFeatures();
    /// Enables the required features, and the optional ones that the device has.
    void enable(VkPhysicalDevice device);
    DeviceFeatures(const DeviceFeatures&) = delete;
    DeviceFeatures& operator=(const DeviceFeatures&) = delete;
    /// Returns the names of the required features that `device` lacks, comma-separated.
    static std::string missing_features(VkPhysicalDevice device);
    /// Returns whether images of 32-bit floats can be sampled with linear filtering, which is
    /// optional in Vulkan.
    static bool filters_floats(VkPhysicalDevice device);
    /// Returns whether fragment shaders have basic subgroup operations.
    static bool has_fragment_subgroups(VkPhysicalDevice device);
    /// Returns whether colour attachments of floats, of 16 and of 32 bits, can be blended.
    static bool blends_floats(VkPhysicalDevice device);
    VkPhysicalDeviceFeatures2 core{};
    VkPhysicalDeviceVulkan11Features v11{};
    VkPhysicalDeviceVulkan12Features v12{};
    VkPhysicalDeviceVulkan13Features v13{};
};

} // namespace catoptric::gpu
