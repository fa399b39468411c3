// Tests of the choice of a device by index or name.
#include "gpu/device.hpp"
#include "gpu/vulkan.hpp"
#include "support/device.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cctype>

namespace {

using namespace catoptric;

TEST(Device, UnknownIndexIsRefusedWithTheNumberOfDevices) {
    const std::size_t count = gpu::list_devices().size();
    for (const std::string wanted : {"99", std::to_string(count).c_str()})
        test::expect_error(
            [&] { gpu::Device device({.wanted = wanted}); }, Failure::usage,
            {"no device '" + wanted + "'", "there are " + std::to_string(count), "counted from 0"});
}

TEST(Device, UnknownNameIsRefusedWithTheNearestName) {
    std::string name = gpu::list_devices().front().name;
    name.front() = '?';
    test::expect_error(
        [&] { gpu::Device device({.wanted = name}); }, Failure::usage,
        {"no device '" + name + "'", "did you mean '" + gpu::list_devices().front().name + "'"});
}

TEST(Device, DeviceIsChosenByIndexOrPartOfItsName) {
    const gpu::DeviceProperties first = gpu::list_devices().front();
    EXPECT_EQ(gpu::Device({.wanted = "0"}).info().name, first.name);
    EXPECT_EQ(gpu::Device({.wanted = first.name.substr(0, 4)}).info().name, first.name);
    std::string capitals = first.name;
    std::ranges::transform(capitals, capitals.begin(), ::toupper);
    EXPECT_EQ(gpu::Device({.wanted = capitals}).info().name, first.name);
}

TEST(Device, ListNamesDriverVersionAndThreads) {
    for (const gpu::DeviceProperties& info : gpu::list_devices()) {
        EXPECT_FALSE(info.name.empty());
        EXPECT_FALSE(info.driver.empty());
        EXPECT_EQ(info.api.substr(0, 2), "1.");
        EXPECT_EQ(info.threads > 0, info.type == "cpu");
    }
}

TEST(Device, ResultsOfVulkanAreNamedAsVulkanNamesThem) {
#define EXPECT_OWN_NAME(result) EXPECT_STREQ(gpu::vk_result_name(result), #result)
    EXPECT_OWN_NAME(VK_SUCCESS);
    EXPECT_OWN_NAME(VK_TIMEOUT);
    EXPECT_OWN_NAME(VK_NOT_READY);
    EXPECT_OWN_NAME(VK_ERROR_OUT_OF_HOST_MEMORY);
    EXPECT_OWN_NAME(VK_ERROR_OUT_OF_DEVICE_MEMORY);
    EXPECT_OWN_NAME(VK_ERROR_OUT_OF_POOL_MEMORY);
    EXPECT_OWN_NAME(VK_ERROR_FRAGMENTED_POOL);
    EXPECT_OWN_NAME(VK_ERROR_FRAGMENTATION);
    EXPECT_OWN_NAME(VK_ERROR_TOO_MANY_OBJECTS);
    EXPECT_OWN_NAME(VK_ERROR_INITIALIZATION_FAILED);
    EXPECT_OWN_NAME(VK_ERROR_DEVICE_LOST);
    EXPECT_OWN_NAME(VK_ERROR_MEMORY_MAP_FAILED);
    EXPECT_OWN_NAME(VK_ERROR_LAYER_NOT_PRESENT);
    EXPECT_OWN_NAME(VK_ERROR_EXTENSION_NOT_PRESENT);
    EXPECT_OWN_NAME(VK_ERROR_FEATURE_NOT_PRESENT);
    EXPECT_OWN_NAME(VK_ERROR_INCOMPATIBLE_DRIVER);
    EXPECT_OWN_NAME(VK_ERROR_FORMAT_NOT_SUPPORTED);
    EXPECT_OWN_NAME(VK_ERROR_SURFACE_LOST_KHR);
    EXPECT_OWN_NAME(VK_ERROR_NATIVE_WINDOW_IN_USE_KHR);
    EXPECT_OWN_NAME(VK_ERROR_OUT_OF_DATE_KHR);
    EXPECT_OWN_NAME(VK_SUBOPTIMAL_KHR);
#undef EXPECT_OWN_NAME
    EXPECT_STREQ(gpu::vk_result_name(static_cast<VkResult>(-123456)), "an unnamed VkResult");
}

TEST(Device, MessagesOfTheValidationLayerAreErrors) {
    gpu::Device device({.validate = true});
    device.check_validation();
    VkFenceCreateInfo create{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    create.flags = 0x40; // no flag of a fence
    VkFence fence = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateFence(device.handle(), &create, nullptr, &fence), VK_SUCCESS);
    vkDestroyFence(device.handle(), fence, nullptr);
    ASSERT_EQ(device.validation_messages().size(), 1u);
    EXPECT_THAT(device.validation_messages().front(),
                testing::HasSubstr("VUID-VkFenceCreateInfo-flags-parameter"));
    test::expect_error([&] { device.check_validation(); }, Failure::internal,
                       {"the validation layer has 1 message(s), the first: ",
                        device.validation_messages().front()});
}

TEST(Device, LayeredRenderingCanBeSwitchedOff) {
    EXPECT_FALSE(gpu::Device({.layered = false}).supports_layers());
}

TEST(Device, GraphLargerThanDeviceMemoryIsRefusedWithBothSizes) {
    auto& [device, pipelines] = test::get_test_device();
    graph::GraphRunner runner(device, pipelines);
    graph::Graph graph;
    // All images of 1 GiB together need more memory than the device has.
    const std::uint64_t count = device.largest_heap_bytes() / (std::uint64_t{1} << 30) + 1;
    for (std::uint64_t i = 0; i < count; ++i) {
        const graph::ImageHandle image = graph.add_image(
            {"huge" + std::to_string(i), TexelFormat::rgba32f, 8192, 8192});
        graph.add_pass("fill" + std::to_string(i))
            .writes(image, graph::ResourceUse::colour, graph::ClearValue{})
            .record([](graph::PassCommands&) {});
        graph.output(image);
    }
    test::expect_error([&] { test::run_graph(runner, graph); }, Failure::exhausted,
                       {std::to_string(count << 30), std::to_string(device.largest_heap_bytes())});
}

} // namespace
