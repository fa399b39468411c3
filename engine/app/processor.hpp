#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

/// What of the machine's processors this process had, and whether it had to wait for them.
namespace catoptric::app {

/// Seconds of processor time that all threads of this process have used.
double process_seconds();

/// Runnable threads of the whole machine, mean of about the last minute; NaN where it is not told.
double machine_load();

/// Seconds that a thread ran, and was ready but waited for a processor, since it began.
struct ThreadTime {
    double ran = 0, waited = 0;
};

/// What processors did so far.
struct ProcessorUse {
    std::map<int, ThreadTime> threads; ///< of this process, by number
    double busy = 0; ///< seconds of all processors, whoever had them; NaN where nobody tells
};

/// From /proc/self/task/*/schedstat and /proc/stat. Nothing where the system does not tell of
/// waiting.
std::optional<ProcessorUse> processor_use();

/// Between two readings, or several pairs of them added up, seconds.
struct Waiting {
    double ran = 0, waited = 0; ///< all threads of this process together
    double others = 0;          ///< that others had processors; NaN: nobody tells
    void operator+=(const Waiting& more);
};
/// A thread that ended in between counts for nothing.
Waiting waiting_between(const ProcessorUse& before, const ProcessorUse& after);

/// Share of the time that threads ran or were ready in which they waited for a processor that
/// others had. A driver has more threads than there are processors and they wait for each other,
/// too: the waiting counts as others' in the proportion in which these had the processors, and all
/// of it where nobody tells.
double waited_share(const Waiting& waiting);

/// Whether threads waited so long that times say little: for more than 5 %.
bool is_noisy(double waited_share);

/// The same where nobody tells of waiting: whether others kept more than a quarter of a processor
/// busy. `load`: see machine_load, in which `used_seconds` of this process count that it spread
/// over the last `elapsed_seconds`.
bool is_noisy(double load, double used_seconds, double elapsed_seconds);

/// As long as it lives, the threads of a software driver that draw (llvmpipe's, by their name) stay
/// on a processor each, as far as this process may use that many. Left alone they now and then
/// share one for some milliseconds while another is idle: frames of two threads then take up to
/// twice as long, and no median of a few frames is free of it.
class HeldThreads {
public:
    HeldThreads();
    ~HeldThreads(); ///< they may go where they were allowed to before
    HeldThreads(const HeldThreads&) = delete;
    HeldThreads& operator=(const HeldThreads&) = delete;

    std::size_t count() const { return threads_.size(); }

private:
    std::vector<int> threads_; ///< numbers
};

} // namespace catoptric::app
