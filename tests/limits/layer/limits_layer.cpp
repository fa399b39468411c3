// VK_LAYER_CATOPTRIC_limits: a Vulkan layer that reports the driver's device with limits that a
// graphics card may have:
// - 65,536 elements in a texel buffer, 128 bytes of push constants, 128 MiB in a storage buffer,
// - no linear filtering of 32-bit float images,
// - device memory of which the host can map only 256 MiB, called the window.
// The layer ends a program with a message if the program exceeds one of these limits.
//
// The driver below the layer must have one memory type, as the software driver has.
#include "support/layer_link.hpp"

#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <set>
#include <span>
#include <string_view>
#include <utility>

namespace {

constexpr std::uint32_t kMostTexels = 65536, kPushBytes = 128, kStorageBytes = 1u << 27;
constexpr VkDeviceSize kWindowBytes = VkDeviceSize{256} << 20;
constexpr std::uint32_t kUnmappable = 0, kWindow = 1, kHost = 2, kTypes = 3;

[[noreturn]] void end(const char* what) {
    std::fprintf(stderr, "VK_LAYER_CATOPTRIC_limits: %s\n", what);
    std::abort();
}

/// Returns the first word of a Vulkan handle. The word is equal for an instance or device and all
/// handles that are made from it.
void* key_of(const void* handle) { return *static_cast<void* const*>(handle); }

/// Functions of the next layer or the driver, for one instance or device.
struct Calls {
    PFN_vkGetInstanceProcAddr instance_proc = nullptr;
    PFN_vkGetDeviceProcAddr device_proc = nullptr;
    std::map<std::string_view, PFN_vkVoidFunction> known;
};
struct Memory {
    std::uint32_t type = 0;
    VkDeviceSize bytes = 0;
};

std::mutex mutex;
std::map<void*, Calls> instances, devices;
std::map<VkDeviceMemory, Memory> memories;
std::set<VkImageView> unfiltered; ///< image views of 32-bit floats
std::set<VkSampler> linear;
std::map<void*, VkDeviceSize> window_used; ///< bytes in use, by device

template <typename Pfn>
Pfn below(const std::map<void*, Calls>& calls, const void* handle, const char* name) {
    const std::lock_guard lock(mutex);
    return reinterpret_cast<Pfn>(calls.at(key_of(handle)).known.at(name));
}
#define NEXT(calls, handle, name) below<PFN_##name>(calls, handle, #name)

// --- limits that the layer reports ---------------------------------------------------------------

void limit(VkPhysicalDeviceLimits& limits) {
    limits.maxTexelBufferElements = std::min(limits.maxTexelBufferElements, kMostTexels);
    limits.maxPushConstantsSize = std::min(limits.maxPushConstantsSize, kPushBytes);
    limits.maxStorageBufferRange = std::min(limits.maxStorageBufferRange, kStorageBytes);
}

void properties(VkPhysicalDevice device, VkPhysicalDeviceProperties* result) {
    NEXT(instances, device, vkGetPhysicalDeviceProperties)(device, result);
    limit(result->limits);
}

void properties2(VkPhysicalDevice device, VkPhysicalDeviceProperties2* result) {
    NEXT(instances, device, vkGetPhysicalDeviceProperties2)(device, result);
    limit(result->properties.limits);
}

bool is_float(VkFormat format) {
    return format == VK_FORMAT_R32_SFLOAT || format == VK_FORMAT_R32G32_SFLOAT ||
           format == VK_FORMAT_R32G32B32_SFLOAT || format == VK_FORMAT_R32G32B32A32_SFLOAT;
}

void format_properties(VkPhysicalDevice device, VkFormat format, VkFormatProperties* result) {
    NEXT(instances, device, vkGetPhysicalDeviceFormatProperties)(device, format, result);
    if (!is_float(format)) return;
    for (VkFormatFeatureFlags* features :
         {&result->linearTilingFeatures, &result->optimalTilingFeatures})
        *features &= ~VkFormatFeatureFlags{VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT};
}

void memory_properties(VkPhysicalDevice device, VkPhysicalDeviceMemoryProperties* result) {
    VkPhysicalDeviceMemoryProperties driver;
    NEXT(instances, device, vkGetPhysicalDeviceMemoryProperties)(device, &driver);
    if (driver.memoryTypeCount != 1) end("wanted a driver with one memory type");
    const VkDeviceSize bytes = driver.memoryHeaps[0].size;
    constexpr VkMemoryPropertyFlags kSeen = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                                            VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    *result = {};
    result->memoryHeapCount = kTypes;
    result->memoryHeaps[kUnmappable] = {bytes, VK_MEMORY_HEAP_DEVICE_LOCAL_BIT};
    result->memoryHeaps[kWindow] = {kWindowBytes, VK_MEMORY_HEAP_DEVICE_LOCAL_BIT};
    result->memoryHeaps[kHost] = {bytes, 0};
    result->memoryTypeCount = kTypes;
    result->memoryTypes[kUnmappable] = {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, kUnmappable};
    result->memoryTypes[kWindow] = {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT | kSeen, kWindow};
    result->memoryTypes[kHost] = {kSeen | VK_MEMORY_PROPERTY_HOST_CACHED_BIT, kHost};
}

void buffer_needs(VkDevice device, VkBuffer buffer, VkMemoryRequirements* result) {
    NEXT(devices, device, vkGetBufferMemoryRequirements)(device, buffer, result);
    result->memoryTypeBits = (1u << kTypes) - 1;
}

void image_needs(VkDevice device, VkImage image, VkMemoryRequirements* result) {
    NEXT(devices, device, vkGetImageMemoryRequirements)(device, image, result);
    result->memoryTypeBits = (1u << kTypes) - 1;
}

void buffer_needs2(VkDevice device, const VkDeviceBufferMemoryRequirements* info,
                   VkMemoryRequirements2* result) {
    NEXT(devices, device, vkGetDeviceBufferMemoryRequirements)(device, info, result);
    result->memoryRequirements.memoryTypeBits = (1u << kTypes) - 1;
}

void image_needs2(VkDevice device, const VkDeviceImageMemoryRequirements* info,
                  VkMemoryRequirements2* result) {
    NEXT(devices, device, vkGetDeviceImageMemoryRequirements)(device, info, result);
    result->memoryRequirements.memoryTypeBits = (1u << kTypes) - 1;
}

// --- calls that the layer checks -----------------------------------------------------------------

VkResult allocate(VkDevice device, const VkMemoryAllocateInfo* info,
                  const VkAllocationCallbacks* callbacks, VkDeviceMemory* memory) {
    const auto next = NEXT(devices, device, vkAllocateMemory);
    VkMemoryAllocateInfo of_driver = *info;
    of_driver.memoryTypeIndex = 0;
    const bool in_window = info->memoryTypeIndex == kWindow;
    {
        const std::lock_guard lock(mutex);
        if (in_window && window_used[key_of(device)] + info->allocationSize > kWindowBytes)
            return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    }
    const VkResult result = next(device, &of_driver, callbacks, memory);
    if (result != VK_SUCCESS) return result;
    const std::lock_guard lock(mutex);
    memories[*memory] = {info->memoryTypeIndex, info->allocationSize};
    if (in_window) window_used[key_of(device)] += info->allocationSize;
    return result;
}

void free_memory(VkDevice device, VkDeviceMemory memory, const VkAllocationCallbacks* callbacks) {
    NEXT(devices, device, vkFreeMemory)(device, memory, callbacks);
    const std::lock_guard lock(mutex);
    const auto found = memories.find(memory);
    if (found == memories.end()) return;
    if (found->second.type == kWindow) window_used[key_of(device)] -= found->second.bytes;
    memories.erase(found);
}

VkResult map(VkDevice device, VkDeviceMemory memory, VkDeviceSize offset, VkDeviceSize size,
             VkMemoryMapFlags flags, void** data) {
    const auto next = NEXT(devices, device, vkMapMemory);
    {
        const std::lock_guard lock(mutex);
        if (memories[memory].type == kUnmappable) end("memory is mapped that cannot be");
    }
    return next(device, memory, offset, size, flags, data);
}

VkResult view_buffer(VkDevice device, const VkBufferViewCreateInfo* info,
                     const VkAllocationCallbacks* callbacks, VkBufferView* view) {
    const VkDeviceSize bytes = info->format == VK_FORMAT_R32_UINT ? 4 : 16;
    if (info->range == VK_WHOLE_SIZE || info->range / bytes > kMostTexels)
        end("a texel buffer has more than 65,536 elements");
    return NEXT(devices, device, vkCreateBufferView)(device, info, callbacks, view);
}

VkResult view_image(VkDevice device, const VkImageViewCreateInfo* info,
                    const VkAllocationCallbacks* callbacks, VkImageView* view) {
    const VkResult result = NEXT(devices, device, vkCreateImageView)(device, info, callbacks, view);
    const std::lock_guard lock(mutex);
    if (result == VK_SUCCESS && is_float(info->format))
        unfiltered.insert(*view);
    else if (result == VK_SUCCESS)
        unfiltered.erase(*view); // drivers reuse handles
    return result;
}

VkResult make_sampler(VkDevice device, const VkSamplerCreateInfo* info,
                      const VkAllocationCallbacks* callbacks, VkSampler* sampler) {
    const VkResult result = NEXT(devices, device, vkCreateSampler)(device, info, callbacks,
                                                                   sampler);
    const std::lock_guard lock(mutex);
    if (result == VK_SUCCESS && info->magFilter == VK_FILTER_LINEAR)
        linear.insert(*sampler);
    else if (result == VK_SUCCESS)
        linear.erase(*sampler);
    return result;
}

void update_sets(VkDevice device, std::uint32_t count, const VkWriteDescriptorSet* writes,
                 std::uint32_t copies, const VkCopyDescriptorSet* copy) {
    {
        const std::lock_guard lock(mutex);
        for (std::uint32_t i = 0; i < count; ++i)
            for (std::uint32_t k = 0;
                 writes[i].descriptorType == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER &&
                 k < writes[i].descriptorCount;
                 ++k)
                if (linear.contains(writes[i].pImageInfo[k].sampler) &&
                    unfiltered.contains(writes[i].pImageInfo[k].imageView))
                    end("an image of 32-bit floats is sampled with linear filtering");
    }
    NEXT(devices, device, vkUpdateDescriptorSets)(device, count, writes, copies, copy);
}

VkResult lay_out(VkDevice device, const VkPipelineLayoutCreateInfo* info,
                 const VkAllocationCallbacks* callbacks, VkPipelineLayout* layout) {
    for (std::uint32_t i = 0; i < info->pushConstantRangeCount; ++i)
        if (info->pPushConstantRanges[i].offset + info->pPushConstantRanges[i].size > kPushBytes)
            end("push constants have more than 128 bytes");
    return NEXT(devices, device, vkCreatePipelineLayout)(device, info, callbacks, layout);
}

// --- the chain of layers -------------------------------------------------------------------------

VkResult create_instance(const VkInstanceCreateInfo* create, const VkAllocationCallbacks* callbacks,
                         VkInstance* instance);
VkResult create_device(VkPhysicalDevice physical, const VkDeviceCreateInfo* create,
                       const VkAllocationCallbacks* callbacks, VkDevice* device);
void destroy_instance(VkInstance instance, const VkAllocationCallbacks* callbacks);
void destroy_device(VkDevice device, const VkAllocationCallbacks* callbacks);
PFN_vkVoidFunction device_proc(VkDevice device, const char* name);
PFN_vkVoidFunction instance_proc(VkInstance instance, const char* name);

struct Hook {
    std::string_view name;
    PFN_vkVoidFunction function;
};

template <typename Function>
PFN_vkVoidFunction as_void(Function* function) {
    return reinterpret_cast<PFN_vkVoidFunction>(function);
}

const Hook kDeviceHooks[] = {
    {"vkGetDeviceProcAddr", as_void(device_proc)},
    {"vkDestroyDevice", as_void(destroy_device)},
    {"vkAllocateMemory", as_void(allocate)},
    {"vkFreeMemory", as_void(free_memory)},
    {"vkMapMemory", as_void(map)},
    {"vkGetBufferMemoryRequirements", as_void(buffer_needs)},
    {"vkGetImageMemoryRequirements", as_void(image_needs)},
    {"vkGetDeviceBufferMemoryRequirements", as_void(buffer_needs2)},
    {"vkGetDeviceImageMemoryRequirements", as_void(image_needs2)},
    {"vkCreateBufferView", as_void(view_buffer)},
    {"vkCreateImageView", as_void(view_image)},
    {"vkCreateSampler", as_void(make_sampler)},
    {"vkUpdateDescriptorSets", as_void(update_sets)},
    {"vkCreatePipelineLayout", as_void(lay_out)},
};

const Hook kInstanceHooks[] = {
    {"vkGetInstanceProcAddr", as_void(instance_proc)},
    {"vkCreateInstance", as_void(create_instance)},
    {"vkDestroyInstance", as_void(destroy_instance)},
    {"vkCreateDevice", as_void(create_device)},
    {"vkGetPhysicalDeviceProperties", as_void(properties)},
    {"vkGetPhysicalDeviceProperties2", as_void(properties2)},
    {"vkGetPhysicalDeviceFormatProperties", as_void(format_properties)},
    {"vkGetPhysicalDeviceMemoryProperties", as_void(memory_properties)},
};

VkResult create_instance(const VkInstanceCreateInfo* create, const VkAllocationCallbacks* callbacks,
                         VkInstance* instance) {
    auto* link = test::find_link<VkLayerInstanceCreateInfo>(
        create, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
    if (!link) return VK_ERROR_INITIALIZATION_FAILED;
    const PFN_vkGetInstanceProcAddr proc = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const auto next = reinterpret_cast<PFN_vkCreateInstance>(
        proc(VK_NULL_HANDLE, "vkCreateInstance"));
    const VkResult result = next(create, callbacks, instance);
    if (result != VK_SUCCESS) return result;
    // Function addresses are taken now. Later the loader would return the first layer's functions
    // instead of those below this layer.
    Calls calls;
    calls.instance_proc = proc;
    for (const Hook& hook : kInstanceHooks)
        calls.known[hook.name] = proc(*instance, hook.name.data());
    const std::lock_guard lock(mutex);
    instances[key_of(*instance)] = std::move(calls);
    return result;
}

void destroy_instance(VkInstance instance, const VkAllocationCallbacks* callbacks) {
    void* const key = key_of(instance);
    NEXT(instances, instance, vkDestroyInstance)(instance, callbacks);
    const std::lock_guard lock(mutex);
    instances.erase(key);
}

VkResult create_device(VkPhysicalDevice physical, const VkDeviceCreateInfo* create,
                       const VkAllocationCallbacks* callbacks, VkDevice* device) {
    auto* link = test::find_link<VkLayerDeviceCreateInfo>(
        create, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
    if (!link) return VK_ERROR_INITIALIZATION_FAILED;
    const PFN_vkGetDeviceProcAddr proc = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const auto next = NEXT(instances, physical, vkCreateDevice);
    const VkResult result = next(physical, create, callbacks, device);
    if (result != VK_SUCCESS) return result;
    Calls calls;
    calls.device_proc = proc;
    for (const Hook& hook : kDeviceHooks) calls.known[hook.name] = proc(*device, hook.name.data());
    const std::lock_guard lock(mutex);
    devices[key_of(*device)] = std::move(calls);
    return result;
}

void destroy_device(VkDevice device, const VkAllocationCallbacks* callbacks) {
    void* const key = key_of(device);
    NEXT(devices, device, vkDestroyDevice)(device, callbacks);
    const std::lock_guard lock(mutex);
    devices.erase(key), window_used.erase(key);
}

PFN_vkVoidFunction find(std::span<const Hook> hooks, const char* name) {
    const auto found = std::ranges::find(hooks, std::string_view(name), &Hook::name);
    return found == hooks.end() ? nullptr : found->function;
}

PFN_vkVoidFunction device_proc(VkDevice device, const char* name) {
    if (const PFN_vkVoidFunction hook = find(kDeviceHooks, name)) return hook;
    const std::lock_guard lock(mutex);
    return devices.at(key_of(device)).device_proc(device, name);
}

PFN_vkVoidFunction instance_proc(VkInstance instance, const char* name) {
    if (const PFN_vkVoidFunction hook = find(kInstanceHooks, name)) return hook;
    if (const PFN_vkVoidFunction hook = find(kDeviceHooks, name)) return hook;
    if (!instance) return nullptr;
    const std::lock_guard lock(mutex);
    return instances.at(key_of(instance)).instance_proc(instance, name);
}

} // namespace

extern "C" VK_LAYER_EXPORT VkResult
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* interface) {
    interface->loaderLayerInterfaceVersion = 2;
    interface->pfnGetInstanceProcAddr = instance_proc;
    interface->pfnGetDeviceProcAddr = device_proc;
    interface->pfnGetPhysicalDeviceProcAddr = nullptr;
    return VK_SUCCESS;
}
