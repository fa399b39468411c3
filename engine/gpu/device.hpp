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

/// Properties of a device, as reported to the user.
struct DeviceProperties {
    std::string name;
    std::string driver;  ///< name and version, as the driver reports them
    std::string api;     ///< "1.3.230"
    std::string type;    ///< discrete | integrated | virtual | cpu | other
    int threads = 0;     ///< processors that a cpu device may use; 0 for other types
    std::string missing; ///< required features that the device lacks; empty = usable
    std::string id;      ///< vendor and device id in hexadecimal: "10de-2330"
};

/// Returns all devices, most preferred first: discrete, integrated, virtual, cpu. Throws
/// `no_device` if there is no driver; the message says what to install.
std::vector<DeviceProperties> list_devices();

class StagedUploads;

/// A device made by the caller with DeviceFeatures::enable. All handles must outlive the Device.
struct ExternalDevice {
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    std::uint32_t queue_family = 0; ///< must have graphics, compute, copies and timestamps
};

struct DeviceOptions {
    std::string wanted; ///< index into list_devices(), or part of a name; empty = the first usable
    bool validate = false; ///< Khronos validation layer: core, synchronization, queue submit
    bool layered = true;   ///< false: pretend that a vertex shader cannot write gl_Layer
    bool staged = false;   ///< true: pretend that device memory cannot be mapped
    std::vector<std::string> instance_extensions = {}; ///< required by the window system
    /// Makes the surface to show pictures on; empty: none.
    std::function<VkSurfaceKHR(VkInstance)> make_surface = {};
    std::optional<ExternalDevice> given = {}; ///< a device to use instead of making one
};

/// Returns whether a device of this process was abandoned. Its driver's threads may still run, and
/// normal process exit can crash under them. Such a program must end with std::_Exit.
bool has_abandoned_device();

/// A Vulkan instance, device and its one queue (graphics, compute, copies). Not copyable. All
/// objects made from it must be destroyed before it. Used by one thread at a time.
///
/// A device that is lost, or that cannot be waited for, may still use its resources. It becomes
/// *abandoned*: it takes no more work, and neither it, its instance nor its objects are destroyed.
/// Their memory is lost until the process ends. Another Device may be made.
class Device {
public:
    /// Throws `no_device` if there is no device, it cannot be opened or it lacks a required
    /// feature. Throws `usage` if `wanted` matches no device. May throw `exhausted`.
    explicit Device(const DeviceOptions& options);
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    const DeviceProperties& info() const { return info_; }
    const VkPhysicalDeviceLimits& limits() const { return limits_; }
    DeviceHandle handle() const { return {device_, &abandoned_}; }
    VkPhysicalDevice physical_device() const { return physical_; }
    /// Null if no surface was asked for.
    VkSurfaceKHR surface() const { return surface_; }
    VkQueue queue() const { return queue_; }
    std::uint32_t queue_family() const { return queue_family_; }
    bool is_cpu() const { return info_.type == "cpu"; }
    /// The defaults, unless `set_variant_choices` was called. Call it before the first frame.
    const VariantChoices& variant_choices() const { return choices_; }
    void set_variant_choices(const VariantChoices& choices) { choices_ = choices; }
    /// Returns whether vertex shaders may write gl_Layer. If not, layered passes run layer by
    /// layer.
    bool supports_layers() const { return layered_; }
    /// Returns whether lists of texels are read from storage buffers, because texel buffers hold
    /// too few. A device may allow as few as 65,536 texels: enough for 21,845 triangles.
    bool texels_in_storage() const { return limits_.maxTexelBufferElements < (1u << 26); }
    /// Returns the most texels, of `texel_bytes` bytes each, that a list may have.
    std::uint64_t max_texels(std::uint64_t texel_bytes) const {
        return texels_in_storage() ? limits_.maxStorageBufferRange / texel_bytes
                                   : limits_.maxTexelBufferElements;
    }
    /// Returns whether images of 32-bit floats can be sampled with linear filtering.
    bool filters_floats() const { return filters_floats_; }
    /// Returns whether shaders may compute with doubles.
    bool has_doubles() const { return doubles_; }
    /// Returns whether fragment shaders may read the number of their triangle. Vulkan ties this to
    /// geometry shaders.
    bool has_primitive_id() const { return primitive_id_; }
    /// Returns whether a pass can blend its first attachment, of 32-bit floats, and leave the
    /// others.
    bool blends_floats() const { return blends_; }
    /// Returns whether the device counts vertices, fragments and other invocations.
    bool has_pipeline_statistics() const { return pipeline_statistics_; }
    /// Returns whether fragment shaders have basic subgroup operations.
    bool has_fragment_subgroups() const { return fragment_subgroups_; }
    bool needs_staging() const { return staged_; }
    std::uint32_t timestamp_bits() const { return timestamp_bits_; }

    /// Returns the index of the first memory type that is among `type_bits` and has all of
    /// `properties`, or -1.
    int find_memory_type(std::uint32_t type_bits, VkMemoryPropertyFlags properties) const;
    /// Returns the bytes of the largest device-local heap.
    std::uint64_t largest_heap_bytes() const;
    /// Returns the most bytes of one allocation.
    std::uint64_t max_allocation() const { return max_allocation_; }
    std::uint64_t heap_bytes(std::uint32_t type) const {
        return memory_.memoryHeaps[memory_.memoryTypes[type].heapIndex].size;
    }
    /// Throws `exhausted`, naming the bytes, and the device's limit if it is exceeded.
    UniqueMemory allocate(std::uint64_t bytes, std::uint32_t type, const std::string& what) const;
    /// Throws as `check_vk` does, for a call that submits work or asks about its result. If the
    /// device is lost, it becomes abandoned.
    void check_result(VkResult result, const std::string& doing);
    /// Throws as `check_vk` does, for a call that waits for the device. If the wait fails, the
    /// device becomes abandoned.
    void check_wait(VkResult result, const std::string& doing);
    bool is_abandoned() const { return abandoned_; }
    /// Throws the error that made the device abandoned, if any. Called before work is submitted.
    void check_not_abandoned() const;
    /// Names the object in validation messages and debuggers. Does nothing without
    /// VK_EXT_debug_utils.
    void set_debug_name(VkObjectType type, std::uint64_t handle, const std::string& name) const;
    bool has_debug_labels() const { return has_debug_utils_; }

    /// Records copies with `record`, submits them and waits. Their writes are visible to the host
    /// and to all later commands. For uploads and read-back, never inside a timed frame. `doing`
    /// completes "Vulkan: cannot " in the message of `exhausted` or `device_lost`.
    template <typename Record>
    void run_commands(const std::string& doing, Record&& record) {
        begin_commands(doing);
        record(commands_);
        finish_commands(doing);
    }

    /// Returns the uploads to buffers that the host cannot map. Made at first use.
    StagedUploads& uploads();
    /// Called before a submit whose work reads the uploaded data.
    void submit_uploads();

    /// Returns the messages of the validation layer so far (errors and warnings).
    const std::vector<std::string>& validation_messages() const { return *validation_messages_; }
    /// Throws `internal` with the first validation message, if there is any.
    void check_validation() const;

private:
    void close();
    void create_instance(const DeviceOptions& options);
    void choose_device(const DeviceOptions& options);
    void adopt_device(const ExternalDevice& given);
    void read_properties(const DeviceOptions& options);
    void create_device();
    void make_command_pool();
    void abandon(const Error& why);
    void begin_commands(const std::string& doing);
    void finish_commands(const std::string& doing);

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
    DeviceProperties info_;
    VariantChoices choices_{};
    bool layered_ = true;
    bool doubles_ = false, primitive_id_ = false, blends_ = false;
    bool pipeline_statistics_ = false;
    bool fragment_subgroups_ = false;
    bool filters_floats_ = false;
    bool staged_ = false;
    bool has_debug_utils_ = false;
    bool is_given_ = false;
    bool abandoned_ = false;
    std::optional<Error> why_abandoned_;
    PFN_vkSetDebugUtilsObjectNameEXT set_debug_name_ = nullptr;
    std::unique_ptr<std::vector<std::string>> validation_messages_;
    UniqueCommandPool command_pool_;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    std::unique_ptr<StagedUploads> uploads_;
};

} // namespace catoptric::gpu
