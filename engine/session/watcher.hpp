#pragma once

#include "../core/error.hpp"

#include <atomic>
#include <functional>
#include <string>

namespace catoptric::app {

/// Observer of long work, such as a comparison. The members are called with the progress, and can
/// end the work. All members are optional.
struct Watcher {
    /// Called before each row with its label, its number from 0, and the number of rows.
    std::function<void(const std::string&, std::size_t, std::size_t)> on_row;
    /// Called after each frame with its number from 1, and the largest possible number of frames.
    std::function<void(int, int)> on_frame;
    /// Points to the number of the signal that asks the work to stop; 0: no signal has arrived. The
    /// caller owns the number and may write it in a signal handler.
    const std::atomic<int>* stop = nullptr;

    void row(const std::string& label, std::size_t index, std::size_t count) const {
        if (on_row) on_row(label, index, count);
    }
    /// Throws if a stop is asked for: `hangup` (1), `terminated` (15), else `interrupted`.
    void check_stopped() const {
        const int signal = stop ? stop->load() : 0;
        if (signal == 0) return;
        fail(signal == 1    ? Failure::hangup
             : signal == 15 ? Failure::terminated
                            : Failure::interrupted,
             "stopped by signal ", signal);
    }
    /// Reports a frame, then checks for a stop.
    void frame(int number, int count) const {
        if (on_frame) on_frame(number, count);
        check_stopped();
    }
};

} // namespace catoptric::app
