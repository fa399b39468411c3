// R1: no memory for the k-th object of every kind: exit code 75, a message that names what was
// wanted, nothing left alive on the device, and no file touched.
#include "faults/faults.hpp"

#include <vulkan/vulkan_core.h>

#include <algorithm>
#include <mutex>
#include <numeric>
#include <set>

namespace {

namespace fs = std::filesystem;

/// The calls that the standard lets fail for want of memory and that the engine makes, with a word
/// that the message must have: what was wanted, not only how it is called.
const std::map<std::string, std::string> kCalls = {
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
/// The engine asks for these while it closes, when there is nobody to tell.
const std::set<std::string> kUnheard = {"vkDeviceWaitIdle"};

/// Which of the calls of one name fail in their turn.
using Sample = std::vector<int> (*)(int calls);

std::vector<int> every(int calls) {
    std::vector<int> all(static_cast<std::size_t>(calls));
    std::iota(all.begin(), all.end(), 1);
    return all;
}

std::vector<int> middle(int calls) { return {(calls + 1) / 2}; }

/// Names and contents of all files below a folder.
std::map<std::string, std::string> files_of(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        std::ifstream file(entry.path(), std::ios::binary);
        files[fs::relative(entry.path(), folder)] =
            entry.is_regular_file() ? std::string(std::istreambuf_iterator<char>(file), {}) : "";
    }
    return files;
}

class Memory : public Faults {
protected:
    /// What a faulty run got wrong; empty = nothing.
    static std::string judge(const Fault& fault, const Watched& watched) {
        const std::string name = fault.result == VK_ERROR_OUT_OF_HOST_MEMORY
                                     ? "VK_ERROR_OUT_OF_HOST_MEMORY"
                                     : "VK_ERROR_OUT_OF_DEVICE_MEMORY";
        std::string wrong;
        if (watched.ended.exit_code != 75)
            wrong += "exit code " + std::to_string(watched.ended.exit_code) + "; ";
        if (!watched.ended.out.empty()) wrong += "something on stdout; ";
        if (!watched.ended.err.starts_with("catoptric: Vulkan: cannot ") ||
            std::ranges::count(watched.ended.err, '\n') != 1 ||
            watched.ended.err.find(name) == std::string::npos ||
            watched.ended.err.find(kCalls.at(fault.call)) == std::string::npos)
            wrong += "the message; ";
        return wrong + watched.leaks();
    }

    /// Runs the command once for each chosen call. `old` lies where it writes, and must lie there
    /// untouched.
    void sweep(const Words& words, const std::map<std::string, std::string>& old, Sample sample) {
        const auto lay_out = [&](const std::string& place) {
            for (const auto& [name, content] : old) {
                fs::create_directories((folder / place / name).parent_path());
                write(place + "/" + name, content);
            }
            return files_of(folder / place);
        };
        lay_out("whole");
        const Watched whole = watch(words, std::nullopt, "whole");
        ASSERT_EQ(whole.ended.exit_code, 0) << whole.ended.err;
        ASSERT_EQ(whole.leaks(), "");

        std::vector<Fault> faults;
        for (const auto& [call, count] : whole.counts) {
            if (kUnheard.contains(call)) continue;
            ASSERT_TRUE(kCalls.contains(call))
                << call << " is made " << count.calls << " times and not watched";
            for (const int k : sample(count.calls))
                faults.push_back({call, k,
                                  faults.size() % 2 ? VK_ERROR_OUT_OF_DEVICE_MEMORY
                                                    : VK_ERROR_OUT_OF_HOST_MEMORY});
        }
        std::mutex mutex;
        std::map<std::string, int> tried, right;
        two_at_a_time(faults.size(), [&](std::size_t i) {
            const std::string place = std::to_string(i);
            const auto before = lay_out(place);
            const Watched watched = watch(words, faults[i], place);
            std::string wrong = judge(faults[i], watched);
            if (files_of(folder / place) != before) wrong += "; files were touched";
            fs::remove_all(folder / place);
            const std::lock_guard lock(mutex);
            EXPECT_EQ(wrong, "") << faults[i].call << " " << faults[i].at << ": "
                                 << watched.ended.err;
            ++tried[faults[i].call];
            right[faults[i].call] += wrong.empty();
        });
        for (const auto& [call, count] : whole.counts)
            if (!kUnheard.contains(call))
                std::printf("  %-28s %4d calls, %2d made to fail in their turn, %2d ended well\n",
                            call.c_str(), count.calls, tried[call], right[call]);
    }
};

TEST_F(Memory, EveryCallOfARender) {
    sweep({"render", "--technique", "hybrid:face=16,shadow_map=16", "--size", "64x64", "--frames",
           "1", "--warmup", "0", "-o", "x.exr"},
          {{"x.exr", "old"}}, every);
}

TEST_F(Memory, TheMiddleCallOfEachKindOfAComparison) {
    sweep({"compare", "-o", "out", "--size", "32x32", "--frames", "1", "--warmup", "1",
           "--no-causes", "--techniques", "parallax:face=16,shadow_map=16",
           "hybrid:face=16,shadow_map=16"},
          {{"out/report.json", "old"},
           {"out/report.html", "old"},
           {"out/images/reference.png", "old"}},
          middle);
}

/// Z1: a run allocates what `graph` announces, a share of the scene that does not grow with the
/// picture, and one buffer through which pictures are read: 16 bytes a pixel.
TEST_F(Memory, InUseIsWhatThePlanAnnounces) {
    constexpr std::uint64_t kCounters = 256; // at 1x1 the buffer is that of what is counted
    std::optional<std::uint64_t> scene;
    for (const std::string technique :
         {"raytrace", "parallax:face=64", "reuse:face=32", "hybrid:face=32"}) {
        for (const auto& [width, height] :
             {std::pair(1, 1), std::pair(1, 2000), std::pair(1500, 1100)}) {
            const std::string size = std::to_string(width) + "x" + std::to_string(height);
            const auto with_frame = [&](Words words) {
                words.insert(words.end(), {"--technique", technique, "--size", size});
                return words;
            };
            const test::Ended graph = cli(with_frame({"graph", "--format", "json"}));
            ASSERT_EQ(graph.exit_code, 0) << graph.err;
            const auto announced =
                nlohmann::json::parse(graph.out).at("bytes").get<std::uint64_t>();
            const Watched watched = watch(
                with_frame({"render", "--frames", "2", "--warmup", "1", "-o", "x.exr"}),
                std::nullopt);
            ASSERT_EQ(watched.ended.exit_code, 0) << watched.ended.err;
            const std::uint64_t known = announced +
                                        16 * std::uint64_t(width) * std::uint64_t(height);
            ASSERT_GE(watched.most_bytes, known) << technique << " at " << size;
            const std::uint64_t rest = watched.most_bytes - known;
            std::printf("  %s at %s: %llu bytes, announced %llu, the scene's share %llu\n",
                        technique.c_str(), size.c_str(),
                        static_cast<unsigned long long>(watched.most_bytes),
                        static_cast<unsigned long long>(announced),
                        static_cast<unsigned long long>(rest));
            EXPECT_NEAR(double(rest), double(scene.value_or(rest)), double(kCounters))
                << technique << " at " << size;
            scene = scene.value_or(rest);
        }
    }
}

/// A full descriptor pool is no failure: the next one is made.
TEST_F(Memory, AFullDescriptorPoolIsFollowedByAnother) {
    const Words words = {"render", "--technique", "parallax:face=16,shadow_map=16",
                         "--size", "64x64",       "--frames",
                         "1",      "--warmup",    "1",
                         "-o",     "x.exr"};
    const Watched whole = watch(words, std::nullopt);
    ASSERT_EQ(whole.ended.exit_code, 0) << whole.ended.err;
    const std::string picture = read("x.exr");
    for (const int result : {VK_ERROR_OUT_OF_POOL_MEMORY, VK_ERROR_FRAGMENTED_POOL}) {
        const Watched watched = watch(words, Fault{"vkAllocateDescriptorSets", 3, result});
        EXPECT_EQ(watched.ended.exit_code, 0) << watched.ended.err;
        EXPECT_EQ(watched.leaks(), "");
        EXPECT_EQ(watched.counts.at("vkCreateDescriptorPool").calls,
                  whole.counts.at("vkCreateDescriptorPool").calls + 1);
        EXPECT_EQ(read("x.exr"), picture);
    }
}

} // namespace
