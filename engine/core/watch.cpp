#include "core/watch.hpp"

#include "core/error.hpp"

#include <utility>

namespace catoptric {

namespace {

thread_local const WorkWatch* watch_of_thread = nullptr;
std::atomic<bool> is_signal_seen{false};

} // namespace

WatchScope::WatchScope(const WorkWatch* watch) : outer_(std::exchange(watch_of_thread, watch)) {}
WatchScope::~WatchScope() { watch_of_thread = outer_; }

const WorkWatch* current_watch() { return watch_of_thread; }

void throw_if_signalled(int signal) {
    if (signal == 0) return;
    is_signal_seen = true;
    fail(signal == 1    ? Failure::hangup
         : signal == 15 ? Failure::terminated
                        : Failure::interrupted,
         "stopped by signal ", signal);
}

bool has_seen_signal() { return is_signal_seen; }

void look_at_stop() {
    const WorkWatch* const watch = current_watch();
    if (watch != nullptr && watch->stop != nullptr) throw_if_signalled(watch->stop->load());
}

} // namespace catoptric
