// Tests of failures R2 and R3 of docs/extremes.md. R2: if the device is lost or a wait for it
// fails, the program exits with 76 or 75 within 5 s. It names the passes or the copy, destroys
// nothing that the driver may still use, and the library stays usable. R3: if a rendered picture
// cannot be read back, the program prints a message and writes no picture.
#include "core/error.hpp"
#include "faults/faults.hpp"

#include <vulkan/vulkan_core.h>

#include <set>

namespace {

using catoptric::Failure;

constexpr double kMaxSecondsAfterDeviceLoss = 5; // seconds

class DeviceLost : public Faults {
protected:
    const Words words = {"render", "--technique", "hybrid:face=16,shadow_map=16",
                         "--size", "64x64",       "--frames",
                         "2",      "--warmup",    "1",
                         "-o",     "x.exr"};

    void SetUp() override {
        Faults::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        write_input_file("x.exr", "old");
    }
    void expect_lost_device_is_abandoned(const VulkanCallFault& fault, const Words& any_of) const {
        const std::string place = fault.call + std::to_string(fault.at) +
                                  std::to_string(
                                      fault.result); // tests that run at once use different folders
        std::filesystem::create_directory(folder / place);
        write_input_file(place + "/x.exr", "old");
        const WatchedRun watched = run_with_fault_layer(words, fault, place);
        const std::string where = fault.call + " " + std::to_string(fault.at) + ": " +
                                  watched.ended.err;
        if (fault.result == VK_ERROR_DEVICE_LOST)
            expect_exit_code(watched.ended, 76, {"VK_ERROR_DEVICE_LOST"});
        else
            expect_exit_code(watched.ended, 75, {"VK_ERROR_OUT_OF_HOST_MEMORY"});
        EXPECT_TRUE(std::ranges::any_of(any_of, [&](const std::string& part) {
            return watched.ended.err.find(part) != std::string::npos;
        })) << where;
        EXPECT_LT(watched.ended.seconds, kMaxSecondsAfterDeviceLoss) << where;
        EXPECT_EQ(watched.describe_objects_destroyed_after_loss(), "") << where;
        EXPECT_EQ(read_output_file(place + "/x.exr"), "old") << where;
        std::printf("  %s in %.2f s: %s", fault.call.c_str(), watched.ended.seconds,
                    watched.ended.err.c_str());
    }
    int count_calls(const std::string& call) const {
        const WatchedRun whole = run_with_fault_layer(words, std::nullopt);
        EXPECT_EQ(whole.ended.exit_code, 0) << whole.ended.err;
        write_input_file("x.exr", "old");
        return whole.counts.at(call).calls;
    }
};

TEST_F(DeviceLost, LossAtASubmitExitsWith76AndKeepsTheOldPicture) {
    const int last = count_calls("vkQueueSubmit2");
    ASSERT_GE(last, 3);
    const std::set chosen{1, 2, last / 2, last - 1, last};
    const std::vector<int> at(chosen.begin(), chosen.end());
    run_on_two_threads(at.size(), [&](std::size_t i) {
        expect_lost_device_is_abandoned({"vkQueueSubmit2", at[i], VK_ERROR_DEVICE_LOST},
                                        {"'view'", "read back image '", "clear image '"});
    });
}

/// In each run, another wait for the device fails. In further runs, the first or the last read of
/// timestamps fails.
TEST_F(DeviceLost, FailedWaitExitsWithAnErrorAndKeepsTheOldPicture) {
    const WatchedRun whole = run_with_fault_layer(words, std::nullopt);
    ASSERT_EQ(whole.ended.exit_code, 0) << whole.ended.err;
    std::vector<VulkanCallFault> faults;
    for (const char* call : {"vkWaitSemaphores", "vkQueueWaitIdle"}) {
        const int last = whole.counts.at(call).calls;
        for (int at = 1; at <= last; ++at) faults.push_back({call, at, VK_ERROR_DEVICE_LOST});
        for (const int at : {1, last}) faults.push_back({call, at, VK_ERROR_OUT_OF_HOST_MEMORY});
    }
    ASSERT_GE(faults.size(), 3 + 5 + 4u);
    for (const int at : {1, whole.counts.at("vkGetQueryPoolResults").calls})
        faults.push_back({"vkGetQueryPoolResults", at, VK_ERROR_DEVICE_LOST});
    run_on_two_threads(faults.size(), [&](std::size_t i) {
        expect_lost_device_is_abandoned(
            faults[i], {"passes '", "'view'", "read back ", "clear image 'capture/cubes.",
                        "clear image 'pyramid'", "clear image 'shadow_map'"});
    });
}

/// An engine whose device was lost repeats its error. The next engine of the same process renders
/// correctly.
TEST_F(DeviceLost, AnotherEngineRendersAfterTheLoss) {
    for (const auto& [result, failure] :
         {std::pair{VK_ERROR_DEVICE_LOST, Failure::device_lost},
          std::pair{VK_ERROR_OUT_OF_DEVICE_MEMORY, Failure::exhausted}}) {
        const std::string said = test::run_in_forked_process([&] {
            FaultLayerInThisProcess here(folder / "calls");
            catoptric::session::Request request;
            request.scene = catoptric::scene::load("cornell-mirrors");
            request.camera = request.scene.cameras.front();
            request.techniques = {"reuse:face=16,shadow_map=16"};
            request.size = {16, 16};
            request.frames = 1, request.warmup = 1;
            std::string wrong;
            const auto failure_of = [&](catoptric::session::Engine& engine) {
                try {
                    catoptric::session::run(engine, request);
                } catch (const catoptric::Error& error) {
                    if (error.failure != failure) wrong += "another failure; ";
                    return std::string(error.what());
                }
                return std::string("nothing was thrown");
            };
            const WatchedRun lost = here.run(
                VulkanCallFault{"vkWaitSemaphores", 2, result},
                [&](catoptric::session::Engine& engine) {
                    if (!engine.usable()) wrong += "unusable from the start; ";
                    const std::string first = failure_of(engine), again = failure_of(engine);
                    if (first.find("passes 'shadow' ") == std::string::npos) wrong += first;
                    if (again != "the device was given up: " + first) wrong += again;
                    if (engine.usable()) wrong += "usable though it is lost; ";
                });
            wrong += lost.describe_objects_destroyed_after_loss();
            if (!catoptric::session::has_abandoned_device()) wrong += "no device was abandoned; ";
            std::vector<catoptric::measure::Picture> pictures;
            for (int i = 0; i < 2; ++i) {
                const WatchedRun next = here.run(
                    std::nullopt, [&](catoptric::session::Engine& engine) {
                        pictures.push_back(
                            catoptric::session::run(engine, request).parts.front().hdr);
                    });
                wrong += next.ended.err + next.describe_undestroyed_objects();
            }
            if (pictures.size() != 2 || pictures[0].pixels != pictures[1].pixels)
                wrong += "two engines, two pictures";
            return wrong;
        });
        EXPECT_EQ(said, "");
    }
}

TEST_F(DeviceLost, LossWhileOpeningTheDeviceExitsWith76) {
    const WatchedRun watched = run_with_fault_layer(
        words, VulkanCallFault{"vkCreateDevice", 1, VK_ERROR_DEVICE_LOST});
    expect_exit_code(watched.ended, 76, {"open device '", "VK_ERROR_DEVICE_LOST"});
    EXPECT_EQ(watched.describe_undestroyed_objects(), "");
}

TEST_F(DeviceLost, LossDuringAComparisonKeepsTheOldReport) {
    std::filesystem::create_directory(folder / "out");
    write_input_file("out/report.json", "old");
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
    const WatchedRun watched = run_with_fault_layer(
        compare, VulkanCallFault{"vkWaitSemaphores", 6, VK_ERROR_DEVICE_LOST});
    expect_exit_code(watched.ended, 76, {"VK_ERROR_DEVICE_LOST", "passes '"});
    EXPECT_EQ(watched.describe_objects_destroyed_after_loss(), "");
    EXPECT_EQ(read_output_file("out/report.json"), "old");
    EXPECT_TRUE(std::filesystem::is_empty(folder / "out/images")) << "made before measuring";
}

class ReadBackDeviceLostTest : public DeviceLost {};

TEST_F(ReadBackDeviceLostTest, FailedMemoryMappingExitsWith75) {
    const int last = count_calls("vkMapMemory");
    for (const int at : std::set{1, last / 2, last}) {
        const WatchedRun watched = run_with_fault_layer(
            words, VulkanCallFault{"vkMapMemory", at, VK_ERROR_MEMORY_MAP_FAILED});
        expect_exit_code(watched.ended, 75, {"map buffer '", "VK_ERROR_MEMORY_MAP_FAILED"});
        EXPECT_EQ(watched.describe_undestroyed_objects(), "");
        EXPECT_EQ(read_output_file("x.exr"), "old");
    }
    const WatchedRun end = run_with_fault_layer(
        words, VulkanCallFault{"vkMapMemory", last, VK_ERROR_MEMORY_MAP_FAILED});
    EXPECT_THAT(end.ended.err, testing::HasSubstr("read-back of "));
}

/// A result that Vulkan does not define for a call is a defect of the driver. The program exits
/// with 70 and keeps the old picture.
TEST_F(ReadBackDeviceLostTest, UnknownVulkanResultExitsWith70) {
    const int last = count_calls("vkQueueWaitIdle");
    const WatchedRun watched = run_with_fault_layer(
        words, VulkanCallFault{"vkQueueWaitIdle", last, VK_ERROR_UNKNOWN});
    expect_exit_code(watched.ended, 70, {"read back image '", "-13"});
    EXPECT_EQ(watched.describe_objects_destroyed_after_loss(), "");
    EXPECT_EQ(read_output_file("x.exr"), "old");
}

/// A wait without a limit that ends early, or timestamps that never come, count as a lost device.
TEST_F(DeviceLost, DeviceThatGivesNoAnswerExitsWith76) {
    for (const auto& [call, result, name] :
         {std::tuple{"vkWaitSemaphores", VK_TIMEOUT, "VK_TIMEOUT (2)"},
          std::tuple{"vkQueueWaitIdle", VK_TIMEOUT, "VK_TIMEOUT (2)"},
          std::tuple{"vkGetQueryPoolResults", VK_NOT_READY, "VK_NOT_READY (1)"}}) {
        const WatchedRun watched = run_with_fault_layer(words, VulkanCallFault{call, 1, result});
        expect_exit_code(watched.ended, 76, {name, "the device gave no answer", "--device"});
        EXPECT_EQ(read_output_file("x.exr"), "old");
        if (result != VK_TIMEOUT) continue;
        EXPECT_EQ(watched.describe_objects_destroyed_after_loss(), "");
    }
}

/// Times cannot be measured with a clock that stands still. A picture without times is drawn.
TEST_F(DeviceLost, StoppedClockEndsMeasurementsWith69) {
    const VulkanCallFault stopped{"vkGetQueryPoolResults", 1, VK_SUCCESS};
    const WatchedRun timed = run_with_fault_layer(words, stopped);
    expect_exit_code(timed.ended, 69, {"the device's clock stands still", "--device"});
    EXPECT_EQ(timed.describe_undestroyed_objects(), "");
    const Words compare{"compare",  "-o", "out",          "--size",      "32x32",
                        "--frames", "6",  "--techniques", "reuse:face=8"};
    expect_exit_code(run_with_fault_layer(compare, stopped).ended, 69,
                     {"the device's clock stands still"});
    const WatchedRun untimed = run_with_fault_layer(
        {"render", "--technique", "reuse:face=8", "--size", "16x16", "-o", "still.png"}, stopped);
    EXPECT_EQ(untimed.ended.exit_code, 0) << untimed.ended.err;
}

} // namespace
