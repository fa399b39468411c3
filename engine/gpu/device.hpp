#pragma once

#include "gpu/variants.hpp"
#include "gpu/vulkan.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace catoptric::gpu {

/// What a user may know about a device.
struct DeviceInfo {
    std::string name;
    std::string driver;  ///< name and version as the driver tells them
    std::string api;     ///< "1.3.230"
    std::string type;    ///< discrete | integrated | virtual | cpu | other
    int threads = 0;     ///< of a cpu device: how many processors it may use; otherwise 0
    std::string missing; ///< features that the engine requires and the device lacks; empty = usable
    std::string id;      ///< vendor and device in hexadecimal: "10de-2330"
};

/// All devices in the order in which they are preferred: discrete, integrated, virtual, cpu.
/// Throws `Failure::no_device` saying what to install when there is no driver.
std::vector<DeviceInfo> list_devices();

class Uploads;

/// Somebody else's, made with Features::switch_on; all of it outlives the Device.
struct GivenDevice {
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    std::uint32_t queue_family = 0; ///< graphics, compute and copies, with timestamps
};

struct DeviceOptions {
    std::string wanted; ///< index into list_devices(), or part of a name; empty = the first usable
    bool validate = false; ///< Khronos validation layer: core, synchronization, queue submit
    bool layered = true;   ///< false: pretend that a vertex shader cannot write gl_Layer
    bool staged = false;   ///< true: pretend that device memory cannot be mapped
    std::vector<std::string> instance_extensions = {}; ///< that the window system wants
    /// Makes the surface that the device is to show pictures on; empty: none.
    std::function<VkSurfaceKHR(VkInstance)> make_surface = {};
    std::optional<GivenDevice> given = {}; ///< in place of one of its own
};

/// Whether a device of this process was abandoned: its driver's threads may still be at work, and a
/// program that takes itself down under them can crash. Such a program ends with std::_Exit.
bool any_abandoned();

/// Instance, device and its one queue (graphics, compute, copies). Not copyable; everything made
/// from it must go before it. One thread at a time.
///
/// A device that is lost, or that cannot be waited for, may still use what it was given. It is
/// *abandoned*: from then on nothing made from it is destroyed, itself and its instance neither,
/// and it takes no more work. The memory is gone for the rest of the process; another Device may be
/// made.
class Device {
public:
    /// Throws `no_device` (nothing there, cannot be opened, lacks a required feature), `usage` (no
    /// such device), `exhausted`.
    explicit Device(const DeviceOptions& options);
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    const DeviceInfo& info() const { return info_; }
    const VkPhysicalDeviceLimits& limits() const { return limits_; }
    DeviceHandle handle() const { return {device_, &abandoned_}; }
    VkPhysicalDevice physical() const { return physical_; }
    VkSurfaceKHR surface() const { return surface_; } ///< null: none was asked for
    VkQueue queue() const { return queue_; }
    std::uint32_t queue_family() const { return queue_family_; }
    bool is_cpu() const { return info_.type == "cpu"; }
    /// What its shaders are to be; the defaults until somebody says otherwise, before the first
    /// frame.
    const Choices& choices() const { return choices_; }
    void choose(const Choices& choices) { choices_ = choices; }
    /// Vertex shaders may write gl_Layer; otherwise layered passes run layer by layer.
    bool layered() const { return layered_; }
    /// Whether lists of texels are read from storage buffers, because texel buffers hold few. A
    /// device may allow as few as 65,536 texels: enough for 21,845 triangles.
    bool texels_in_storage() const { return limits_.maxTexelBufferElements < (1u << 26); }
    /// Returns how many texels of `texel_bytes` bytes each a list may have.
    std::uint64_t most_texels(std::uint64_t texel_bytes) const {
        return texels_in_storage() ? limits_.maxStorageBufferRange / texel_bytes
                                   : limits_.maxTexelBufferElements;
    }
    /// Whether images of 32-bit floats can be sampled with linear filtering.
    bool filters_floats() const { return filters_floats_; }
    /// Shaders may compute with doubles.
    bool doubles() const { return doubles_; }
    bool staged() const { return staged_; }
    std::uint32_t timestamp_bits() const { return timestamp_bits_; }

    /// Index of the first memory type that is among `type_bits` and has all of `properties`, or -1.
    int memory_type(std::uint32_t type_bits, VkMemoryPropertyFlags properties) const;
    /// Bytes of the largest device-local heap.
    std::uint64_t memory_budget() const;
    /// Bytes that the device gives in one piece.
    std::uint64_t max_allocation() const { return max_allocation_; }
    /// Bytes of the heap of a memory type.
    std::uint64_t heap_bytes(std::uint32_t type) const {
        return memory_.memoryHeaps[memory_.memoryTypes[type].heapIndex].size;
    }
    /// Throws `exhausted` naming the bytes, and the device's limit when it is that.
    UniqueMemory allocate(std::uint64_t bytes, std::uint32_t type, const std::string& what) const;
    /// `check_vk` for a call that gives the device work or asks what became of it; the device is
    /// abandoned where it is lost.
    void check_alive(VkResult result, const std::string& doing);
    /// `check_vk` for a call that waits for the device, which is abandoned where that fails.
    void check_waited(VkResult result, const std::string& doing);
    bool abandoned() const { return abandoned_; }
    /// Throws what made the device be abandoned, if it was. Before it is given work.
    void check_usable() const;
    /// Gives the object a name for validation messages and debuggers; nothing without that
    /// extension.
    void set_name(VkObjectType type, std::uint64_t handle, const std::string& name) const;
    bool has_labels() const { return has_debug_utils_; }

    /// Records copies with `record`, submits and waits; what they wrote is visible to the host and
    /// to all later commands. For uploads and read-back, never inside a timed frame. `doing` reads
    /// on from "Vulkan: cannot " when it throws `exhausted` or `device_lost`.
    template <typename Record>
    void submit_now(const std::string& doing, Record&& record) {
        begin_one_shot(doing);
        record(one_shot_);
        end_one_shot(doing);
    }

    /// What is written to buffers that cannot be mapped. Made at its first use.
    Uploads& uploads();
    /// Submits the uploads so far. Called before a submit that reads them.
    void submit_uploads();

    /// Messages of the validation layer so far (errors and warnings).
    const std::vector<std::string>& validation_messages() const { return *messages_; }
    /// Throws `internal` with the first message when there is any.
    void check_validation() const;

private:
    void close();
    void create_instance(const DeviceOptions& options);
    void choose(const DeviceOptions& options);
    void adopt(const GivenDevice& given);
    void look_at(const DeviceOptions& options);
    void create_device();
    void make_pool();
    void abandon(const Error& why);
    void begin_one_shot(const std::string& doing);
    void end_one_shot(const std::string& doing);

    VkInstance instance_ = VK_NULL_HANDLE;
    VkSurfaceKHR surface_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    std::uint32_t queue_family_ = 0;
    std::uint32_t timestamp_bits_ = 0;
    VkPhysicalDeviceLimits limits_{};
    std::uint64_t max_allocation_ = 0;
    VkPhysicalDeviceMemoryProperties memory_{};
    DeviceInfo info_;
    Choices choices_{};
    bool layered_ = true;
    bool doubles_ = false;
    bool filters_floats_ = false;
    bool staged_ = false;
    bool has_debug_utils_ = false;
    bool is_given_ = false;
    bool abandoned_ = false;
    std::optional<Error> why_abandoned_;
    PFN_vkSetDebugUtilsObjectNameEXT set_object_name_ = nullptr;
    std::unique_ptr<std::vector<std::string>> messages_;
    UniqueCommandPool one_shot_pool_;
    VkCommandBuffer one_shot_ = VK_NULL_HANDLE;
    std::unique_ptr<Uploads> uploads_;
};

} // namespace catoptric::gpu
