#include "gpu/instance.hpp"

#include "core/address_space.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string_view>
#include <thread>

namespace catoptric::gpu {

namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";
constexpr const char* kNoDriver =
    "no Vulkan device: no driver is installed; install one for the graphics card, or the software "
    "driver: apt-get install mesa-vulkan-drivers";

/// Bytes of address space for a software driver and its compiler. With less, drivers crash, or the
/// loader says that it could not map a driver's file.
constexpr std::size_t kDriverAddressSpace = std::size_t{256} << 20;

/// Returns the list that `call(count, items)` gives. The list is counted, then fetched, and both
/// are repeated if it grew in between. Items that vanished in between are left out. Calls `failed`
/// with a result that is an error.
template <typename Item, typename Call, typename Failed>
std::vector<Item> enumerate(Call&& call, Failed&& failed) {
    constexpr int kMaxEnumerationAttempts = 8; // after the last try the fetched items are returned
    std::vector<Item> items;
    VkResult result = VK_INCOMPLETE;
    for (int i = 0; i < kMaxEnumerationAttempts && result == VK_INCOMPLETE; ++i) {
        std::uint32_t count = 0;
        if (result = call(&count, nullptr); result < 0) failed(result);
        items.resize(count);
        if (items.empty()) break; // a second call with a null pointer would count again
        if (result = call(&count, items.data()); result < 0) failed(result);
        items.resize(count);
    }
    return items;
}

bool has_layer(const char* name) {
    const auto layers = enumerate<VkLayerProperties>(
        vkEnumerateInstanceLayerProperties,
        [](VkResult result) { check_vk(result, "enumerate layers"); });
    return std::ranges::any_of(layers, [&](const auto& l) { return !strcmp(l.layerName, name); });
}

bool has_extension(const char* layer, const char* name) {
    const auto list = enumerate<VkExtensionProperties>(
        [&](std::uint32_t* count, VkExtensionProperties* items) {
            return vkEnumerateInstanceExtensionProperties(layer, count, items);
        },
        [](VkResult result) {
            // The loader returns VK_ERROR_OUT_OF_HOST_MEMORY for a missing file.
            fail(Failure::no_device, kNoDriver,
                 " (the Vulkan loader cannot read its driver files: ", vk_result_name(result),
                 "; is VK_DRIVER_FILES or VK_ICD_FILENAMES set?)");
        });
    return std::ranges::any_of(list, [&](const auto& e) { return !strcmp(e.extensionName, name); });
}

int type_rank(VkPhysicalDeviceType type) {
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU: return 0;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU: return 1;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU: return 2;
    case VK_PHYSICAL_DEVICE_TYPE_CPU: return 3;
    default: return 4;
    }
}

/// Returns the problem, if any, of Mesa 22's software driver with the vector width set in the
/// environment. For widths other than 128 and 256 bits it compiles code that crashes (tested from 0
/// to 1024 bits).
std::string vector_width_problem(const VkPhysicalDeviceDriverProperties& driver) {
    const std::optional<long> asked = llvmpipe_vector_width();
    const bool is_sound = !asked || *asked == 128 || *asked == 256;
    if (is_sound || driver.driverID != VK_DRIVER_ID_MESA_LLVMPIPE ||
        std::string_view(driver.driverInfo).find("Mesa 22.") == std::string_view::npos)
        return "";
    return "sound code for vectors of " + std::to_string(*asked) +
           " bits (LP_NATIVE_VECTOR_WIDTH: wanted 128, 256 or none, found " +
           std::getenv("LP_NATIVE_VECTOR_WIDTH") + ")";
}

std::string device_id(const VkPhysicalDeviceProperties& properties) {
    char text[32];
    std::snprintf(text, sizeof text, "%04x-%04x", properties.vendorID, properties.deviceID);
    return text;
}

std::string format_version(std::uint32_t v) {
    return std::to_string(VK_API_VERSION_MAJOR(v)) + "." + std::to_string(VK_API_VERSION_MINOR(v)) +
           "." + std::to_string(VK_API_VERSION_PATCH(v));
}

int cpu_threads() {
    int threads = static_cast<int>(std::thread::hardware_concurrency());
    if (const char* limit = std::getenv("LP_NUM_THREADS"))
        threads = std::min(threads, std::max(1, std::atoi(limit)));
    return threads;
}

/// Returns whether images of this format with optimal tiling have these features.
bool format_allows(VkPhysicalDevice device, VkFormat format, VkFormatFeatureFlags features) {
    VkFormatProperties properties;
    vkGetPhysicalDeviceFormatProperties(device, format, &properties);
    return (properties.optimalTilingFeatures & features) == features;
}

bool has_subgroup_operations(VkPhysicalDevice device, VkShaderStageFlagBits stage,
                             VkSubgroupFeatureFlags wanted) {
    VkPhysicalDeviceSubgroupProperties subgroups{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                           &subgroups};
    vkGetPhysicalDeviceProperties2(device, &properties);
    return (subgroups.supportedStages & stage) != 0 &&
           (subgroups.supportedOperations & wanted) == wanted;
}

std::uint32_t max_invocations(VkPhysicalDevice device) {
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(device, &properties);
    return std::min(properties.limits.maxComputeWorkGroupInvocations,
                    properties.limits.maxComputeWorkGroupSize[0]);
}

} // namespace

std::optional<long> llvmpipe_vector_width() {
    const char* const text = std::getenv("LP_NATIVE_VECTOR_WIDTH");
    if (text == nullptr) return std::nullopt;
    char* end = nullptr;
    const long bits = std::strtol(text, &end, 0); // parsed as the driver does
    return end == text ? std::nullopt : std::optional(bits);
}

void check_vk_started(VkResult result, const std::string& doing, const char* or_else) {
    const bool begun = result != VK_ERROR_INITIALIZATION_FAILED &&
                       result != VK_ERROR_INCOMPATIBLE_DRIVER;
    check(begun, Failure::no_device, or_else, " (cannot ", doing, ": ", vk_result_name(result),
          ")");
    check_vk(result, doing);
}

VkInstance make_instance(bool validate, const std::vector<std::string>& wanted_extensions,
                         bool& has_debug_utils) {
    // Mesa's device-select layer sorts devices and crashes if one vanishes between two of its
    // calls. It is needed only if the user selects a device by its variables, because devices are
    // sorted here.
    if (!std::getenv("MESA_VK_DEVICE_SELECT") && !std::getenv("DRI_PRIME"))
        setenv("NODEVICE_SELECT", "1", 0);
    check_address_space(kDriverAddressSpace, "a Vulkan driver");
    std::vector<const char*> layers, extensions;
    if (validate) {
        check(has_layer(kValidationLayer), Failure::no_device, "--validate needs the layer ",
              kValidationLayer, ": apt-get install vulkan-validationlayers");
        layers.push_back(kValidationLayer);
        // The validation layer of Vulkan 1.3 reads this setting only from the environment.
        setenv("VK_LAYER_ENABLES",
               "VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT:"
               "VALIDATION_CHECK_ENABLE_SYNCHRONIZATION_VALIDATION_QUEUE_SUBMIT",
               0);
    }
    has_debug_utils = has_extension(nullptr, VK_EXT_DEBUG_UTILS_EXTENSION_NAME) ||
                      (validate &&
                       has_extension(kValidationLayer, VK_EXT_DEBUG_UTILS_EXTENSION_NAME));
    if (has_debug_utils) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);

    for (const std::string& name : wanted_extensions) extensions.push_back(name.c_str());

    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.pApplicationName = application.pEngineName = "catoptric";
    application.apiVersion = VK_API_VERSION_1_3;
    VkInstanceCreateInfo create{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    create.pApplicationInfo = &application;
    create.enabledLayerCount = static_cast<std::uint32_t>(layers.size());
    create.ppEnabledLayerNames = layers.data();
    create.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
    create.ppEnabledExtensionNames = extensions.data();
    VkInstance instance = VK_NULL_HANDLE;
    check_vk_started(vkCreateInstance(&create, nullptr, &instance), "create an instance",
                     kNoDriver);
    return instance;
}

std::vector<VkPhysicalDevice> physical_devices(VkInstance instance) {
    auto devices = enumerate<VkPhysicalDevice>(
        [&](std::uint32_t* count, VkPhysicalDevice* items) {
            return vkEnumeratePhysicalDevices(instance, count, items);
        },
        [](VkResult result) { check_vk_started(result, "enumerate devices", kNoDriver); });
    check(!devices.empty(), Failure::no_device, kNoDriver);
    std::ranges::stable_sort(devices, {}, [](VkPhysicalDevice device) {
        VkPhysicalDeviceProperties properties;
        vkGetPhysicalDeviceProperties(device, &properties);
        return type_rank(properties.deviceType);
    });
    return devices;
}

DeviceProperties describe_device(VkPhysicalDevice device) {
    VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &driver};
    vkGetPhysicalDeviceProperties2(device, &properties);
    constexpr std::array kDeviceTypeNames{"discrete", "integrated", "virtual", "cpu", "other"};
    DeviceProperties info;
    info.name = properties.properties.deviceName;
    info.driver = std::string(driver.driverName) + " " + driver.driverInfo;
    info.id = device_id(properties.properties);
    info.api = format_version(properties.properties.apiVersion);
    info.type =
        kDeviceTypeNames[static_cast<std::size_t>(type_rank(properties.properties.deviceType))];
    if (info.type == "cpu") info.threads = cpu_threads();
    info.missing = properties.properties.apiVersion < VK_API_VERSION_1_3
                       ? "Vulkan 1.3 (has " + info.api + ")"
                       : DeviceFeatures::missing_features(device);
    if (info.missing.empty()) info.missing = vector_width_problem(driver);
    if (info.missing.empty() && find_queue_family(device) < 0)
        info.missing = "a queue for graphics and compute with timestamps";
    return info;
}

int find_queue_family(VkPhysicalDevice device) {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    constexpr VkQueueFlags kRequiredQueueFlags = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    for (std::uint32_t i = 0; i < count; ++i)
        if ((families[i].queueFlags & kRequiredQueueFlags) == kRequiredQueueFlags &&
            families[i].timestampValidBits > 0)
            return static_cast<int>(i);
    return -1;
}

bool can_present(VkPhysicalDevice device, VkSurfaceKHR surface) {
    const auto extensions = enumerate<VkExtensionProperties>(
        [&](std::uint32_t* count, VkExtensionProperties* items) {
            return vkEnumerateDeviceExtensionProperties(device, nullptr, count, items);
        },
        [](VkResult result) { check_vk(result, "enumerate a device's extensions"); });
    const auto is_swapchain = [](const VkExtensionProperties& extension) {
        return !strcmp(extension.extensionName, VK_KHR_SWAPCHAIN_EXTENSION_NAME);
    };
    VkBool32 can = VK_FALSE;
    const auto family = static_cast<std::uint32_t>(find_queue_family(device));
    check_vk(vkGetPhysicalDeviceSurfaceSupportKHR(device, family, surface, &can),
             "ask whether a device can show pictures in a window");
    return can && std::ranges::any_of(extensions, is_swapchain);
}

void DeviceFeatures::enable(VkPhysicalDevice device) {
    DeviceFeatures has;
    vkGetPhysicalDeviceFeatures2(device, &has.core);
    core.features.imageCubeArray = true;
    core.features.fragmentStoresAndAtomics = true;
    core.features.shaderClipDistance = true;
    core.features.shaderFloat64 = has.core.features.shaderFloat64;
    core.features.independentBlend = has.core.features.independentBlend;
    core.features.pipelineStatisticsQuery = has.core.features.pipelineStatisticsQuery;
    core.features.geometryShader = has.core.features.geometryShader; // for gl_PrimitiveID
    v12.scalarBlockLayout = true;
    v12.timelineSemaphore = true;
    v12.hostQueryReset = true;
    v12.shaderOutputLayer = has.v12.shaderOutputLayer;
    v13.dynamicRendering = true;
    v13.synchronization2 = true;
    v13.shaderTerminateInvocation = true; // `discard` compiles to it in SPIR-V for Vulkan 1.3
    v13.maintenance4 = true;              // glslang needs it for work-group sizes with Vulkan 1.3
}

DeviceFeatures::DeviceFeatures() {
    core.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    v11.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES;
    v12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    v13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
    core.pNext = &v11, v11.pNext = &v12, v12.pNext = &v13;
}

bool DeviceFeatures::filters_floats(VkPhysicalDevice device) {
    constexpr VkFormatFeatureFlags kLinearFilterFeature =
        VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
    return format_allows(device, VK_FORMAT_R32_SFLOAT, kLinearFilterFeature) &&
           format_allows(device, VK_FORMAT_R32G32B32A32_SFLOAT, kLinearFilterFeature);
}

bool DeviceFeatures::has_fragment_subgroups(VkPhysicalDevice device) {
    return has_subgroup_operations(device, VK_SHADER_STAGE_FRAGMENT_BIT,
                                   VK_SUBGROUP_FEATURE_BASIC_BIT);
}

bool DeviceFeatures::blends_floats(VkPhysicalDevice device) {
    constexpr VkFormatFeatureFlags kBlendFeature = VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT;
    return format_allows(device, VK_FORMAT_R32G32B32A32_SFLOAT, kBlendFeature) &&
           format_allows(device, VK_FORMAT_R16G16B16A16_SFLOAT, kBlendFeature);
}

std::string DeviceFeatures::missing_features(VkPhysicalDevice device) {
    DeviceFeatures has;
    vkGetPhysicalDeviceFeatures2(device, &has.core);
    const std::pair<const char*, VkBool32> required[] = {
        {"imageCubeArray", has.core.features.imageCubeArray},
        {"fragmentStoresAndAtomics", has.core.features.fragmentStoresAndAtomics},
        {"shaderClipDistance", has.core.features.shaderClipDistance},
        {"scalarBlockLayout", has.v12.scalarBlockLayout},
        {"timelineSemaphore", has.v12.timelineSemaphore},
        {"hostQueryReset", has.v12.hostQueryReset},
        {"dynamicRendering", has.v13.dynamicRendering},
        {"synchronization2", has.v13.synchronization2},
        {"maintenance4", has.v13.maintenance4},
        {"shaderTerminateInvocation", has.v13.shaderTerminateInvocation},
        {"subgroup arithmetic in compute shaders",
         has_subgroup_operations(device, VK_SHADER_STAGE_COMPUTE_BIT,
                                 VK_SUBGROUP_FEATURE_ARITHMETIC_BIT)},
        {"subgroup ballots in compute shaders",
         has_subgroup_operations(device, VK_SHADER_STAGE_COMPUTE_BIT,
                                 VK_SUBGROUP_FEATURE_BALLOT_BIT)},
        {"work groups of 256", max_invocations(device) >= 256},
    };
    std::string names;
    for (const auto& [name, there] : required)
        if (!there) names += (names.empty() ? "" : ", ") + std::string(name);
    return names;
}

} // namespace catoptric::gpu
