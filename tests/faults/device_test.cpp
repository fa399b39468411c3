// Tests of failure R4 of docs/extremes.md: a driver is missing, cannot be loaded or has no device.
// The program exits with 69 within 2 s and names the package to install. Without memory for a
// driver the exit code is 75. tests/cli/input_test.cpp covers a missing driver for every verb.
#include "faults/faults.hpp"

#include <vulkan/vulkan_core.h>

namespace {

constexpr double kMaxSecondsWithoutDevice = 2; // most seconds that a program may take to end
constexpr int kNoForcedDeviceResult = VK_SUCCESS;

class NoDevice : public Faults {
protected:
    const Words words = {"render", "--technique", "reuse", "-o", "x.png"};
};

TEST_F(NoDevice, UnusableDriverFileExitsWith69) {
    write_input_file(
        "none.json",
        R"({"file_format_version": "1.0.0", "ICD": {"library_path": "/none/libnone.so", "api_version": "1.3.0"}})");
    write_input_file("garbage.json", "no JSON");
    for (const std::string name : {"missing.json", "none.json", "garbage.json", "."}) {
        test::ProcessStartOptions process = make_process_start(words);
        for (const char* variable : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"})
            process.environment[variable] = (folder / name).string();
        const test::ProcessResult ended = test::run_process(process);
        EXPECT_EQ(ended.exit_code, 69) << name << ": " << ended.err;
        EXPECT_THAT(ended.err, testing::HasSubstr("apt-get install mesa-vulkan-drivers")) << name;
        EXPECT_LT(ended.seconds, kMaxSecondsWithoutDevice) << name;
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "x.png"));
}

TEST_F(NoDevice, DriverThatRefusesExitsWith69) {
    for (const VulkanCallFault& fault :
         {VulkanCallFault{"vkCreateInstance", 1, VK_ERROR_INCOMPATIBLE_DRIVER},
          VulkanCallFault{"vkCreateInstance", 1, VK_ERROR_INITIALIZATION_FAILED},
          VulkanCallFault{"vkEnumeratePhysicalDevices", 1, VK_ERROR_INITIALIZATION_FAILED},
          VulkanCallFault{"vkEnumeratePhysicalDevices", 2, VK_ERROR_INITIALIZATION_FAILED},
          VulkanCallFault{"vkEnumeratePhysicalDevices", 1, kNoForcedDeviceResult},
          VulkanCallFault{"vkEnumeratePhysicalDevices", 2, kNoForcedDeviceResult}}) {
        const WatchedRun watched = run_with_fault_layer(words, fault);
        expect_exit_code(watched.ended, 69, {"apt-get install mesa-vulkan-drivers"});
        EXPECT_EQ(watched.describe_undestroyed_objects(), "");
        EXPECT_LT(watched.ended.seconds, kMaxSecondsWithoutDevice);
    }
}

TEST_F(NoDevice, DeviceThatCannotBeOpenedExitsWith69) {
    const WatchedRun watched = run_with_fault_layer(
        words, VulkanCallFault{"vkCreateDevice", 1, VK_ERROR_INITIALIZATION_FAILED});
    expect_exit_code(
        watched.ended, 69,
        {"no usable Vulkan device", "open device '", "VK_ERROR_INITIALIZATION_FAILED"});
    EXPECT_EQ(watched.describe_undestroyed_objects(), "");
}

/// A layer, extension or feature that the driver lacks is no internal error, so the exit code is
/// 69.
TEST_F(NoDevice, MissingLayerExtensionOrFeatureExitsWith69) {
    for (const auto& [call, result, name] :
         {std::tuple{"vkCreateInstance", VK_ERROR_EXTENSION_NOT_PRESENT, "EXTENSION_NOT_PRESENT"},
          std::tuple{"vkCreateInstance", VK_ERROR_LAYER_NOT_PRESENT, "LAYER_NOT_PRESENT"},
          std::tuple{"vkCreateDevice", VK_ERROR_FEATURE_NOT_PRESENT, "FEATURE_NOT_PRESENT"},
          std::tuple{"vkCreateDevice", VK_ERROR_EXTENSION_NOT_PRESENT, "EXTENSION_NOT_PRESENT"},
          std::tuple{"vkCreateImage", VK_ERROR_FORMAT_NOT_SUPPORTED, "FORMAT_NOT_SUPPORTED"}}) {
        const WatchedRun watched = run_with_fault_layer(words, VulkanCallFault{call, 1, result});
        expect_exit_code(watched.ended, 69, {"Vulkan: cannot ", name});
        EXPECT_EQ(watched.describe_undestroyed_objects(), "");
    }
    test::ProcessStartOptions process = make_process_start(
        {"render", "--technique", "reuse", "-o", "x.png", "--validate"});
    // The path is a folder without layers.
    process.environment = {{"VK_LAYER_PATH", folder.string()}};
    expect_exit_code(test::run_process(process), 69,
                     {"--validate needs the layer", "apt-get install vulkan-validationlayers"});
}

/// The number of devices changes between counting and listing. The program goes on with the devices
/// that are listed.
TEST_F(NoDevice, ChangedNumberOfDevicesIsTolerated) {
    for (const int at : {1, 2}) {
        const WatchedRun watched = run_with_fault_layer(
            {"list", "devices"}, VulkanCallFault{"vkEnumeratePhysicalDevices", at, VK_INCOMPLETE});
        EXPECT_EQ(watched.ended.exit_code, 0) << watched.ended.err;
        EXPECT_EQ(watched.ended.out, run_cli({"list", "devices"}).out);
        EXPECT_EQ(watched.describe_undestroyed_objects(), "");
    }
}

/// If memory ends before a device is open, the error names memory and not a missing driver.
TEST_F(NoDevice, DriverWithoutMemoryExitsWith75) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "the sanitizer itself takes address space without end";
#endif
    test::ProcessStartOptions process = make_process_start(words);
    process.memory_limit = 200 << 20; // bytes; the program itself takes 40 MiB
    expect_exit_code(test::run_process(process), 75,
                     {"no memory for a Vulkan driver", "ulimit -v"});
}

} // namespace
