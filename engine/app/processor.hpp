#pragma once

#include <map>
#include <optional>

/// What of the machine's processors this process had, and whether it had to wait for them.
namespace catoptric::app {

/// Seconds of processor time that all threads of this process have used.
double process_seconds();

/// Runnable threads of the whole machine, mean of about the last minute; NaN where it is not told.
double machine_load();

/// Seconds that each thread of this process, by its number, ran and was ready but waited for a
/// processor, since it began.
struct ThreadTime {
    double ran = 0, waited = 0;
};
using ThreadTimes = std::map<int, ThreadTime>;
/// From /proc/self/task/*/schedstat. Nothing where the system does not tell.
std::optional<ThreadTimes> thread_times();

/// All threads together between two readings. One that ended in between counts for nothing.
ThreadTime time_between(const ThreadTimes& before, const ThreadTimes& after);

/// Whether threads waited so long that what they did meanwhile was not measured: for more than 5 %
/// of the time that they ran or waited.
bool is_noisy(const ThreadTime& time);

/// The same where nobody tells of waiting: whether others kept more than a quarter of a processor
/// busy. `load`: see machine_load, in which `used_seconds` of this process count that it spread
/// over the last `elapsed_seconds`.
bool is_noisy(double load, double used_seconds, double elapsed_seconds);

} // namespace catoptric::app
