#include "gpu/device.hpp"

#include "core/knob.hpp"
#include "gpu/instance.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>

namespace catoptric::gpu {

namespace {

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                          VkDebugUtilsMessageTypeFlagsEXT,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data,
                                          void* messages) {
    static_cast<std::vector<std::string>*>(messages)->push_back(data->pMessage);
    return VK_FALSE;
}

VkDebugUtilsMessengerEXT make_debug_messenger(VkInstance instance,
                                              std::vector<std::string>& messages) {
    VkDebugUtilsMessengerCreateInfoEXT create{
        VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
    create.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                             VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    create.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    create.pfnUserCallback = on_message;
    create.pUserData = &messages;
    const auto make = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance, "vkCreateDebugUtilsMessengerEXT"));
    VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
    check_vk(make(instance, &create, nullptr, &messenger), "create the validation messenger");
    return messenger;
}

std::string to_lower(std::string text) {
    std::ranges::transform(text, text.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

/// Returns whether a device's name has the wanted text, in capitals or not. A number, such as 4090,
/// must be a whole number of the name with at least three digits, so that an index that is out of
/// range selects no device.
bool matches_name(const std::string& name, const std::string& wanted, bool is_number) {
    if (!is_number) return to_lower(name).find(to_lower(wanted)) != std::string::npos;
    constexpr std::size_t kLeastDigits = 3;
    constexpr std::string_view kNumberCharacters = "0123456789.";
    if (wanted.size() < kLeastDigits) return false;
    for (std::size_t begin = 0;
         (begin = name.find_first_of(kNumberCharacters, begin)) != name.npos;) {
        const std::size_t end = std::min(name.find_first_not_of(kNumberCharacters, begin),
                                         name.size());
        if (name.substr(begin, end - begin) == wanted) return true;
        begin = end;
    }
    return false;
}

std::size_t find_device(const std::vector<DeviceProperties>& devices, const std::string& wanted) {
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), index);
    const bool is_number = error == std::errc{} && end == wanted.data() + wanted.size();
    if (is_number && index < devices.size()) return index;
    std::vector<std::string> names;
    for (const DeviceProperties& info : devices) {
        if (matches_name(info.name, wanted, is_number)) return names.size();
        names.push_back(info.name);
    }
    std::string list;
    for (std::size_t i = 0; i < names.size(); ++i)
        list += (i ? ", " : "") + std::to_string(i) + " '" + names[i] + "'";
    fail(
        Failure::usage, "no device '", wanted, "': there are ", names.size(),
        ", counted from 0: ", list, suggest_name(wanted, names),
        "; --device takes an index or a part of a name; a card is listed once its Vulkan driver is "
        "installed, see 'vulkaninfo --summary'");
}

std::vector<DeviceProperties> describe_devices(const std::vector<VkPhysicalDevice>& devices) {
    std::vector<DeviceProperties> list;
    list.reserve(devices.size());
    for (VkPhysicalDevice device : devices) list.push_back(describe_device(device));
    return list;
}

} // namespace

std::vector<DeviceProperties> list_devices() {
    bool has_debug_utils = false;
    const VkInstance instance = make_instance(false, {}, has_debug_utils);
    std::vector<DeviceProperties> list;
    try {
        list = describe_devices(physical_devices(instance));
    } catch (...) {
        vkDestroyInstance(instance, nullptr);
        throw;
    }
    vkDestroyInstance(instance, nullptr);
    return list;
}

void Device::create_instance(const DeviceOptions& options) {
    instance_ = make_instance(options.validate, options.instance_extensions, has_debug_utils_);
    if (options.validate && has_debug_utils_)
        messenger_ = make_debug_messenger(instance_, *validation_messages_);
    if (options.make_surface) surface_ = options.make_surface(instance_);
}

void Device::choose_device(const DeviceOptions& options) {
    const std::vector<VkPhysicalDevice> devices = physical_devices(instance_);
    std::vector<DeviceProperties> infos = describe_devices(devices);
    for (std::size_t i = 0; surface_ && i < infos.size(); ++i)
        if (infos[i].missing.empty() && !can_present(devices[i], surface_))
            infos[i].missing = "a way to show pictures in this window";
    std::size_t index = 0;
    if (!options.wanted.empty())
        index = find_device(infos, options.wanted);
    else
        index = static_cast<std::size_t>(
            std::ranges::find(infos, std::string(), &DeviceProperties::missing) - infos.begin());
    if (index == infos.size()) // `physical_devices` returns at least one
        fail(Failure::no_device, "no usable Vulkan device: '", infos[0].name, "' lacks ",
             infos[0].missing);
    check(infos[index].missing.empty(), Failure::no_device, "device '", infos[index].name,
          "' lacks ", infos[index].missing);
    physical_ = devices[index];
    info_ = infos[index];
    queue_family_ = static_cast<std::uint32_t>(find_queue_family(physical_));
}

void Device::adopt_device(const ExternalDevice& given) {
    is_given_ = true;
    instance_ = given.instance, physical_ = given.physical, device_ = given.device;
    queue_ = given.queue, queue_family_ = given.queue_family;
    check(instance_ && physical_ && device_ && queue_, Failure::usage,
          "a given device wants an instance, a physical device, a device and a queue");
    info_ = describe_device(physical_);
    check(info_.missing.empty(), Failure::no_device, "the given device '", info_.name, "' lacks ",
          info_.missing);
}

/// Reads limits and features of the physical device.
void Device::read_properties(const DeviceOptions& options) {
    staged_ = options.staged;
    VkPhysicalDeviceMaintenance3Properties pieces{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &pieces};
    vkGetPhysicalDeviceProperties2(physical_, &properties);
    limits_ = properties.properties.limits;
    max_allocation_ = pieces.maxMemoryAllocationSize;
    vkGetPhysicalDeviceMemoryProperties(physical_, &memory_);
    DeviceFeatures has;
    vkGetPhysicalDeviceFeatures2(physical_, &has.core);
    layered_ = options.layered && has.v12.shaderOutputLayer;
    doubles_ = has.core.features.shaderFloat64;
    primitive_id_ = has.core.features.geometryShader;
    pipeline_statistics_ = has.core.features.pipelineStatisticsQuery;
    fragment_subgroups_ = DeviceFeatures::has_fragment_subgroups(physical_);
    filters_floats_ = DeviceFeatures::filters_floats(physical_);
    blends_ = has.core.features.independentBlend && DeviceFeatures::blends_floats(physical_);
    std::uint32_t count = queue_family_ + 1;
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physical_, &count, families.data());
    check(count > queue_family_, Failure::usage, "device '", info_.name, "' has ", count,
          " queue families, number ", queue_family_, " was given");
    timestamp_bits_ = families[queue_family_].timestampValidBits;
    constexpr VkQueueFlags kRequiredQueueFlags = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    check((families[queue_family_].queueFlags & kRequiredQueueFlags) == kRequiredQueueFlags &&
              timestamp_bits_ > 0,
          Failure::usage, "device '", info_.name,
          "': wanted a queue family that draws, dispatches "
          "and has timestamps, found number ",
          queue_family_, ", which does not");
}

void Device::create_device() {
    const float priority = 1;
    VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queue.queueFamilyIndex = queue_family_;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    DeviceFeatures features;
    features.enable(physical_);
    VkDeviceCreateInfo create{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features.core};
    const char* const extension = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    create.enabledExtensionCount = surface_ ? 1 : 0;
    create.ppEnabledExtensionNames = &extension;
    create.queueCreateInfoCount = 1;
    create.pQueueCreateInfos = &queue;
    check_vk_started(vkCreateDevice(physical_, &create, nullptr, &device_),
                     "open device '" + info_.name + "'", "no usable Vulkan device");
    vkGetDeviceQueue(device_, queue_family_, 0, &queue_);
    if (has_debug_utils_)
        set_debug_name_ = reinterpret_cast<PFN_vkSetDebugUtilsObjectNameEXT>(
            vkGetDeviceProcAddr(device_, "vkSetDebugUtilsObjectNameEXT"));
}

void Device::make_command_pool() {
    VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    pool.queueFamilyIndex = queue_family_;
    VkCommandPool handle = VK_NULL_HANDLE;
    check_vk(vkCreateCommandPool(device_, &pool, nullptr, &handle), "create a command pool");
    command_pool_ = {this->handle(), handle};
    VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    allocate.commandPool = handle;
    allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    allocate.commandBufferCount = 1;
    check_vk(vkAllocateCommandBuffers(device_, &allocate, &commands_), "allocate a command buffer");
    set_debug_name(VK_OBJECT_TYPE_COMMAND_BUFFER, reinterpret_cast<std::uint64_t>(commands_),
                   "one shot");
}

} // namespace catoptric::gpu
