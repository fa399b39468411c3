#pragma once

#include "core/error.hpp"
#include "session/run.hpp"

#include <string>

// Calls of a Watcher's members.
namespace catoptric::app {

inline void report_row_to_watcher(const Watcher& watcher, const std::string& label,
                                  std::size_t index, std::size_t count) {
    if (watcher.on_row) watcher.on_row(label, index, count);
}
/// Throws if a stop is asked for: `hangup` (1), `terminated` (15), else `interrupted`.
inline void throw_if_stopped(const Watcher& watcher) {
    const int signal = watcher.stop ? watcher.stop->load() : 0;
    if (signal == 0) return;
    fail(signal == 1    ? Failure::hangup
         : signal == 15 ? Failure::terminated
                        : Failure::interrupted,
         "stopped by signal ", signal);
}
/// Reports a frame, then checks for a stop.
inline void report_frame_to_watcher(const Watcher& watcher, int number, int count) {
    if (watcher.on_frame) watcher.on_frame(number, count);
    throw_if_stopped(watcher);
}

} // namespace catoptric::app
