#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

/// Measures the processor time of this process, and whether the process had to wait for processors.
namespace catoptric::session {

/// Returns the seconds of processor time that all threads of this process have used.
double read_process_seconds();

/// Returns the model name of the machine's processor; "unknown" if the system does not report it.
std::string read_processor_name();

/// Returns the number of runnable threads of the whole machine, a mean over about the last minute.
/// NaN if the system does not report it.
double read_machine_load();

/// Seconds that a thread ran, and seconds that it was ready but waited for a processor, since it
/// began.
struct ThreadTimes {
    double ran = 0, waited = 0;
};

/// Use of the machine's processors so far.
struct ProcessorTimes {
    std::map<int, ThreadTimes> threads; ///< threads of this process, by thread number
    /// Seconds that all processors worked, for any process. NaN if the system does not report it.
    double busy = 0;
};

/// Reads /proc/self/task/*/schedstat and /proc/stat. Returns nothing if the system does not report
/// waiting.
std::optional<ProcessorTimes> read_processor_times();

/// Times between two readings, or sums over several pairs of readings, in seconds.
struct WaitingTimes {
    double ran = 0, waited = 0; ///< all threads of this process together
    double others = 0;          ///< processor time of other processes; NaN: unknown
    void operator+=(const WaitingTimes& more);
};
/// Returns the times between two readings. Threads that ended in between are not counted.
WaitingTimes waiting_times(const ProcessorTimes& before, const ProcessorTimes& after);

/// Returns the share of the time that threads ran or were ready in which they waited for a
/// processor that others had. Threads of a driver also wait for each other if they outnumber the
/// processors. Therefore the share of waiting that counts is the share of processor time that
/// others had. If their time is unknown, all waiting counts.
double waiting_share(const WaitingTimes& waiting);

/// Returns whether threads waited for more than 5 % of the time, so that measured times say little.
bool is_timing_noisy(double waited_share);

/// Returns whether others kept more than a quarter of a processor busy, for systems that do not
/// report waiting. `load`: see read_machine_load. `used_seconds`: processor time of this process
/// within the last `elapsed_seconds`, whose share is subtracted from the load.
bool is_timing_noisy(double load, double used_seconds, double elapsed_seconds);

/// Pins each drawing thread of a software driver (llvmpipe's, by their name) to its own processor
/// while this object exists. Pins none if this process may use fewer processors than there are such
/// threads. Unpinned threads sometimes share a processor for some milliseconds while another is
/// idle. Frames of two threads then take up to twice as long, and even the median of a few frames
/// is affected.
class PinnedThreads {
public:
    PinnedThreads();
    ~PinnedThreads(); ///< allows the threads all processors again
    PinnedThreads(const PinnedThreads&) = delete;
    PinnedThreads& operator=(const PinnedThreads&) = delete;

    std::size_t count() const { return threads_.size(); }

private:
    std::vector<int> threads_; ///< thread numbers
};

} // namespace catoptric::session
