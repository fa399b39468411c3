#include "gpu/device.hpp"

#include "gpu/uploads.hpp"

#include <algorithm>
#include <atomic>

namespace catoptric::gpu {

namespace {

std::atomic<bool> some_device_abandoned{false};

} // namespace

bool has_abandoned_device() { return some_device_abandoned; }

Device::Device(const DeviceOptions& options)
    : validation_messages_(std::make_unique<std::vector<std::string>>()) {
    try {
        if (options.given)
            adopt_device(*options.given);
        else
            create_instance(options), choose_device(options);
        read_properties(options);
        if (!options.given) create_device();
        make_command_pool();
    } catch (...) {
        close();
        throw;
    }
}

Device::~Device() { close(); }

void Device::close() {
    if (abandoned_) { // the debug messenger writes to `validation_messages_` as long as the
                      // instance exists
        static_cast<void>(validation_messages_.release());
        return;
    }
    uploads_.reset();
    command_pool_ = {};
    if (is_given_) return;
    if (device_) vkDestroyDevice(device_, nullptr);
    if (messenger_)
        reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(vkGetInstanceProcAddr(
            instance_, "vkDestroyDebugUtilsMessengerEXT"))(instance_, messenger_, nullptr);
    if (surface_) vkDestroySurfaceKHR(instance_, surface_, nullptr);
    if (instance_) vkDestroyInstance(instance_, nullptr);
}

void Device::abandon(const Error& why) {
    abandoned_ = some_device_abandoned = true;
    if (!why_abandoned_) why_abandoned_ = why;
}

void Device::check_result(VkResult result, const std::string& doing) try {
    check_vk(result, doing);
} catch (const Error& error) {
    if (error.failure == Failure::device_lost) abandon(error);
    throw;
}

void Device::check_wait(VkResult result, const std::string& doing) try {
    check_vk(result, doing);
} catch (const Error& error) {
    abandon(error);
    throw;
}

void Device::check_not_abandoned() const {
    if (abandoned_)
        fail(why_abandoned_->failure, "the device was given up: ", why_abandoned_->what());
}

int Device::find_memory_type(std::uint32_t type_bits, VkMemoryPropertyFlags properties) const {
    for (std::uint32_t i = 0; i < memory_.memoryTypeCount; ++i)
        if ((type_bits >> i & 1) &&
            (memory_.memoryTypes[i].propertyFlags & properties) == properties)
            return static_cast<int>(i);
    return -1;
}

std::uint64_t Device::largest_heap_bytes() const {
    std::uint64_t bytes = 0;
    for (std::uint32_t i = 0; i < memory_.memoryHeapCount; ++i)
        if (memory_.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
            bytes = std::max(bytes, memory_.memoryHeaps[i].size);
    return bytes;
}

UniqueMemory Device::allocate(std::uint64_t bytes, std::uint32_t type,
                              const std::string& what) const {
    check(bytes <= max_allocation_, Failure::exhausted, what, " wants ", bytes,
          " bytes in one piece, the device allows ", max_allocation_);
    VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    allocate.allocationSize = bytes;
    allocate.memoryTypeIndex = type;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    check_vk(vkAllocateMemory(device_, &allocate, nullptr, &memory),
             "allocate " + std::to_string(bytes) + " bytes for " + what + " (the device has " +
                 std::to_string(largest_heap_bytes()) + ")");
    UniqueMemory owned(handle(), memory);
    set_debug_name(VK_OBJECT_TYPE_DEVICE_MEMORY, reinterpret_cast<std::uint64_t>(memory), what);
    return owned;
}

void Device::set_debug_name(VkObjectType type, std::uint64_t handle,
                            const std::string& name) const {
    if (!set_debug_name_) return;
    VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT};
    info.objectType = type;
    info.objectHandle = handle;
    info.pObjectName = name.c_str();
    set_debug_name_(device_, &info);
}

StagedUploads& Device::uploads() {
    if (!uploads_) uploads_ = std::make_unique<StagedUploads>(*this);
    return *uploads_;
}

void Device::submit_uploads() {
    if (uploads_) uploads_->submit();
}

void Device::begin_commands(const std::string& doing) {
    check_not_abandoned();
    submit_uploads();
    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check_vk(vkBeginCommandBuffer(commands_, &begin), doing + " (begin a command buffer)");
}

/// Submits the copies and waits. Their writes become visible to the host and to all later commands.
void Device::finish_commands(const std::string& doing) {
    memory_barrier(commands_, kTransferWrite,
                   {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_HOST_BIT,
                    VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_HOST_READ_BIT});
    check_vk(vkEndCommandBuffer(commands_), doing + " (end a command buffer)");
    VkCommandBufferSubmitInfo commands{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
    commands.commandBuffer = commands_;
    VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
    submit.commandBufferInfoCount = 1;
    submit.pCommandBufferInfos = &commands;
    check_result(vkQueueSubmit2(queue_, 1, &submit, VK_NULL_HANDLE), doing);
    check_wait(vkQueueWaitIdle(queue_), doing);
}

void Device::check_validation() const {
    check(validation_messages_->empty(), Failure::internal, "the validation layer has ",
          validation_messages_->size(), " message(s), the first: ",
          validation_messages_->empty() ? "" : validation_messages_->front());
}

} // namespace catoptric::gpu
