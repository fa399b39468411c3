#include "signals.hpp"

#include <cerrno>
#include <csignal>
#include <cstdint>

#include <time.h>

namespace catoptric::cli {

namespace {

constexpr std::int64_t kRepeat = 1'000'000'000; // nanoseconds

std::atomic<int> number_of_signal{0};
std::atomic<std::int64_t> first_at{0}; ///< nanoseconds of the steady clock; 0: not yet

static_assert(std::atomic<int>::is_always_lock_free &&
                  std::atomic<std::int64_t>::is_always_lock_free,
              "a signal handler may only store without a lock");

std::int64_t now() {
    timespec time{};
    ::clock_gettime(CLOCK_MONOTONIC, &time); // a handler may
    return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

void on_signal(int number) {
    const int error = errno;
    std::int64_t never = 0;
    if (first_at.compare_exchange_strong(never, now())) {
        number_of_signal.store(number);
    } else if (now() - first_at.load() > kRepeat) {
        std::signal(number, SIG_DFL);
        std::raise(number); // when this returns
    }
    errno = error;
}

} // namespace

const std::atomic<int>& stop_on_signals() {
    struct sigaction action {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    for (const int signal : {SIGHUP, SIGINT, SIGTERM}) sigaddset(&action.sa_mask, signal);
    for (const int signal : {SIGHUP, SIGINT, SIGTERM}) {
        struct sigaction old {};
        sigaction(signal, nullptr, &old);
        if (old.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
    }
    return number_of_signal;
}

} // namespace catoptric::cli
