// VK_LAYER_CATOPTRIC_faults: a Vulkan layer that makes one call fail and counts all calls. The
// layer reads two environment variables whenever an instance is made:
// - CATOPTRIC_FAULT=vkCreateBuffer:3:-2: the third call of that name returns VkResult -2 and is not
//   passed on. Recorded commands (vkCmd...) return no result. Of these, the named call and all
//   later calls of its name are left out.
// - CATOPTRIC_FAULT_REPORT=FILE: the file to write. The file gets a line "NAME CALLS ALIVE" for
//   each call made, and four totals:
//   "strays N": handles destroyed although they were not alive,
//   "untimely N": handles destroyed while the device may use them,
//   "loose_stamps N": timestamps not directly followed by an execution barrier,
//   "most_bytes N": the largest amount of device memory at one time.
//
// Faults behave as real ones do. A wait that fails has not waited. A submit that returns "lost" has
// submitted, and a lost device stays lost. For vkEnumeratePhysicalDevices, result 0 finds no
// device, and 5 (VK_INCOMPLETE) counts one device too many or lists one too few. For
// vkGetPhysicalDeviceSurfaceSupportKHR, result 0 says that the device cannot present on a surface.
// For vkGetQueryPoolResults, result 0 stops the clock: from this call on, all timestamps of a frame
// are equal.
//
// The layer supports one instance, one device and one thread at a time, as the engine uses them.
// Devices that the engine abandoned may go on running beside the current device.
#include "support/layer_link.hpp"

#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

namespace {

// clang-format off
// Calls that create an object, each with the call that destroys it.
#define FOR_CREATORS(X)                                                                            \
    X(AllocateMemory, FreeMemory)                                                                  \
    X(CreateBuffer, DestroyBuffer)                                                                 \
    X(CreateBufferView, DestroyBufferView)                                                         \
    X(CreateImage, DestroyImage)                                                                   \
    X(CreateImageView, DestroyImageView)                                                           \
    X(CreateSampler, DestroySampler)                                                               \
    X(CreateShaderModule, DestroyShaderModule)                                                     \
    X(CreateDescriptorSetLayout, DestroyDescriptorSetLayout)                                       \
    X(CreatePipelineLayout, DestroyPipelineLayout)                                                 \
    X(CreateGraphicsPipelines, DestroyPipeline)                                                    \
    X(CreateComputePipelines, DestroyPipeline)                                                     \
    X(CreateDescriptorPool, DestroyDescriptorPool)                                                 \
    X(CreateCommandPool, DestroyCommandPool)                                                       \
    X(CreateSemaphore, DestroySemaphore)                                                           \
    X(CreateFence, DestroyFence)                                                                   \
    X(CreateEvent, DestroyEvent)                                                                   \
    X(CreatePipelineCache, DestroyPipelineCache)                                                   \
    X(CreateQueryPool, DestroyQueryPool)
#define FOR_DESTROYERS(X)                                                                          \
    X(FreeMemory) X(DestroyBuffer) X(DestroyBufferView) X(DestroyImage) X(DestroyImageView)        \
    X(DestroySampler) X(DestroyShaderModule) X(DestroyDescriptorSetLayout)                         \
    X(DestroyPipelineLayout) X(DestroyPipeline) X(DestroyDescriptorPool)                           \
    X(DestroyCommandPool) X(DestroySemaphore) X(DestroyFence) X(DestroyEvent)                      \
    X(DestroyPipelineCache) X(DestroyQueryPool)
// Vulkan calls that may fail and that create no object. Descriptor sets and command buffers are
// destroyed with their pools.
#define FOR_CALLS(X)                                                                               \
    X(AllocateDescriptorSets) X(AllocateCommandBuffers) X(BindBufferMemory)                        \
    X(BindImageMemory) X(MapMemory) X(BeginCommandBuffer) X(EndCommandBuffer)                      \
    X(QueueSubmit2) X(WaitSemaphores) X(QueueWaitIdle) X(DeviceWaitIdle)                           \
    X(GetQueryPoolResults) X(QueuePresentKHR)
// Recorded commands that may follow a timestamp.
#define FOR_COMMANDS(X)                                                                            \
    X(CmdBeginRendering) X(CmdDispatch) X(CmdDispatchIndirect) X(CmdClearColorImage)               \
    X(CmdCopyBuffer) X(CmdCopyImage) X(CmdCopyImageToBuffer) X(CmdFillBuffer)                      \
    X(CmdPipelineBarrier2) X(CmdPipelineBarrier) X(CmdWriteTimestamp2)
// clang-format on

struct CallCounter {
    int calls = 0, alive = 0;
    PFN_vkVoidFunction next = nullptr; ///< the function of the next layer or the driver
};

struct LiveObject {
    CallCounter* maker = nullptr;
    std::uint64_t bytes = 0; ///< size of device memory; 0 for other objects
};

/// Identifies an object by the call that destroys it and its handle. The handle alone is not
/// enough, because handles of two types may be equal.
using Key = std::pair<std::string_view, std::uint64_t>;

/// All state of the layer for an instance. The report is written when the instance is destroyed.
/// After the fault the report is also written after every call, because a program may then end
/// without destroying the instance.
struct FaultLayerState {
    std::string fault_name;
    int fault_at = 0, fault_result = 0;
    bool failed = false;           ///< the Vulkan call that the test chose to fail has been made
    bool lost = false;             ///< the device has been reported lost, and stays so
    bool is_clock_stopped = false; ///< the timestamps of a frame are equal
    int strays = 0, untimely = 0;
    /// Whether the layer drops the kind of recorded command that the test chose as its fault,
    /// instead of passing the command to the driver.
    bool leaves_out = false;
    bool stamped = false; ///< the last recorded command is a timestamp
    int loose_stamps = 0;
    std::map<std::string, CallCounter, std::less<>> counters;
    std::uint64_t bytes = 0, most_bytes = 0; ///< device memory: now, and at most
    std::map<Key, LiveObject> alive;
    std::set<Key> in_use; ///< objects that devices, also abandoned ones, may still use

    PFN_vkGetInstanceProcAddr next_instance_proc = nullptr;
    PFN_vkGetDeviceProcAddr next_device_proc = nullptr;
} state;

/// Resets the state for a new instance. Objects that earlier instances abandoned stay in use.
void reset_layer_state() {
    const std::set<Key> in_use = std::move(state.in_use);
    state = FaultLayerState{.in_use = in_use};
    const char* text = std::getenv("CATOPTRIC_FAULT");
    if (!text) return;
    char name[64] = {};
    if (std::sscanf(text, "%63[^:]:%d:%d", name, &state.fault_at, &state.fault_result) != 3) {
        std::fprintf(stderr, "CATOPTRIC_FAULT: wanted NAME:CALL:RESULT, found '%s'\n", text);
        std::abort();
    }
    state.fault_name = name;
}

void write_layer_report() {
    const char* path = std::getenv("CATOPTRIC_FAULT_REPORT");
    std::FILE* file = path ? std::fopen(path, "w") : nullptr;
    if (!file) return;
    for (const auto& [name, counter] : state.counters)
        if (counter.calls > 0)
            std::fprintf(file, "%s %d %d\n", name.c_str(), counter.calls, counter.alive);
    std::fprintf(file, "strays %d\nuntimely %d\nloose_stamps %d\nmost_bytes %llu\n", state.strays,
                 state.untimely, state.loose_stamps,
                 static_cast<unsigned long long>(state.most_bytes));
    std::fclose(file);
}

CallCounter& find_call_counter(std::string_view name) {
    const auto found = state.counters.find(name);
    return found != state.counters.end() ? found->second : state.counters[std::string(name)];
}

template <typename Handle>
std::uint64_t handle_to_number(Handle handle) {
    std::uint64_t number = 0;
    std::memcpy(&number, &handle, sizeof handle);
    return number;
}

template <typename Handle>
void record_created_object(CallCounter& counter, std::string_view destroyer, Handle handle,
                           std::uint64_t bytes = 0) {
    if (handle == VK_NULL_HANDLE) return;
    ++counter.alive;
    state.alive[{destroyer, handle_to_number(handle)}] = {&counter, bytes};
    state.bytes += bytes;
    state.most_bytes = std::max(state.most_bytes, state.bytes);
}

template <typename Handle>
void record_destroyed_object(std::string_view destroyer, Handle handle) {
    if (handle == VK_NULL_HANDLE) return;
    const Key key{destroyer, handle_to_number(handle)};
    const auto found = state.alive.find(key);
    if (state.in_use.contains(key)) {
        ++state.untimely;
    } else if (found == state.alive.end()) {
        ++state.strays;
    } else {
        --found->second.maker->alive;
        state.bytes -= found->second.bytes;
        state.alive.erase(found);
    }
    if (state.failed) write_layer_report();
}

/// Counts a call. Returns whether this call must fail.
bool count_call_and_check_fault(std::string_view name) {
    const bool fault = ++find_call_counter(name).calls == state.fault_at &&
                       name == state.fault_name;
    state.failed |= fault;
    if (state.failed) write_layer_report();
    return fault;
}

bool is_waiting_call(std::string_view name) {
    return name == "vkWaitSemaphores" || name == "vkQueueWaitIdle" || name == "vkDeviceWaitIdle";
}

bool may_report_device_loss(std::string_view name) {
    return is_waiting_call(name) || name == "vkQueueSubmit2" || name == "vkGetQueryPoolResults";
}

/// Returns the result that a call must return instead of being passed on. VK_SUCCESS: pass it on.
VkResult find_forced_result(std::string_view name) {
    const bool fault = count_call_and_check_fault(name);
    if (!fault && !(state.lost && may_report_device_loss(name))) return VK_SUCCESS;
    const VkResult result = fault ? static_cast<VkResult>(state.fault_result)
                                  : VK_ERROR_DEVICE_LOST;
    state.is_clock_stopped |= result == VK_SUCCESS && name == "vkGetQueryPoolResults";
    if (result == VK_ERROR_DEVICE_LOST && may_report_device_loss(name)) state.lost = true;
    if (state.lost || is_waiting_call(name))
        for (const auto& [key, object] : state.alive) state.in_use.insert(key);
    return result;
}

/// Returns how many handles a creating call asks for. Only pipelines are created in arrays.
template <typename... Args>
std::uint32_t count_created_handles(const std::tuple<Args...>& args) {
    if constexpr (sizeof...(Args) == 6) return std::get<2>(args);
    return 1;
}

/// Returns how many bytes of device memory a call allocates; 0 for other calls.
template <typename... Args>
std::uint64_t allocated_bytes_of_call(const std::tuple<Args...>& args) {
    if constexpr (std::is_same_v<std::tuple_element_t<1, std::tuple<Args...>>,
                                 const VkMemoryAllocateInfo*>)
        return std::get<1>(args)->allocationSize;
    return 0;
}

/// Makes all timestamps that a call has read equal to the first one.
template <typename... Args>
void stop_clock(const std::tuple<Args...>& args) {
    auto* const stamps = static_cast<std::uint64_t*>(std::get<5>(args));
    if (std::get<6>(args) != sizeof *stamps) return; // other results, such as counts of work
    std::fill_n(stamps, std::get<4>(args) / sizeof *stamps, *stamps);
}

template <const auto& kName, typename Pfn>
struct Call;
template <const auto& kName, typename... Args>
struct Call<kName, VkResult(VKAPI_PTR*)(Args...)> {
    static VkResult hook(Args... args) {
        const auto next = reinterpret_cast<VkResult(VKAPI_PTR*)(Args...)>(
            find_call_counter(kName).next);
        const bool was_lost = state.lost;
        const VkResult result = find_forced_result(kName);
        if (result == VK_SUCCESS) {
            const VkResult passed_on = next(args...);
            if constexpr (kName == std::string_view("vkGetQueryPoolResults"))
                if (state.is_clock_stopped) stop_clock(std::tuple<Args...>(args...));
            return passed_on;
        }
        if (kName == std::string_view("vkQueueSubmit2") && state.lost && !was_lost) next(args...);
        return result;
    }
};

template <const auto& kName, const auto& kDestroyer, typename Pfn>
struct Creator;
template <const auto& kName, const auto& kDestroyer, typename... Args>
struct Creator<kName, kDestroyer, VkResult(VKAPI_PTR*)(Args...)> {
    static VkResult hook(Args... args) {
        const std::tuple<Args...> list(args...);
        const auto handles = std::get<sizeof...(Args) - 1>(list);
        const VkResult result = Call<kName, VkResult(VKAPI_PTR*)(Args...)>::hook(args...);
        for (std::uint32_t i = 0; result == VK_SUCCESS && i < count_created_handles(list); ++i)
            record_created_object(find_call_counter(kName), kDestroyer, handles[i],
                                  allocated_bytes_of_call(list));
        return result;
    }
};

template <const auto& kName, typename Pfn>
struct Command;
template <const auto& kName, typename... Args>
struct Command<kName, void(VKAPI_PTR*)(VkCommandBuffer, Args...)> {
    static void hook(VkCommandBuffer buffer, Args... args) {
        constexpr std::string_view kThis = kName;
        bool divides = false; // whether the barrier orders all later commands after all earlier
                              // commands
        if constexpr (kThis == "vkCmdPipelineBarrier") {
            const std::tuple<Args...> list(args...);
            divides = std::get<0>(list) == VK_PIPELINE_STAGE_ALL_COMMANDS_BIT &&
                      std::get<1>(list) == VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
        }
        state.loose_stamps += state.stamped && !divides;
        state.stamped = kThis == "vkCmdWriteTimestamp2";
        const bool is_first = count_call_and_check_fault(kName);
        state.leaves_out |= is_first;
        if (state.leaves_out && kThis == state.fault_name) return;
        reinterpret_cast<void(VKAPI_PTR*)(VkCommandBuffer, Args...)>(find_call_counter(kName).next)(
            buffer, args...);
    }
};

template <const auto& kName, typename Handle>
void hook_destroy_object(VkDevice device, Handle handle, const VkAllocationCallbacks* callbacks) {
    record_destroyed_object(kName, handle);
    using Destroy = void(VKAPI_PTR*)(VkDevice, Handle, const VkAllocationCallbacks*);
    reinterpret_cast<Destroy>(find_call_counter(kName).next)(device, handle, callbacks);
}
template <typename Pfn>
struct Destroyed;
template <typename Handle>
struct Destroyed<void(VKAPI_PTR*)(VkDevice, Handle, const VkAllocationCallbacks*)> {
    template <const auto& kName>
    static constexpr auto hook = &hook_destroy_object<kName, Handle>;
};

#define NAME(call, ...) constexpr char k##call[] = "vk" #call;
FOR_CREATORS(NAME)
FOR_DESTROYERS(NAME)
FOR_CALLS(NAME)
FOR_COMMANDS(NAME)
#undef NAME

struct FunctionHook {
    std::string_view name;
    PFN_vkVoidFunction function;
};

const FunctionHook kDeviceHooks[] = {
#define CREATOR(call, destroyer)                                                                   \
    {k##call,                                                                                      \
     reinterpret_cast<PFN_vkVoidFunction>(&Creator<k##call, k##destroyer, PFN_vk##call>::hook)},
#define DESTROYER(call)                                                                            \
    {k##call, reinterpret_cast<PFN_vkVoidFunction>(Destroyed<PFN_vk##call>::hook<k##call>)},
#define CALL(call)                                                                                 \
    {k##call, reinterpret_cast<PFN_vkVoidFunction>(&Call<k##call, PFN_vk##call>::hook)},
#define COMMAND(call)                                                                              \
    {k##call, reinterpret_cast<PFN_vkVoidFunction>(&Command<k##call, PFN_vk##call>::hook)},
    FOR_CREATORS(CREATOR) FOR_DESTROYERS(DESTROYER) FOR_CALLS(CALL) FOR_COMMANDS(COMMAND)
#undef COMMAND
#undef CREATOR
#undef DESTROYER
#undef CALL
};

VkResult hook_create_instance(const VkInstanceCreateInfo* create,
                              const VkAllocationCallbacks* callbacks, VkInstance* instance) {
    reset_layer_state();
    if (const VkResult result = find_forced_result("vkCreateInstance"); result != VK_SUCCESS)
        return result;
    auto* link = test::find_next_layer_link<VkLayerInstanceCreateInfo>(
        create, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
    if (!link) return VK_ERROR_INITIALIZATION_FAILED;
    state.next_instance_proc = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const auto next = reinterpret_cast<PFN_vkCreateInstance>(
        state.next_instance_proc(VK_NULL_HANDLE, "vkCreateInstance"));
    const VkResult result = next(create, callbacks, instance);
    if (result != VK_SUCCESS) return result;
    record_created_object(find_call_counter("vkCreateInstance"), "vkDestroyInstance", *instance);
    // Function addresses are taken now. Later the loader would return the first layer's functions
    // instead of those below this layer.
    for (const char* name : {"vkDestroyInstance", "vkEnumeratePhysicalDevices", "vkCreateDevice",
                             "vkGetPhysicalDeviceSurfaceSupportKHR"})
        find_call_counter(name).next = state.next_instance_proc(*instance, name);
    return result;
}

void hook_destroy_instance(VkInstance instance, const VkAllocationCallbacks* callbacks) {
    record_destroyed_object("vkDestroyInstance", instance);
    reinterpret_cast<PFN_vkDestroyInstance>(find_call_counter("vkDestroyInstance").next)(instance,
                                                                                         callbacks);
    write_layer_report();
}

VkResult hook_enumerate_devices(VkInstance instance, std::uint32_t* count,
                                VkPhysicalDevice* devices) {
    constexpr char kName[] = "vkEnumeratePhysicalDevices";
    const bool fault = count_call_and_check_fault(kName);
    if (fault && state.fault_result < 0) return static_cast<VkResult>(state.fault_result);
    if (fault && state.fault_result == VK_SUCCESS) {
        *count = 0;
        return VK_SUCCESS;
    }
    if (fault && devices && *count > 0) --*count;
    const auto next = reinterpret_cast<PFN_vkEnumeratePhysicalDevices>(
        find_call_counter(kName).next);
    const VkResult result = next(instance, count, devices);
    if (fault && !devices) ++*count;
    return result;
}

VkResult hook_surface_support(VkPhysicalDevice physical, std::uint32_t family, VkSurfaceKHR surface,
                              VkBool32* can) {
    constexpr char kName[] = "vkGetPhysicalDeviceSurfaceSupportKHR";
    const bool fault = count_call_and_check_fault(kName);
    if (fault && state.fault_result < 0) return static_cast<VkResult>(state.fault_result);
    const VkResult result = reinterpret_cast<PFN_vkGetPhysicalDeviceSurfaceSupportKHR>(
        find_call_counter(kName).next)(physical, family, surface, can);
    if (fault) *can = VK_FALSE;
    return result;
}

VkResult hook_create_device(VkPhysicalDevice physical, const VkDeviceCreateInfo* create,
                            const VkAllocationCallbacks* callbacks, VkDevice* device) {
    if (const VkResult result = find_forced_result("vkCreateDevice"); result != VK_SUCCESS)
        return result;
    auto* link = test::find_next_layer_link<VkLayerDeviceCreateInfo>(
        create, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
    if (!link) return VK_ERROR_INITIALIZATION_FAILED;
    state.next_device_proc = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const auto next = reinterpret_cast<PFN_vkCreateDevice>(
        find_call_counter("vkCreateDevice").next);
    const VkResult result = next(physical, create, callbacks, device);
    if (result != VK_SUCCESS) return result;
    record_created_object(find_call_counter("vkCreateDevice"), "vkDestroyDevice", *device);
    for (const FunctionHook& hook : kDeviceHooks)
        find_call_counter(hook.name).next = state.next_device_proc(*device, hook.name.data());
    return result;
}

void hook_destroy_device(VkDevice device, const VkAllocationCallbacks* callbacks) {
    record_destroyed_object("vkDestroyDevice", device);
    const auto next = state.next_device_proc(device, "vkDestroyDevice");
    reinterpret_cast<PFN_vkDestroyDevice>(next)(device, callbacks);
}

PFN_vkVoidFunction find_device_function(VkDevice device, const char* name) {
    if (!std::strcmp(name, "vkGetDeviceProcAddr"))
        return reinterpret_cast<PFN_vkVoidFunction>(find_device_function);
    if (!std::strcmp(name, "vkDestroyDevice"))
        return reinterpret_cast<PFN_vkVoidFunction>(hook_destroy_device);
    for (const FunctionHook& hook : kDeviceHooks)
        if (hook.name == name) return hook.function;
    return state.next_device_proc(device, name);
}

PFN_vkVoidFunction find_instance_function(VkInstance instance, const char* name) {
    const FunctionHook hooks[] = {
        {"vkGetInstanceProcAddr", reinterpret_cast<PFN_vkVoidFunction>(find_instance_function)},
        {"vkGetDeviceProcAddr", reinterpret_cast<PFN_vkVoidFunction>(find_device_function)},
        {"vkCreateInstance", reinterpret_cast<PFN_vkVoidFunction>(hook_create_instance)},
        {"vkDestroyInstance", reinterpret_cast<PFN_vkVoidFunction>(hook_destroy_instance)},
        {"vkCreateDevice", reinterpret_cast<PFN_vkVoidFunction>(hook_create_device)},
        {"vkDestroyDevice", reinterpret_cast<PFN_vkVoidFunction>(hook_destroy_device)},
        {"vkEnumeratePhysicalDevices",
         reinterpret_cast<PFN_vkVoidFunction>(hook_enumerate_devices)},
        {"vkGetPhysicalDeviceSurfaceSupportKHR",
         reinterpret_cast<PFN_vkVoidFunction>(hook_surface_support)}};
    for (const FunctionHook& hook : hooks)
        if (hook.name == name) return hook.function;
    for (const FunctionHook& hook : kDeviceHooks)
        if (hook.name == name) return hook.function;
    return state.next_instance_proc ? state.next_instance_proc(instance, name) : nullptr;
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
