// VK_LAYER_CATOPTRIC_limits: a Vulkan layer that reports the driver's device with limits that a
// graphics card may have:
// - 65,536 elements in a texel buffer, 128 bytes of push constants, 128 MiB in a storage buffer,
// - no linear filtering of 32-bit float images,
// - one way of blending for all attachments of a pass,
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

constexpr std::uint32_t kMaxTexelBufferTexels = 65536, kMaxPushConstantBytes = 128,
                        kMaxStorageBufferBytes = 1u << 27;
constexpr VkDeviceSize kMappedWindowBytes = VkDeviceSize{256} << 20;
constexpr std::uint32_t kUnmappableMemoryType = 0, kMappedWindowMemoryType = 1,
                        kHostVisibleMemoryType = 2, kMemoryTypeCount = 3;

[[noreturn]] void end_process_with_message(const char* what) {
    std::fprintf(stderr, "VK_LAYER_CATOPTRIC_limits: %s\n", what);
    std::abort();
}

/// Returns the first word of a Vulkan handle. The word is equal for an instance or device and all
/// handles that are made from it.
void* dispatch_key_of_handle(const void* handle) { return *static_cast<void* const*>(handle); }

/// Functions of the next layer or the driver, for one instance or device.
struct NextLayerCalls {
    PFN_vkGetInstanceProcAddr instance_proc = nullptr;
    PFN_vkGetDeviceProcAddr device_proc = nullptr;
    std::map<std::string_view, PFN_vkVoidFunction> known;
};
struct MappedMemoryWindow {
    std::uint32_t type = 0;
    VkDeviceSize bytes = 0;
};

std::mutex mutex;
std::map<void*, NextLayerCalls> instances, devices;
std::map<VkDeviceMemory, MappedMemoryWindow> memories;
std::set<VkImageView> unfiltered; ///< image views of 32-bit floats
std::set<VkSampler> linear;
std::map<void*, VkDeviceSize> window_used; ///< bytes in use, by device

template <typename Pfn>
Pfn find_next_function(const std::map<void*, NextLayerCalls>& calls, const void* handle,
                       const char* name) {
    const std::lock_guard lock(mutex);
    return reinterpret_cast<Pfn>(calls.at(dispatch_key_of_handle(handle)).known.at(name));
}
#define NEXT(calls, handle, name) find_next_function<PFN_##name>(calls, handle, #name)

// --- limits that the layer reports ---------------------------------------------------------------

void reduce_device_limits(VkPhysicalDeviceLimits& limits) {
    limits.maxTexelBufferElements = std::min(limits.maxTexelBufferElements, kMaxTexelBufferTexels);
    limits.maxPushConstantsSize = std::min(limits.maxPushConstantsSize, kMaxPushConstantBytes);
    limits.maxStorageBufferRange = std::min(limits.maxStorageBufferRange, kMaxStorageBufferBytes);
}

void hook_device_properties(VkPhysicalDevice device, VkPhysicalDeviceProperties* result) {
    NEXT(instances, device, vkGetPhysicalDeviceProperties)(device, result);
    reduce_device_limits(result->limits);
}

void hook_device_properties2(VkPhysicalDevice device, VkPhysicalDeviceProperties2* result) {
    NEXT(instances, device, vkGetPhysicalDeviceProperties2)(device, result);
    reduce_device_limits(result->properties.limits);
}

void hook_device_features2(VkPhysicalDevice device, VkPhysicalDeviceFeatures2* result) {
    NEXT(instances, device, vkGetPhysicalDeviceFeatures2)(device, result);
    result->features.independentBlend = VK_FALSE;
}

bool is_float_format(VkFormat format) {
    return format == VK_FORMAT_R32_SFLOAT || format == VK_FORMAT_R32G32_SFLOAT ||
           format == VK_FORMAT_R32G32B32_SFLOAT || format == VK_FORMAT_R32G32B32A32_SFLOAT;
}

void hook_format_properties(VkPhysicalDevice device, VkFormat format, VkFormatProperties* result) {
    NEXT(instances, device, vkGetPhysicalDeviceFormatProperties)(device, format, result);
    if (!is_float_format(format)) return;
    for (VkFormatFeatureFlags* features :
         {&result->linearTilingFeatures, &result->optimalTilingFeatures})
        *features &= ~VkFormatFeatureFlags{VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT};
}

void hook_memory_properties(VkPhysicalDevice device, VkPhysicalDeviceMemoryProperties* result) {
    VkPhysicalDeviceMemoryProperties driver;
    NEXT(instances, device, vkGetPhysicalDeviceMemoryProperties)(device, &driver);
    if (driver.memoryTypeCount != 1)
        end_process_with_message("wanted a driver with one memory type");
    const VkDeviceSize bytes = driver.memoryHeaps[0].size;
    constexpr VkMemoryPropertyFlags kHostVisibleFlags = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                                                        VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    *result = {};
    result->memoryHeapCount = kMemoryTypeCount;
    result->memoryHeaps[kUnmappableMemoryType] = {bytes, VK_MEMORY_HEAP_DEVICE_LOCAL_BIT};
    result->memoryHeaps[kMappedWindowMemoryType] = {kMappedWindowBytes,
                                                    VK_MEMORY_HEAP_DEVICE_LOCAL_BIT};
    result->memoryHeaps[kHostVisibleMemoryType] = {bytes, 0};
    result->memoryTypeCount = kMemoryTypeCount;
    result->memoryTypes[kUnmappableMemoryType] = {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT,
                                                  kUnmappableMemoryType};
    result->memoryTypes[kMappedWindowMemoryType] = {
        VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT | kHostVisibleFlags, kMappedWindowMemoryType};
    result->memoryTypes[kHostVisibleMemoryType] = {
        kHostVisibleFlags | VK_MEMORY_PROPERTY_HOST_CACHED_BIT, kHostVisibleMemoryType};
}

void hook_buffer_requirements(VkDevice device, VkBuffer buffer, VkMemoryRequirements* result) {
    NEXT(devices, device, vkGetBufferMemoryRequirements)(device, buffer, result);
    result->memoryTypeBits = (1u << kMemoryTypeCount) - 1;
}

void hook_image_requirements(VkDevice device, VkImage image, VkMemoryRequirements* result) {
    NEXT(devices, device, vkGetImageMemoryRequirements)(device, image, result);
    result->memoryTypeBits = (1u << kMemoryTypeCount) - 1;
}

void hook_device_buffer_requirements(VkDevice device, const VkDeviceBufferMemoryRequirements* info,
                                     VkMemoryRequirements2* result) {
    NEXT(devices, device, vkGetDeviceBufferMemoryRequirements)(device, info, result);
    result->memoryRequirements.memoryTypeBits = (1u << kMemoryTypeCount) - 1;
}

void hook_device_image_requirements(VkDevice device, const VkDeviceImageMemoryRequirements* info,
                                    VkMemoryRequirements2* result) {
    NEXT(devices, device, vkGetDeviceImageMemoryRequirements)(device, info, result);
    result->memoryRequirements.memoryTypeBits = (1u << kMemoryTypeCount) - 1;
}

// --- calls that the layer checks -----------------------------------------------------------------

VkResult hook_allocate_memory(VkDevice device, const VkMemoryAllocateInfo* info,
                              const VkAllocationCallbacks* callbacks, VkDeviceMemory* memory) {
    const auto next = NEXT(devices, device, vkAllocateMemory);
    VkMemoryAllocateInfo of_driver = *info;
    of_driver.memoryTypeIndex = 0;
    const bool in_window = info->memoryTypeIndex == kMappedWindowMemoryType;
    {
        const std::lock_guard lock(mutex);
        if (in_window &&
            window_used[dispatch_key_of_handle(device)] + info->allocationSize > kMappedWindowBytes)
            return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    }
    const VkResult result = next(device, &of_driver, callbacks, memory);
    if (result != VK_SUCCESS) return result;
    const std::lock_guard lock(mutex);
    memories[*memory] = {info->memoryTypeIndex, info->allocationSize};
    if (in_window) window_used[dispatch_key_of_handle(device)] += info->allocationSize;
    return result;
}

void hook_free_memory(VkDevice device, VkDeviceMemory memory,
                      const VkAllocationCallbacks* callbacks) {
    NEXT(devices, device, vkFreeMemory)(device, memory, callbacks);
    const std::lock_guard lock(mutex);
    const auto found = memories.find(memory);
    if (found == memories.end()) return;
    if (found->second.type == kMappedWindowMemoryType)
        window_used[dispatch_key_of_handle(device)] -= found->second.bytes;
    memories.erase(found);
}

VkResult hook_map_memory(VkDevice device, VkDeviceMemory memory, VkDeviceSize offset,
                         VkDeviceSize size, VkMemoryMapFlags flags, void** data) {
    const auto next = NEXT(devices, device, vkMapMemory);
    {
        const std::lock_guard lock(mutex);
        if (memories[memory].type == kUnmappableMemoryType)
            end_process_with_message("memory is mapped that cannot be");
    }
    return next(device, memory, offset, size, flags, data);
}

VkResult hook_create_buffer_view(VkDevice device, const VkBufferViewCreateInfo* info,
                                 const VkAllocationCallbacks* callbacks, VkBufferView* view) {
    const VkDeviceSize bytes = info->format == VK_FORMAT_R32_UINT ? 4 : 16;
    if (info->range == VK_WHOLE_SIZE || info->range / bytes > kMaxTexelBufferTexels)
        end_process_with_message("a texel buffer has more than 65,536 elements");
    return NEXT(devices, device, vkCreateBufferView)(device, info, callbacks, view);
}

VkResult hook_create_image_view(VkDevice device, const VkImageViewCreateInfo* info,
                                const VkAllocationCallbacks* callbacks, VkImageView* view) {
    const VkResult result = NEXT(devices, device, vkCreateImageView)(device, info, callbacks, view);
    const std::lock_guard lock(mutex);
    if (result == VK_SUCCESS && is_float_format(info->format))
        unfiltered.insert(*view);
    else if (result == VK_SUCCESS)
        unfiltered.erase(*view); // drivers reuse handles
    return result;
}

VkResult hook_create_sampler(VkDevice device, const VkSamplerCreateInfo* info,
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

void hook_update_descriptor_sets(VkDevice device, std::uint32_t count,
                                 const VkWriteDescriptorSet* writes, std::uint32_t copies,
                                 const VkCopyDescriptorSet* copy) {
    {
        const std::lock_guard lock(mutex);
        for (std::uint32_t i = 0; i < count; ++i)
            for (std::uint32_t k = 0;
                 writes[i].descriptorType == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER &&
                 k < writes[i].descriptorCount;
                 ++k)
                if (linear.contains(writes[i].pImageInfo[k].sampler) &&
                    unfiltered.contains(writes[i].pImageInfo[k].imageView))
                    end_process_with_message(
                        "an image of 32-bit floats is sampled with linear filtering");
    }
    NEXT(devices, device, vkUpdateDescriptorSets)(device, count, writes, copies, copy);
}

VkResult hook_create_pipeline_layout(VkDevice device, const VkPipelineLayoutCreateInfo* info,
                                     const VkAllocationCallbacks* callbacks,
                                     VkPipelineLayout* layout) {
    for (std::uint32_t i = 0; i < info->pushConstantRangeCount; ++i)
        if (info->pPushConstantRanges[i].offset + info->pPushConstantRanges[i].size >
            kMaxPushConstantBytes)
            end_process_with_message("push constants have more than 128 bytes");
    return NEXT(devices, device, vkCreatePipelineLayout)(device, info, callbacks, layout);
}

// --- the chain of layers -------------------------------------------------------------------------

VkResult hook_create_instance(const VkInstanceCreateInfo* create,
                              const VkAllocationCallbacks* callbacks, VkInstance* instance);
VkResult hook_create_device(VkPhysicalDevice physical, const VkDeviceCreateInfo* create,
                            const VkAllocationCallbacks* callbacks, VkDevice* device);
void hook_destroy_instance(VkInstance instance, const VkAllocationCallbacks* callbacks);
void hook_destroy_device(VkDevice device, const VkAllocationCallbacks* callbacks);
PFN_vkVoidFunction find_device_function(VkDevice device, const char* name);
PFN_vkVoidFunction find_instance_function(VkInstance instance, const char* name);

struct FunctionHook {
    std::string_view name;
    PFN_vkVoidFunction function;
};

template <typename Function>
PFN_vkVoidFunction to_void_function(Function* function) {
    return reinterpret_cast<PFN_vkVoidFunction>(function);
}

const FunctionHook kDeviceHooks[] = {
    {"vkGetDeviceProcAddr", to_void_function(find_device_function)},
    {"vkDestroyDevice", to_void_function(hook_destroy_device)},
    {"vkAllocateMemory", to_void_function(hook_allocate_memory)},
    {"vkFreeMemory", to_void_function(hook_free_memory)},
    {"vkMapMemory", to_void_function(hook_map_memory)},
    {"vkGetBufferMemoryRequirements", to_void_function(hook_buffer_requirements)},
    {"vkGetImageMemoryRequirements", to_void_function(hook_image_requirements)},
    {"vkGetDeviceBufferMemoryRequirements", to_void_function(hook_device_buffer_requirements)},
    {"vkGetDeviceImageMemoryRequirements", to_void_function(hook_device_image_requirements)},
    {"vkCreateBufferView", to_void_function(hook_create_buffer_view)},
    {"vkCreateImageView", to_void_function(hook_create_image_view)},
    {"vkCreateSampler", to_void_function(hook_create_sampler)},
    {"vkUpdateDescriptorSets", to_void_function(hook_update_descriptor_sets)},
    {"vkCreatePipelineLayout", to_void_function(hook_create_pipeline_layout)},
};

const FunctionHook kInstanceHooks[] = {
    {"vkGetInstanceProcAddr", to_void_function(find_instance_function)},
    {"vkCreateInstance", to_void_function(hook_create_instance)},
    {"vkDestroyInstance", to_void_function(hook_destroy_instance)},
    {"vkCreateDevice", to_void_function(hook_create_device)},
    {"vkGetPhysicalDeviceProperties", to_void_function(hook_device_properties)},
    {"vkGetPhysicalDeviceProperties2", to_void_function(hook_device_properties2)},
    {"vkGetPhysicalDeviceFeatures2", to_void_function(hook_device_features2)},
    {"vkGetPhysicalDeviceFormatProperties", to_void_function(hook_format_properties)},
    {"vkGetPhysicalDeviceMemoryProperties", to_void_function(hook_memory_properties)},
};

VkResult hook_create_instance(const VkInstanceCreateInfo* create,
                              const VkAllocationCallbacks* callbacks, VkInstance* instance) {
    auto* link = test::find_next_layer_link<VkLayerInstanceCreateInfo>(
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
    NextLayerCalls calls;
    calls.instance_proc = proc;
    for (const FunctionHook& hook : kInstanceHooks)
        calls.known[hook.name] = proc(*instance, hook.name.data());
    const std::lock_guard lock(mutex);
    instances[dispatch_key_of_handle(*instance)] = std::move(calls);
    return result;
}

void hook_destroy_instance(VkInstance instance, const VkAllocationCallbacks* callbacks) {
    void* const key = dispatch_key_of_handle(instance);
    NEXT(instances, instance, vkDestroyInstance)(instance, callbacks);
    const std::lock_guard lock(mutex);
    instances.erase(key);
}

VkResult hook_create_device(VkPhysicalDevice physical, const VkDeviceCreateInfo* create,
                            const VkAllocationCallbacks* callbacks, VkDevice* device) {
    auto* link = test::find_next_layer_link<VkLayerDeviceCreateInfo>(
        create, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
    if (!link) return VK_ERROR_INITIALIZATION_FAILED;
    const PFN_vkGetDeviceProcAddr proc = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const auto next = NEXT(instances, physical, vkCreateDevice);
    const VkResult result = next(physical, create, callbacks, device);
    if (result != VK_SUCCESS) return result;
    NextLayerCalls calls;
    calls.device_proc = proc;
    for (const FunctionHook& hook : kDeviceHooks)
        calls.known[hook.name] = proc(*device, hook.name.data());
    const std::lock_guard lock(mutex);
    devices[dispatch_key_of_handle(*device)] = std::move(calls);
    return result;
}

void hook_destroy_device(VkDevice device, const VkAllocationCallbacks* callbacks) {
    void* const key = dispatch_key_of_handle(device);
    NEXT(devices, device, vkDestroyDevice)(device, callbacks);
    const std::lock_guard lock(mutex);
    devices.erase(key), window_used.erase(key);
}

PFN_vkVoidFunction find_intercepting_function(std::span<const FunctionHook> hooks,
                                              const char* name) {
    const auto found = std::ranges::find(hooks, std::string_view(name), &FunctionHook::name);
    return found == hooks.end() ? nullptr : found->function;
}

PFN_vkVoidFunction find_device_function(VkDevice device, const char* name) {
    if (const PFN_vkVoidFunction hook = find_intercepting_function(kDeviceHooks, name)) return hook;
    const std::lock_guard lock(mutex);
    return devices.at(dispatch_key_of_handle(device)).device_proc(device, name);
}

PFN_vkVoidFunction find_instance_function(VkInstance instance, const char* name) {
    if (const PFN_vkVoidFunction hook = find_intercepting_function(kInstanceHooks, name))
        return hook;
    if (const PFN_vkVoidFunction hook = find_intercepting_function(kDeviceHooks, name)) return hook;
    if (!instance) return nullptr;
    const std::lock_guard lock(mutex);
    return instances.at(dispatch_key_of_handle(instance)).instance_proc(instance, name);
}

} // namespace

extern "C" VK_LAYER_EXPORT VkResult
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* interface) {
    interface->loaderLayerInterfaceVersion = 2;
    interface->pfnGetInstanceProcAddr = find_instance_function;
    interface->pfnGetDeviceProcAddr = find_device_function;
    interface->pfnGetPhysicalDeviceProcAddr = nullptr;
    return VK_SUCCESS;
}
