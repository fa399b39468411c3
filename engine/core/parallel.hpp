#pragma once

#include "core/watch.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace catoptric {

/// Returns at least 1.
inline unsigned hardware_thread_count() {
    return std::max(1U, std::thread::hardware_concurrency());
}

/// Calls body(i) for every i below `count`, on at most `threads` threads including the caller's.
/// Fewer threads are used if the system cannot start more. Lower numbers begin first. If calls
/// throw, the calls that have not begun are skipped. Once all threads have ended, the exception of
/// the lowest number is rethrown. Before each call, looks whether the caller's work is to stop.
/// Starting a thread costs some ten microseconds.
template <typename Body>
void parallel_for(std::size_t count, unsigned threads, const Body& body) {
    std::atomic<std::size_t> next{0};
    std::mutex mutex;
    std::exception_ptr error;
    std::size_t thrown_by = count;
    const auto work = [&, watch = current_watch()] {
        const WatchScope scope(watch);
        for (std::size_t i = next++; i < count; i = next++) try {
                look_at_stop();
                body(i);
            } catch (...) {
                const std::lock_guard lock(mutex);
                if (i < thrown_by) thrown_by = i, error = std::current_exception();
                next = count;
            }
    };
    {
        std::vector<std::jthread> others;
        others.reserve(std::min<std::size_t>(threads, count));
        try {
            for (std::size_t t = 1; t < std::min<std::size_t>(threads, count); ++t)
                others.emplace_back(work);
        } catch (const std::system_error&) { // the threads that did start do all the work
        }
        work();
    }
    if (error) std::rethrow_exception(error);
}

} // namespace catoptric
