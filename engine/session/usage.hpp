#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

/// Classes that measure how much processor time and how many cycles work takes. On a machine with
/// other programs, cycles repeat from run to run, but time on the clock does not.
namespace catoptric::session {

/// Processor time; and cycles and instructions in user mode, if the system counts them.
struct ProcessorUsage {
    double cpu_ms = 0;
    std::optional<double> cycles, instructions;

    ProcessorUsage operator-(const ProcessorUsage& before) const;
};

class UsageMeter {
public:
    enum class Threads : std::uint8_t {
        /// Only the thread that made the meter is measured, and only that thread may read the
        /// meter.
        caller,
        /// All of the process's processor time. Cycles and instructions are those of the thread
        /// that made the meter, and of all threads begun since by counted threads, ended or not.
        /// Therefore make the meter before other threads begin.
        process
    };
    explicit UsageMeter(Threads of);
    ~UsageMeter();
    UsageMeter(const UsageMeter&) = delete;
    UsageMeter& operator=(const UsageMeter&) = delete;

    /// Returns the usage so far. Costs a few microseconds.
    ProcessorUsage read() const;
    /// Returns why cycles are not counted, in words; empty: they are.
    const std::string& why_uncounted() const { return uncounted_; }

private:
    Threads of_;
    std::array<int, 2> counters_{-1, -1}; ///< file descriptors: cycles, instructions
    std::string uncounted_;
};

} // namespace catoptric::session
