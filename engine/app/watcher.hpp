#pragma once

#include "../core/error.hpp"

#include <atomic>
#include <functional>
#include <string>

namespace catoptric::app {

/// Who waits for long work: is told how far it is and may end it. Everything may be left out.
struct Watcher {
    /// Before each row: its label, number from 0, and the count.
    std::function<void(const std::string&, std::size_t, std::size_t)> on_row;
    /// After each frame: its number from 1, and how many there will be at most.
    std::function<void(int, int)> on_frame;
    /// The caller's; the number of the signal that asks to stop, 0: none yet. May be stored in a
    /// signal handler.
    const std::atomic<int>* stop = nullptr;

    void row(const std::string& label, std::size_t index, std::size_t count) const {
        if (on_row) on_row(label, index, count);
    }
    /// Throws where a stop is asked for: `hangup` (1), `terminated` (15), else `interrupted`.
    void check_stopped() const {
        const int signal = stop ? stop->load() : 0;
        if (signal == 0) return;
        fail(signal == 1    ? Failure::hangup
             : signal == 15 ? Failure::terminated
                            : Failure::interrupted,
             "stopped by signal ", signal);
    }
    /// The same after a frame.
    void frame(int number, int count) const {
        if (on_frame) on_frame(number, count);
        check_stopped();
    }
};

} // namespace catoptric::app
