// R2: the device is lost: exit code 76, the passes or the copy that it was lost in, within 5 s; and
// R3: what was rendered cannot be read back: a message and no picture.
#include "faults/faults.hpp"

#include <vulkan/vulkan_core.h>

#include <set>

namespace {

constexpr double kLongest = 5; // seconds

class DeviceLost : public Faults {
protected:
    const Words words = {"render", "--technique", "hybrid:face=16,shadow_map=16",
                         "--size", "64x64",       "--frames",
                         "2",      "--warmup",    "1",
                         "-o",     "x.exr"};

    void SetUp() override {
        Faults::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        write("x.exr", "old");
    }
    void expect_lost(const Fault& fault, const Words& any_of) const {
        const Watched watched = watch(words, fault);
        const std::string where = fault.call + " " + std::to_string(fault.at) + ": " +
                                  watched.ended.err;
        expect_ended(watched.ended, 76, {"VK_ERROR_DEVICE_LOST"});
        EXPECT_TRUE(std::ranges::any_of(any_of, [&](const std::string& part) {
            return watched.ended.err.find(part) != std::string::npos;
        })) << where;
        EXPECT_LT(watched.ended.seconds, kLongest) << where;
        EXPECT_EQ(watched.leaks(), "") << where;
        EXPECT_EQ(read("x.exr"), "old") << where;
        std::printf("  %s in %.2f s: %s", fault.call.c_str(), watched.ended.seconds,
                    watched.ended.err.c_str());
    }
    int calls(const std::string& call) const {
        const Watched whole = watch(words, std::nullopt);
        EXPECT_EQ(whole.ended.exit_code, 0) << whole.ended.err;
        write("x.exr", "old");
        return whole.counts.at(call).calls;
    }
};

TEST_F(DeviceLost, AtTheFirstAMiddleAndTheLastSubmit) {
    const int last = calls("vkQueueSubmit2");
    ASSERT_GE(last, 3);
    for (const int at : std::set{1, 2, last / 2, last - 1, last})
        expect_lost({"vkQueueSubmit2", at, VK_ERROR_DEVICE_LOST},
                    {"'view'", "read back image '", "clear image '"});
}

TEST_F(DeviceLost, WhileAFrameOrACopyIsAwaited) {
    for (const char* call : {"vkWaitSemaphores", "vkQueueWaitIdle", "vkGetQueryPoolResults"}) {
        const int last = calls(call);
        for (const int at : std::set{1, last})
            expect_lost({call, at, VK_ERROR_DEVICE_LOST},
                        {"'view'", "read back image '", "clear image '"});
    }
}

TEST_F(DeviceLost, WhileItIsOpened) {
    const Watched watched = watch(words, Fault{"vkCreateDevice", 1, VK_ERROR_DEVICE_LOST});
    expect_ended(watched.ended, 76, {"open device '", "VK_ERROR_DEVICE_LOST"});
    EXPECT_EQ(watched.leaks(), "");
}

TEST_F(DeviceLost, InAComparisonLeavesTheOldReport) {
    std::filesystem::create_directory(folder / "out");
    write("out/report.json", "old");
    const Words compare = {"compare",
                           "-o",
                           "out",
                           "--size",
                           "32x32",
                           "--frames",
                           "1",
                           "--warmup",
                           "1",
                           "--techniques",
                           "parallax:face=16,shadow_map=16"};
    const Watched watched = watch(compare, Fault{"vkWaitSemaphores", 6, VK_ERROR_DEVICE_LOST});
    expect_ended(watched.ended, 76, {"VK_ERROR_DEVICE_LOST", "passes '"});
    EXPECT_EQ(watched.leaks(), "");
    EXPECT_EQ(read("out/report.json"), "old");
    EXPECT_FALSE(std::filesystem::exists(folder / "out/images"));
}

class ReadBack : public DeviceLost {};

TEST_F(ReadBack, MemoryThatCannotBeMapped) {
    const int last = calls("vkMapMemory");
    for (const int at : std::set{1, last / 2, last}) {
        const Watched watched = watch(words, Fault{"vkMapMemory", at, VK_ERROR_MEMORY_MAP_FAILED});
        expect_ended(watched.ended, 75, {"map buffer '", "VK_ERROR_MEMORY_MAP_FAILED"});
        EXPECT_EQ(watched.leaks(), "");
        EXPECT_EQ(read("x.exr"), "old");
    }
    const Watched end = watch(words, Fault{"vkMapMemory", last, VK_ERROR_MEMORY_MAP_FAILED});
    EXPECT_THAT(end.ended.err, testing::HasSubstr("read-back of "));
}

/// A result that the standard does not name is a defect of the driver, and still ends in order.
TEST_F(ReadBack, AnUnknownFailureIsInternal) {
    const int last = calls("vkQueueWaitIdle");
    const Watched watched = watch(words, Fault{"vkQueueWaitIdle", last, VK_ERROR_UNKNOWN});
    expect_ended(watched.ended, 70, {"read back image '", "-13"});
    EXPECT_EQ(watched.leaks(), "");
    EXPECT_EQ(read("x.exr"), "old");
}

} // namespace
