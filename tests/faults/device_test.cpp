// R4: drivers that are not there, cannot be loaded or have no device: exit code 69 with what to
// install, within 2 s. (tests/cli/input_test.cpp asks every verb.) No memory for one is 75.
#include "faults/faults.hpp"

#include <vulkan/vulkan_core.h>

namespace {

constexpr double kLongest = 2; // seconds
constexpr int kFindsNone = VK_SUCCESS;

class NoDevice : public Faults {
protected:
    const Words words = {"render", "--technique", "reuse", "-o", "x.png"};
};

TEST_F(NoDevice, WhereverTheDriverFilesPoint) {
    write(
        "none.json",
        R"({"file_format_version": "1.0.0", "ICD": {"library_path": "/none/libnone.so", "api_version": "1.3.0"}})");
    write("garbage.json", "no JSON");
    for (const std::string name : {"missing.json", "none.json", "garbage.json", "."}) {
        test::Start process = start(words);
        for (const char* variable : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"})
            process.environment[variable] = (folder / name).string();
        const test::Ended ended = test::run_process(process);
        EXPECT_EQ(ended.exit_code, 69) << name << ": " << ended.err;
        EXPECT_THAT(ended.err, testing::HasSubstr("apt-get install mesa-vulkan-drivers")) << name;
        EXPECT_LT(ended.seconds, kLongest) << name;
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "x.png"));
}

TEST_F(NoDevice, WhereTheDriverRefuses) {
    for (const Fault& fault :
         {Fault{"vkCreateInstance", 1, VK_ERROR_INCOMPATIBLE_DRIVER},
          Fault{"vkCreateInstance", 1, VK_ERROR_INITIALIZATION_FAILED},
          Fault{"vkEnumeratePhysicalDevices", 1, VK_ERROR_INITIALIZATION_FAILED},
          Fault{"vkEnumeratePhysicalDevices", 2, VK_ERROR_INITIALIZATION_FAILED},
          Fault{"vkEnumeratePhysicalDevices", 1, kFindsNone},
          Fault{"vkEnumeratePhysicalDevices", 2, kFindsNone}}) {
        const Watched watched = watch(words, fault);
        expect_ended(watched.ended, 69, {"apt-get install mesa-vulkan-drivers"});
        EXPECT_EQ(watched.leaks(), "");
        EXPECT_LT(watched.ended.seconds, kLongest);
    }
}

TEST_F(NoDevice, WhereItCannotBeOpened) {
    const Watched watched = watch(words,
                                  Fault{"vkCreateDevice", 1, VK_ERROR_INITIALIZATION_FAILED});
    expect_ended(watched.ended, 69,
                 {"no usable Vulkan device", "open device '", "VK_ERROR_INITIALIZATION_FAILED"});
    EXPECT_EQ(watched.leaks(), "");
}

/// What the driver says is not there is no fault of the program's.
TEST_F(NoDevice, WhereALayerExtensionOrFeatureIsMissing) {
    for (const auto& [call, result, name] :
         {std::tuple{"vkCreateInstance", VK_ERROR_EXTENSION_NOT_PRESENT, "EXTENSION_NOT_PRESENT"},
          std::tuple{"vkCreateInstance", VK_ERROR_LAYER_NOT_PRESENT, "LAYER_NOT_PRESENT"},
          std::tuple{"vkCreateDevice", VK_ERROR_FEATURE_NOT_PRESENT, "FEATURE_NOT_PRESENT"},
          std::tuple{"vkCreateDevice", VK_ERROR_EXTENSION_NOT_PRESENT, "EXTENSION_NOT_PRESENT"},
          std::tuple{"vkCreateImage", VK_ERROR_FORMAT_NOT_SUPPORTED, "FORMAT_NOT_SUPPORTED"}}) {
        const Watched watched = watch(words, Fault{call, 1, result});
        expect_ended(watched.ended, 69, {"Vulkan: cannot ", name});
        EXPECT_EQ(watched.leaks(), "");
    }
    test::Start process = start({"render", "--technique", "reuse", "-o", "x.png", "--validate"});
    process.environment = {{"VK_LAYER_PATH", folder.string()}}; // which holds no layer
    expect_ended(test::run_process(process), 69,
                 {"--validate needs the layer", "apt-get install vulkan-validationlayers"});
}

/// One came or went between counting and fetching: what there is will do.
TEST_F(NoDevice, DevicesThatComeAndGo) {
    for (const int at : {1, 2}) {
        const Watched watched = watch({"list", "devices"},
                                      Fault{"vkEnumeratePhysicalDevices", at, VK_INCOMPLETE});
        EXPECT_EQ(watched.ended.exit_code, 0) << watched.ended.err;
        EXPECT_EQ(watched.ended.out, cli({"list", "devices"}).out);
        EXPECT_EQ(watched.leaks(), "");
    }
}

/// Out of memory before there is a device is not "no driver".
TEST_F(NoDevice, NoMemoryForADriver) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "the sanitizer itself takes address space without end";
#endif
    test::Start process = start(words);
    process.memory_limit = 200 << 20; // of which the program takes 40
    expect_ended(test::run_process(process), 75, {"no memory for a Vulkan driver", "ulimit -v"});
}

} // namespace
