// Tests of failure R1 of docs/extremes.md: there is no memory for the k-th object of every kind.
// The program exits with 75 and names what needed memory. Nothing stays alive on the device and no
// file changes. After a failed wait nothing is destroyed at all.
#include "faults/faults.hpp"
#include "session/access.hpp"
#include "support/rendering.hpp"

#include <vulkan/vulkan_core.h>

#include <atomic>
#include <set>
#include <utility>

namespace {

namespace fs = std::filesystem;

std::string compile_plan_text(catoptric::session::Engine& engine,
                              const catoptric::session::Request& request) {
    catoptric::session::Session session(engine, request.scene);
    return catoptric::session::Access::format_plan(session, request,
                                                   catoptric::session::PlanFormat::json);
}

/// Vulkan calls that the engine makes and that may fail for lack of memory. Beside each call is a
/// text that the error message must contain, because the message must say what needed memory.
const std::map<std::string, std::string> kFailingCallsAndErrorTexts = {
    {"vkCreateInstance", "an instance"},
    {"vkEnumeratePhysicalDevices", "enumerate devices"},
    {"vkCreateDevice", "open device '"},
    {"vkAllocateMemory", " bytes for "},
    {"vkCreateBuffer", "buffer '"},
    {"vkCreateBufferView", "view buffer '"},
    {"vkCreateImage", "image '"},
    {"vkCreateImageView", "view image '"},
    {"vkCreateSampler", "sampler"},
    {"vkCreateShaderModule", "shader '"},
    {"vkCreateDescriptorSetLayout", "lay out '"},
    {"vkCreatePipelineLayout", "lay out '"},
    {"vkCreatePipelineCache", "pipeline cache"},
    {"vkCreateGraphicsPipelines", "pipeline '"},
    {"vkCreateComputePipelines", "pipeline '"},
    {"vkCreateDescriptorPool", "descriptor pool"},
    {"vkAllocateDescriptorSets", "descriptor set"},
    {"vkCreateCommandPool", "command pool"},
    {"vkAllocateCommandBuffers", "command buffer"},
    {"vkCreateSemaphore", "semaphore"},
    {"vkCreateQueryPool", "time stamps"},
    {"vkBindBufferMemory", "buffer '"},
    {"vkBindImageMemory", "image '"},
    {"vkMapMemory", "map buffer '"},
    {"vkBeginCommandBuffer", "command buffer"},
    {"vkEndCommandBuffer", "command buffer"},
    {"vkQueueSubmit2", "'"},
    {"vkWaitSemaphores", "passes '"},
    {"vkQueueWaitIdle", "'"},
    {"vkGetQueryPoolResults", "time stamps"},
};
/// After a failure of one of these Vulkan calls, the device may still be running commands.
const std::set<std::string> kWaitingVulkanCalls = {"vkWaitSemaphores", "vkQueueWaitIdle"};

/// Returns the contents of all files below a folder, by relative path.
std::map<std::string, std::string> read_all_files_of_folder(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        std::ifstream file(entry.path(), std::ios::binary);
        files[fs::relative(entry.path(), folder)] =
            entry.is_regular_file() ? std::string(std::istreambuf_iterator<char>(file), {}) : "";
    }
    return files;
}

using catoptric::uvec2;

class Memory : public Faults {
protected:
    /// Returns a request for one frame of the built-in scene after `warmup` other frames.
    static catoptric::session::Request make_one_frame_request(const std::string& technique,
                                                              uvec2 size, int warmup) {
        catoptric::session::Request request;
        request.scene = catoptric::scene::load("cornell-mirrors");
        request.camera = request.scene.cameras.front();
        request.techniques = {technique};
        request.size = size;
        request.frames = 1, request.warmup = warmup;
        return request;
    }
    /// Returns a text that describes what a run with a fault did wrong; empty: nothing. `speaker`:
    /// the program's name, with which its error message begins.
    static std::string describe_wrong_behaviour(const VulkanCallFault& fault,
                                                const WatchedRun& watched,
                                                const std::string& speaker) {
        const std::string name = fault.result == VK_ERROR_OUT_OF_HOST_MEMORY
                                     ? "VK_ERROR_OUT_OF_HOST_MEMORY"
                                     : "VK_ERROR_OUT_OF_DEVICE_MEMORY";
        std::string wrong;
        if (watched.ended.exit_code != 75)
            wrong += "exit code " + std::to_string(watched.ended.exit_code) + "; ";
        if (!watched.ended.out.empty()) wrong += "something on stdout; ";
        if (!watched.ended.err.starts_with(speaker + "Vulkan: cannot ") ||
            watched.ended.err.find('\n') < watched.ended.err.size() - 1 ||
            watched.ended.err.find(name) == std::string::npos ||
            watched.ended.err.find(kFailingCallsAndErrorTexts.at(fault.call)) == std::string::npos)
            wrong += "the message '" + watched.ended.err + "'; ";
        wrong += kWaitingVulkanCalls.contains(fault.call)
                     ? watched.describe_objects_destroyed_after_loss()
                     : watched.describe_undestroyed_objects();
        return wrong.empty() ? ""
                             : fault.call + " " + std::to_string(fault.at) + ": " + wrong + "\n";
    }
    /// Returns one fault for each selected call. `choose` gets the number of calls of a name and
    /// returns the numbers, from 1, of the calls that must fail.
    static std::vector<VulkanCallFault> list_faults_of_run(const WatchedRun& whole,
                                                           std::vector<int> (*choose)(int calls)) {
        std::vector<VulkanCallFault> faults;
        for (const auto& [call, count] : whole.counts) {
            if (call.starts_with("vkCmd")) continue; // recorded commands cannot fail
            EXPECT_TRUE(kFailingCallsAndErrorTexts.contains(call))
                << call << " is made " << count.calls << " times and not watched";
            for (const int k : choose(count.calls))
                faults.push_back({call, k,
                                  faults.size() % 2 ? VK_ERROR_OUT_OF_DEVICE_MEMORY
                                                    : VK_ERROR_OUT_OF_HOST_MEMORY});
        }
        return faults;
    }
};

/// Renders in child processes of the test program, which load the driver once. The error is thrown
/// as an exception, and the next engine of the same process works.
TEST_F(Memory, FailureOfAnyVulkanCallLeaksNothing) {
    // The scene is small, because the whole run is repeated for each failing call: each of the
    // first four calls of a name, and every eighth call after these.
    const catoptric::session::Request request = test::make_test_request(
        test::make_lit_room(2, 1), {"hybrid:face=16,shadow_map=16"}, {16, 16});
    const auto render = [&](catoptric::session::Engine& engine) {
        catoptric::session::run(engine, request);
    };
    const auto most = [](int calls) {
        std::vector<int> numbers;
        for (int k = 1; k <= calls; k += k < 4 ? 1 : 8) numbers.push_back(k);
        return numbers;
    };
    constexpr std::size_t kChildProcessCount = 2;
    run_on_two_threads(kChildProcessCount, [&](std::size_t child) {
        const std::string said = test::run_in_forked_process([&] {
            FaultLayerInThisProcess here(folder / ("calls-" + std::to_string(child)));
            const WatchedRun whole = here.run(std::nullopt, render);
            std::string wrong = whole.ended.err + whole.describe_undestroyed_objects();
            const std::vector<VulkanCallFault> faults = list_faults_of_run(whole, most);
            for (std::size_t i = child; i < faults.size(); i += kChildProcessCount)
                wrong += describe_wrong_behaviour(faults[i], here.run(faults[i], render), "");
            std::printf("  %zu calls, of which this process makes every %zuth fail\n",
                        faults.size(), kChildProcessCount);
            std::fflush(stdout);
            return faults.size() < 100 ? wrong + "too few calls" : wrong;
        });
        EXPECT_EQ(said, "");
    });
}

TEST_F(Memory, FailureOfEachKindOfCallInAComparisonKeepsItsFiles) {
    const Words words{"compare",
                      "-o",
                      "out",
                      "--size",
                      "16x16",
                      "--frames",
                      "1",
                      "--warmup",
                      "1",
                      "--progress",
                      "never",
                      "--techniques",
                      "raytrace:depth=1",
                      "parallax:face=16,shadow_map=16"};
    const auto lay_out = [&](const std::string& place) {
        for (const std::string name : {"report.json", "report.html", "images/reference.png"}) {
            const fs::path file = folder / place / "out" / name;
            fs::create_directories(file.parent_path());
            write_input_file(fs::relative(file, folder), "old");
        }
        return read_all_files_of_folder(folder / place);
    };
    lay_out("whole");
    const WatchedRun whole = run_with_fault_layer(words, std::nullopt, "whole");
    ASSERT_EQ(whole.ended.exit_code, 0) << whole.ended.err;
    ASSERT_EQ(whole.describe_undestroyed_objects(), "");
    const std::vector<VulkanCallFault> faults = list_faults_of_run(
        whole, [](int calls) { return std::vector{(calls + 1) / 2}; });
    std::atomic<int> kept = 0;
    run_on_two_threads(faults.size(), [&](std::size_t i) {
        const std::string place = std::to_string(i);
        const auto before = lay_out(place);
        WatchedRun watched = run_with_fault_layer(words, faults[i], place);
        const std::string after = ", after 1 of 2 rows; what there is lies in out, marked "
                                  "incomplete\n";
        if (watched.ended.err.ends_with(after)) {
            const auto document = nlohmann::json::parse(
                read_output_file(place + "/out/report.json"));
            EXPECT_EQ(document["complete"], false);
            EXPECT_EQ(document["rows"].size(), 1U);
            EXPECT_THAT(std::exchange(watched.ended.out, ""),
                        testing::HasSubstr("raytrace:depth=1"));
            ++kept;
        } else {
            EXPECT_TRUE(read_all_files_of_folder(folder / place) == before)
                << faults[i].call << ": files were touched: " << watched.ended.err;
        }
        EXPECT_EQ(describe_wrong_behaviour(faults[i], watched, "catoptric: "), "");
        fs::remove_all(folder / place);
    });
    std::printf("  %zu kinds of calls, the middle one of each made to fail in its turn; a row was "
                "kept of %d\n",
                faults.size(), kept.load());
    EXPECT_GT(kept, 0);
}

/// Test of case Z1 of docs/extremes.md: a run allocates what `graph` announces and two more parts.
/// One part belongs to the scene. It does not grow with the picture and is larger if rays are
/// traced. The other part is a buffer of 16
/// bytes per pixel through which pictures are read.
TEST_F(Memory, MemoryInUseIsWhatThePlanAnnounces) {
    const std::string said = test::run_in_forked_process([&] {
        constexpr std::uint64_t kCounterBytes = 256; // bytes; counters enlarge the buffer at 1x1
        FaultLayerInThisProcess here(folder / "calls");
        std::map<bool, std::uint64_t> scenes; // bytes without and with a BVH for rays
        std::string wrong;
        for (const std::string technique :
             {"raytrace", "parallax:face=64", "reuse:face=32", "hybrid:face=32"}) {
            for (const uvec2 size : {uvec2(1, 1), uvec2(1, 2000), uvec2(1500, 1100)}) {
                const catoptric::session::Request request = make_one_frame_request(technique, size,
                                                                                   1);
                std::uint64_t announced = 0;
                const WatchedRun watched = here.run(
                    std::nullopt, [&](catoptric::session::Engine& engine) {
                        const std::string plan = compile_plan_text(engine, request);
                        announced = nlohmann::json::parse(plan).at("bytes").get<std::uint64_t>();
                        catoptric::session::run(engine, request);
                    });
                const std::uint64_t known = announced + std::uint64_t{16} * size.x * size.y;
                const std::uint64_t rest = watched.most_bytes - known;
                std::printf("  %s at %ux%u: %llu bytes, announced %llu, the scene's share %llu\n",
                            technique.c_str(), size.x, size.y,
                            static_cast<unsigned long long>(watched.most_bytes),
                            static_cast<unsigned long long>(announced),
                            static_cast<unsigned long long>(rest));
                const bool traces = technique == "raytrace" || technique.starts_with("hybrid");
                const std::uint64_t scene = scenes.try_emplace(traces, rest).first->second;
                const std::uint64_t apart = std::max(rest, scene) - std::min(rest, scene);
                if (watched.most_bytes < known || apart > kCounterBytes ||
                    !watched.ended.err.empty())
                    wrong += technique + " at " + std::to_string(size.x) + "x" +
                             std::to_string(size.y) + ": " + watched.ended.err + "; ";
            }
        }
        std::fflush(stdout);
        return wrong;
    });
    EXPECT_EQ(said, "");
}

/// A full descriptor pool is no failure, because the engine makes another pool.
TEST_F(Memory, FullDescriptorPoolIsFollowedByAnother) {
    const Words words = {"render", "--technique", "parallax:face=16,shadow_map=16",
                         "--size", "64x64",       "--frames",
                         "1",      "--warmup",    "1",
                         "-o",     "x.exr"};
    const WatchedRun whole = run_with_fault_layer(words, std::nullopt);
    ASSERT_EQ(whole.ended.exit_code, 0) << whole.ended.err;
    const std::string picture = read_output_file("x.exr");
    for (const int result : {VK_ERROR_OUT_OF_POOL_MEMORY, VK_ERROR_FRAGMENTED_POOL}) {
        const WatchedRun watched = run_with_fault_layer(
            words, VulkanCallFault{"vkAllocateDescriptorSets", 3, result});
        EXPECT_EQ(watched.ended.exit_code, 0) << watched.ended.err;
        EXPECT_EQ(watched.describe_undestroyed_objects(), "");
        EXPECT_EQ(watched.counts.at("vkCreateDescriptorPool").calls,
                  whole.counts.at("vkCreateDescriptorPool").calls + 1);
        EXPECT_EQ(read_output_file("x.exr"), picture);
    }
}

} // namespace
