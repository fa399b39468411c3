#include "drivers/ray_query_device.hpp"

#include "gpu/instance.hpp"

#include <array>
#include <cstring>

namespace test {

namespace {

using gpu::check_vk;

constexpr std::array kDeviceExtensions{VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME,
                                       VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME,
                                       VK_KHR_RAY_QUERY_EXTENSION_NAME};

bool has_ray_query(VkPhysicalDevice device) {
    std::uint32_t count = 0;
    vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> list(count);
    vkEnumerateDeviceExtensionProperties(device, nullptr, &count, list.data());
    return std::ranges::all_of(kDeviceExtensions, [&](const char* wanted) {
        return std::ranges::any_of(
            list, [&](const auto& e) { return !std::strcmp(e.extensionName, wanted); });
    });
}

VKAPI_ATTR VkBool32 VKAPI_CALL
record_validation_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                          const VkDebugUtilsMessengerCallbackDataEXT* data, void* messages) {
    static_cast<std::vector<std::string>*>(messages)->push_back(data->pMessage);
    return VK_FALSE;
}

template <typename Function>
Function find_instance_function(VkInstance instance, const char* function) {
    return reinterpret_cast<Function>(vkGetInstanceProcAddr(instance, function));
}

} // namespace

std::unique_ptr<RayQueryDevice> RayQueryDevice::open(std::string& reason) {
    std::unique_ptr<RayQueryDevice> result(new RayQueryDevice);
    bool has_debug_utils = false;
    result->instance_ = gpu::make_instance(true, {}, has_debug_utils);
    if (has_debug_utils) result->make_ray_query_debug_messenger();
    for (VkPhysicalDevice device : gpu::physical_devices(result->instance_)) {
        const gpu::DeviceProperties info = gpu::describe_device(device);
        result->name_ = info.name + ", " + info.driver;
        if (info.missing.empty() && has_ray_query(device)) {
            result->physical_ = device;
            result->make_ray_query_device();
            return result;
        }
        reason += (reason.empty() ? "no VK_KHR_ray_query on " : "; ") + result->name_;
    }
    return nullptr;
}

RayQueryDevice::~RayQueryDevice() {
    command_pool_ = {};
    if (device_) vkDestroyDevice(device_, nullptr);
    if (messenger_)
        find_instance_function<PFN_vkDestroyDebugUtilsMessengerEXT>(
            instance_, "vkDestroyDebugUtilsMessengerEXT")(instance_, messenger_, nullptr);
    if (instance_) vkDestroyInstance(instance_, nullptr);
}

void RayQueryDevice::make_ray_query_debug_messenger() {
    VkDebugUtilsMessengerCreateInfoEXT create{
        VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
    create.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                             VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    create.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    create.pfnUserCallback = record_validation_message;
    create.pUserData = &messages_;
    check_vk(
        find_instance_function<PFN_vkCreateDebugUtilsMessengerEXT>(
            instance_, "vkCreateDebugUtilsMessengerEXT")(instance_, &create, nullptr, &messenger_),
        "create the validation messenger");
}

void RayQueryDevice::make_ray_query_device() {
    const float priority = 1;
    VkDeviceQueueCreateInfo queues{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queues.queueFamilyIndex = static_cast<std::uint32_t>(gpu::find_queue_family(physical_));
    queues.queueCount = 1;
    queues.pQueuePriorities = &priority;
    VkPhysicalDeviceRayQueryFeaturesKHR ray_query{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR};
    ray_query.rayQuery = true;
    VkPhysicalDeviceAccelerationStructureFeaturesKHR structure{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR, &ray_query};
    structure.accelerationStructure = true;
    gpu::DeviceFeatures features;
    features.v12.bufferDeviceAddress = true;
    features.v13.maintenance4 = true; // glslang's code for Vulkan 1.3 needs this feature
    features.v13.synchronization2 = true;
    features.v13.pNext = &structure;
    VkDeviceCreateInfo create{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features.core};
    create.queueCreateInfoCount = 1;
    create.pQueueCreateInfos = &queues;
    create.enabledExtensionCount = static_cast<std::uint32_t>(kDeviceExtensions.size());
    create.ppEnabledExtensionNames = kDeviceExtensions.data();
    check_vk(vkCreateDevice(physical_, &create, nullptr, &device_),
             "open device '" + name_ + "' with ray queries");
    vkGetDeviceQueue(device_, queues.queueFamilyIndex, 0, &queue_);
    make_ray_query_command_buffer(queues.queueFamilyIndex);
}

void RayQueryDevice::make_ray_query_command_buffer(std::uint32_t queue_family) {
    VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    pool.queueFamilyIndex = queue_family;
    VkCommandPool handle = VK_NULL_HANDLE;
    check_vk(vkCreateCommandPool(device_, &pool, nullptr, &handle), "create a command pool");
    command_pool_ = {{device_}, handle};
    VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    allocate.commandPool = handle;
    allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    allocate.commandBufferCount = 1;
    check_vk(vkAllocateCommandBuffers(device_, &allocate, &commands_), "allocate a command buffer");
}

RayQueryMemory RayQueryDevice::make_ray_query_memory(std::uint64_t bytes, VkBufferUsageFlags usage,
                                                     const void* contents) const {
    VkBufferCreateInfo create{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    create.size = std::max<std::uint64_t>(bytes, 16);
    create.usage = usage | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
    VkBuffer buffer = VK_NULL_HANDLE;
    check_vk(vkCreateBuffer(device_, &create, nullptr, &buffer), "create a buffer");
    RayQueryMemory result;
    result.buffer = {{device_}, buffer};
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device_, buffer, &needs);
    VkPhysicalDeviceMemoryProperties kinds;
    vkGetPhysicalDeviceMemoryProperties(physical_, &kinds);
    constexpr VkMemoryPropertyFlags kSharedMemoryFlags = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                                                         VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    VkMemoryAllocateFlagsInfo flags{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO};
    flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, &flags};
    allocate.allocationSize = needs.size;
    while (!(needs.memoryTypeBits >> allocate.memoryTypeIndex & 1) ||
           (kinds.memoryTypes[allocate.memoryTypeIndex].propertyFlags & kSharedMemoryFlags) !=
               kSharedMemoryFlags)
        check(++allocate.memoryTypeIndex < kinds.memoryTypeCount, Failure::internal,
              "no memory that both sides see");
    VkDeviceMemory memory = VK_NULL_HANDLE;
    check_vk(vkAllocateMemory(device_, &allocate, nullptr, &memory), "allocate memory");
    result.memory = {{device_}, memory};
    check_vk(vkBindBufferMemory(device_, buffer, memory, 0), "bind memory");
    check_vk(vkMapMemory(device_, memory, 0, VK_WHOLE_SIZE, 0, &result.mapped), "map memory");
    if (contents) std::memcpy(result.mapped, contents, bytes);
    VkBufferDeviceAddressInfo address{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO};
    address.buffer = buffer;
    result.address = vkGetBufferDeviceAddress(device_, &address);
    return result;
}

} // namespace test
