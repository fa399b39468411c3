#pragma once

#include "app/run.hpp"
#include "cli/program.hpp"
#include "scene/load.hpp"

#include <functional>
#include <optional>

/// One Vulkan call that fails: the `at`-th, from 1, of that name.
struct Fault {
    std::string call;
    int at = 1;
    int result = 0; ///< a VkResult
};

/// Calls of one name in a run, and how many of the objects that they made were never destroyed.
struct Count {
    int calls = 0, alive = 0;
};

/// A run under the layer of tests/faults/layer.
struct Watched {
    test::Ended ended;
    std::map<std::string, Count>
        counts;                   ///< empty when the program crashed or the layer was not there
    int strays = 0;               ///< handles destroyed that were not alive
    int untimely = 0;             ///< handles destroyed that the device may still use
    int loose_stamps = 0;         ///< time stamps that no execution barrier follows at once
    std::uint64_t most_bytes = 0; ///< of device memory at one time

    /// What is wrong with what it left on the device; empty = nothing.
    std::string leaks() const;
    /// What is wrong with what it did after the device was lost or not waited for; empty = nothing:
    /// it destroyed nothing, device and instance neither.
    std::string unfit() const;
};

/// The command with that layer over its driver. Its shader cache is kept for the whole program.
class Faults : public Cli {
protected:
    /// Fails where the loader does not load the layer.
    void SetUp() override;

    /// Runs in `place`, a folder below the test's own that must be there.
    Watched watch(const Words& words, const std::optional<Fault>& fault,
                  const std::string& place = ".") const;
};

/// The layer over the driver of this process, for those that are to end (test::in_child): what is
/// made from now on is watched, each instance anew. Keeps the driver loaded.
class WatchedHere {
public:
    explicit WatchedHere(std::filesystem::path report);
    /// Makes an engine and gives it to `work`; `ended` has the message and exit code of the error
    /// that came out of it, or 0.
    Watched run(const std::optional<Fault>& fault,
                const std::function<void(catoptric::app::Engine&)>& work);

private:
    std::filesystem::path report_;
    catoptric::app::Engine keeps_driver_{{}};
};

/// Calls `run(i)` for each i below `count`, two at a time: most of a program's run is one thread's.
void two_at_a_time(std::size_t count, const std::function<void(std::size_t)>& run);
