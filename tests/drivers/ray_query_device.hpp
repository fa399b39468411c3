#pragma once

#include "gpu/device.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace test {

using namespace catoptric;

/// A buffer in memory that host and device can access, with its device address.
struct RayQueryMemory {
    gpu::UniqueMemory memory; // declared before the buffer, so destroyed after it
    gpu::UniqueBuffer buffer;
    void* mapped = nullptr;
    VkDeviceAddress address = 0;
};

/// A Vulkan device with ray queries and validation. The engine's own device does not enable ray
/// queries.
class RayQueryDevice {
public:
    /// Opens the first device with ray queries. If no device has them, returns null and sets
    /// `reason`.
    static std::unique_ptr<RayQueryDevice> open(std::string& reason);
    ~RayQueryDevice();
    RayQueryDevice(const RayQueryDevice&) = delete;
    RayQueryDevice& operator=(const RayQueryDevice&) = delete;

    const std::string& device_name() const { return name_; }
    VkPhysicalDevice physical_device() const { return physical_; }
    gpu::DeviceHandle handle() const { return {device_}; }
    /// Returns the messages of the validation layer so far.
    const std::vector<std::string>& validation_messages() const { return messages_; }

    /// Returns the address of a function of a device extension.
    template <typename Function>
    Function find_extension_function(const char* function) const {
        return reinterpret_cast<Function>(vkGetDeviceProcAddr(device_, function));
    }
    RayQueryMemory make_ray_query_memory(std::uint64_t bytes, VkBufferUsageFlags usage,
                                         const void* contents = nullptr) const;

    /// Calls `record` to fill a command buffer, submits the buffer and waits for the device.
    template <typename Record>
    void submit_and_wait(Record&& record) const {
        VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
        begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
        gpu::check_vk(vkBeginCommandBuffer(commands_, &begin), "begin a command buffer");
        record(commands_);
        gpu::check_vk(vkEndCommandBuffer(commands_), "end a command buffer");
        VkSubmitInfo info{VK_STRUCTURE_TYPE_SUBMIT_INFO};
        info.commandBufferCount = 1;
        info.pCommandBuffers = &commands_;
        gpu::check_vk(vkQueueSubmit(queue_, 1, &info, VK_NULL_HANDLE), "submit");
        gpu::check_vk(vkQueueWaitIdle(queue_), "wait");
    }

private:
    RayQueryDevice() = default;
    void make_ray_query_debug_messenger();
    void make_ray_query_device();
    void make_ray_query_command_buffer(std::uint32_t queue_family);

    std::string name_;
    std::vector<std::string> messages_;
    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    gpu::UniqueCommandPool command_pool_;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
};

} // namespace test
