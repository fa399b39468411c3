// R4: drivers that are not there, cannot be loaded or have no device: exit code 69 with what to
// install, within 2 s. (tests/cli/input_test.cpp asks every verb.)
#include "faults/faults.hpp"

#include <vulkan/vulkan_core.h>

namespace {

constexpr double kLongest = 2; // seconds

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
          Fault{"vkEnumeratePhysicalDevices", 1, VK_ERROR_INITIALIZATION_FAILED}}) {
        const Watched watched = watch(words, fault);
        expect_ended(watched.ended, 69, {"apt-get install mesa-vulkan-drivers"});
        EXPECT_EQ(watched.leaks(), "");
        EXPECT_LT(watched.ended.seconds, kLongest);
    }
}

} // namespace
