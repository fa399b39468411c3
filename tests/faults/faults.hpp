#pragma once

#include "cli/program.hpp"
#include "import/load.hpp"
#include "session/run.hpp"

#include <functional>
#include <optional>

/// A Vulkan call that must fail: the `at`-th call of the name `call`, counted from 1.
struct VulkanCallFault {
    std::string call;
    int at = 1;
    int result = 0; ///< result of the call, a VkResult
};

/// How often a Vulkan call was made in a run, and how many objects that it created were never
/// destroyed.
struct CallCount {
    int calls = 0, alive = 0;
};

/// The result of a run under the fault layer (tests/faults/layer).
struct WatchedRun {
    test::ProcessResult ended;
    /// Counts by call; empty if the program crashed or had no fault layer.
    std::map<std::string, CallCount> counts;
    int strays = 0;               ///< handles destroyed although they were not alive
    int untimely = 0;             ///< handles destroyed while the device may use them
    int loose_stamps = 0;         ///< timestamps not directly followed by a barrier
    std::uint64_t most_bytes = 0; ///< largest amount of device memory at one time

    /// Returns a text about objects that the run never destroyed or destroyed wrongly; empty: none.
    std::string describe_undestroyed_objects() const;
    /// Returns a text that lists the objects destroyed after a lost device or a failed wait; empty:
    /// none. After such a failure the engine must destroy no object, not even device and instance.
    std::string describe_objects_destroyed_after_loss() const;
};

/// Fixture that runs the program with the fault layer over its driver. All runs of a test program
/// share one shader cache.
class Faults : public CommandLineTest {
protected:
    /// Fails the test if the Vulkan loader does not load the layer.
    void SetUp() override;

    /// Runs the program with the fault layer in `place`, an existing folder below the folder of the
    /// test. `fault`: the call that must fail, if any.
    WatchedRun run_with_fault_layer(const Words& words, const std::optional<VulkanCallFault>& fault,
                                    const std::string& place = ".") const;
};

/// Puts the fault layer over the driver of this process, which must be a child process
/// (test::run_in_forked_process). The layer counts calls of each Vulkan instance that is made
/// afterwards. Keeps the driver loaded.
class FaultLayerInThisProcess {
public:
    explicit FaultLayerInThisProcess(std::filesystem::path report);
    /// Makes an engine and calls `work` with it. `ended` of the result has the exit code and
    /// message of the error that was thrown, or exit code 0.
    WatchedRun run(const std::optional<VulkanCallFault>& fault,
                   const std::function<void(catoptric::session::Engine&)>& work);

private:
    std::filesystem::path report_;
    catoptric::session::Engine keeps_driver_{{}};
};

/// Calls `run(i)` for each i below `count` on two threads, because a run of the program mostly uses
/// one thread.
void run_on_two_threads(std::size_t count, const std::function<void(std::size_t)>& run);
