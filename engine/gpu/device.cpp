#include "gpu/device.hpp"

#include "gpu/uploads.hpp"

#include <algorithm>
#include <atomic>

namespace catoptric::gpu {

namespace {

std::atomic<bool> some_device_abandoned{false};

} // namespace

bool has_abandoned_device() { return some_device_abandoned; }

GpuDevice::GpuDevice(const DeviceOptions& options)
    : validation_messages_(std::make_unique<std::vector<std::string>>()) {
    try {
        if (options.given)
            adopt_external_device(*options.given);
        else
            create_instance(options), choose_physical_device(options);
        read_physical_device(options);
        if (!options.given) create_device();
        make_one_time_command_pool();
    } catch (...) {
        close();
        throw;
    }
}

GpuDevice::~GpuDevice() { close(); }

void GpuDevice::close() {
    if (abandoned_) { // the debug messenger writes to `validation_messages_` as long as the
                      // instance exists
        static_cast<void>(validation_messages_.release());
        return;
    }
    uploads_.reset();
    one_shot_pool_ = {};
    if (is_given_) return;
    if (device_) vkDestroyDevice(device_, nullptr);
    if (messenger_)
        reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(vkGetInstanceProcAddr(
            instance_, "vkDestroyDebugUtilsMessengerEXT"))(instance_, messenger_, nullptr);
    if (surface_) vkDestroySurfaceKHR(instance_, surface_, nullptr);
    if (instance_) vkDestroyInstance(instance_, nullptr);
}

void GpuDevice::abandon_device(const Error& why) {
    abandoned_ = some_device_abandoned = true;
    if (!why_abandoned_) why_abandoned_ = why;
}

void GpuDevice::check_result_and_abandon_if_lost(VkResult result, const std::string& doing) try {
    throw_unless_vk_success(result, doing);
} catch (const Error& error) {
    if (error.failure == Failure::device_lost) abandon_device(error);
    throw;
}

void GpuDevice::check_wait_or_abandon(VkResult result, const std::string& doing) try {
    throw_unless_vk_success(result, doing);
} catch (const Error& error) {
    abandon_device(error);
    throw;
}

void GpuDevice::check_device_not_abandoned() const {
    if (abandoned_)
        fail(why_abandoned_->failure, "the device was given up: ", why_abandoned_->what());
}

int GpuDevice::find_memory_type_index(std::uint32_t type_bits,
                                      VkMemoryPropertyFlags properties) const {
    for (std::uint32_t i = 0; i < memory_.memoryTypeCount; ++i)
        if ((type_bits >> i & 1) &&
            (memory_.memoryTypes[i].propertyFlags & properties) == properties)
            return static_cast<int>(i);
    return -1;
}

std::uint64_t GpuDevice::memory_budget() const {
    std::uint64_t bytes = 0;
    for (std::uint32_t i = 0; i < memory_.memoryHeapCount; ++i)
        if (memory_.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
            bytes = std::max(bytes, memory_.memoryHeaps[i].size);
    return bytes;
}

UniqueMemory GpuDevice::allocate(std::uint64_t bytes, std::uint32_t type,
                                 const std::string& what) const {
    check(bytes <= max_allocation_, Failure::exhausted, what, " wants ", bytes,
          " bytes in one piece, the device allows ", max_allocation_);
    VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    allocate.allocationSize = bytes;
    allocate.memoryTypeIndex = type;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    throw_unless_vk_success(vkAllocateMemory(device_, &allocate, nullptr, &memory),
                            "allocate " + std::to_string(bytes) + " bytes for " + what +
                                " (the device has " + std::to_string(memory_budget()) + ")");
    UniqueMemory owned(device_handle(), memory);
    set_debug_name_of_vulkan_object(VK_OBJECT_TYPE_DEVICE_MEMORY,
                                    reinterpret_cast<std::uint64_t>(memory), what);
    return owned;
}

void GpuDevice::set_debug_name_of_vulkan_object(VkObjectType type, std::uint64_t handle,
                                                const std::string& name) const {
    if (!set_object_name_) return;
    VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT};
    info.objectType = type;
    info.objectHandle = handle;
    info.pObjectName = name.c_str();
    set_object_name_(device_, &info);
}

StagedUploads& GpuDevice::uploads() {
    if (!uploads_) uploads_ = std::make_unique<StagedUploads>(*this);
    return *uploads_;
}

void GpuDevice::submit_uploads() {
    if (uploads_) uploads_->submit();
}

void GpuDevice::begin_one_time_commands(const std::string& doing) {
    check_device_not_abandoned();
    submit_uploads();
    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    throw_unless_vk_success(vkBeginCommandBuffer(one_shot_, &begin),
                            doing + " (begin a command buffer)");
}

/// Submits the copies and waits. Their writes become visible to the host and to all later commands.
void GpuDevice::submit_one_time_commands_and_wait(const std::string& doing) {
    record_memory_barrier(one_shot_, kTransferWriteAccessScope,
                          {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_HOST_BIT,
                           VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_HOST_READ_BIT});
    throw_unless_vk_success(vkEndCommandBuffer(one_shot_), doing + " (end a command buffer)");
    VkCommandBufferSubmitInfo commands{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
    commands.commandBuffer = one_shot_;
    VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
    submit.commandBufferInfoCount = 1;
    submit.pCommandBufferInfos = &commands;
    check_result_and_abandon_if_lost(vkQueueSubmit2(queue_, 1, &submit, VK_NULL_HANDLE), doing);
    check_wait_or_abandon(vkQueueWaitIdle(queue_), doing);
}

void GpuDevice::check_validation() const {
    check(validation_messages_->empty(), Failure::internal, "the validation layer has ",
          validation_messages_->size(), " message(s), the first: ",
          validation_messages_->empty() ? "" : validation_messages_->front());
}

} // namespace catoptric::gpu
