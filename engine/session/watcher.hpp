#pragma once

#include "core/watch.hpp"
#include "session/run.hpp"

#include <string>

// Calls of a Watcher's members.
namespace catoptric::session {

inline void report_row(const Watcher& watcher, const std::string& label, std::size_t index,
                       std::size_t count) {
    if (watcher.on_row) watcher.on_row(label, index, count);
}
/// Throws if a stop is asked for: `hangup` (1), `terminated` (15), else `interrupted`.
inline void throw_if_stopped(const Watcher& watcher) {
    if (watcher.stop) throw_if_signalled(watcher.stop->load());
}
/// Reports a frame, then checks for a stop.
inline void report_frame(const Watcher& watcher, int number, int count) {
    if (watcher.on_frame) watcher.on_frame(number, count);
    throw_if_stopped(watcher);
}

/// Makes the watcher that of all work in this thread, for its life: frames look at the signal
/// between their pieces, and other long work between its own. A watcher without `stop` and
/// `on_piece` leaves the watch as it is.
class WatchedWork {
public:
    explicit WatchedWork(const Watcher& watcher)
        : watch_{.stop = watcher.stop, .on_piece = watcher.on_piece},
          scope_(watcher.stop || watcher.on_piece ? &watch_ : current_watch()) {}

private:
    WorkWatch watch_;
    WatchScope scope_;
};

} // namespace catoptric::session
