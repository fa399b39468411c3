#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

/// What work costs this process's processors: cycles repeat on a machine that others use, where
/// time on the clock does not.
namespace catoptric::app {

/// Processor time, and in user mode cycles and instructions, where the system counts them.
struct Usage {
    double cpu_ms = 0;
    std::optional<double> cycles, instructions;

    Usage operator-(const Usage& before) const;
};

/// Reads what threads have used so far.
class UsageMeter {
public:
    enum class Of : std::uint8_t {
        caller, ///< the thread that made it, which alone may read it
        /// All of the process's processor time; cycles and instructions of the thread that made it
        /// and of all threads begun since by counted ones, ended or not. So it is made before
        /// there are others.
        process
    };
    explicit UsageMeter(Of of);
    ~UsageMeter();
    UsageMeter(const UsageMeter&) = delete;
    UsageMeter& operator=(const UsageMeter&) = delete;

    /// A few microseconds.
    Usage read() const;
    /// Why cycles are not counted, in words; empty: they are.
    const std::string& uncounted() const { return uncounted_; }

private:
    Of of_;
    std::array<int, 2> counters_{-1, -1}; ///< file descriptors: cycles, instructions
    std::string uncounted_;
};

} // namespace catoptric::app
