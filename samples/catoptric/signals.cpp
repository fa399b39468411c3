#include "signals.hpp"

#include "core/watch.hpp"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <system_error>
#include <thread>

#include <sys/eventfd.h>
#include <time.h>
#include <unistd.h>

namespace catoptric::cli {

namespace {

constexpr std::chrono::milliseconds kLongestBlindWork{1500};
constexpr std::int64_t kSignalRepeatNs = 1'000'000'000; // nanoseconds

std::atomic<const char*> program{"catoptric"};
std::atomic<bool> is_looked_at{false}; ///< whether the program polls `number_of_signal`
std::atomic<int> number_of_signal{0};
std::atomic<unsigned> most_seconds{0}; ///< seconds from the first signal to the end; 0: no limit
std::atomic<int> signal_event{-1};     ///< becomes readable at the first signal; -1: none
std::atomic<std::int64_t> first_at{0}; ///< nanoseconds of the steady clock; 0: none yet

static_assert(std::atomic<int>::is_always_lock_free &&
                  std::atomic<std::int64_t>::is_always_lock_free &&
                  std::atomic<unsigned>::is_always_lock_free &&
                  std::atomic<const char*>::is_always_lock_free,
              "a signal handler may only store without a lock");

std::int64_t monotonic_ns() {
    timespec time{};
    ::clock_gettime(CLOCK_MONOTONIC, &time); // allowed in a signal handler
    return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

/// Ends the program with its sentence and exit code, using only calls that are allowed in a signal
/// handler.
[[noreturn]] void exit_from_signal(int number) {
    const char digits[] = {static_cast<char>('0' + number / 10),
                           static_cast<char>('0' + number % 10), '\n'};
    const char* const name = program.load();
    const char text[] = ": stopped by signal ";
    const std::size_t skipped = number < 10 ? 1 : 0;
    char line[128];
    std::size_t size = 0;
    const auto add = [&](const char* part, std::size_t bytes) {
        for (std::size_t i = 0; i < bytes && size < sizeof line; ++i) line[size++] = part[i];
    };
    add(name, std::strlen(name));
    add(text, sizeof text - 1);
    add(digits + skipped, sizeof digits - skipped);
    const ssize_t written = ::write(STDERR_FILENO, line, size);
    static_cast<void>(written); // a failure here cannot be reported
    ::_exit(128 + number);
}

/// Ends the program 1.5 s after a signal, unless the work has seen it by then.
void end_if_not_seen() {
    std::uint64_t value = 0;
    while (::read(signal_event.load(), &value, sizeof value) < 0 && errno == EINTR) {
    }
    std::this_thread::sleep_for(kLongestBlindWork);
    if (!has_seen_signal()) exit_from_signal(number_of_signal.load());
}

void handle_signal(int number) {
    if (!is_looked_at.load()) exit_from_signal(number);
    const int error = errno;
    std::int64_t never = 0;
    if (first_at.compare_exchange_strong(never, monotonic_ns())) {
        number_of_signal.store(number);
        if (const unsigned seconds = most_seconds.load(); seconds > 0)
            ::alarm(seconds); // allowed in a signal handler
        const std::uint64_t one = 1;
        if (const int event = signal_event.load(); event >= 0) {
            const ssize_t written = ::write(event, &one, sizeof one); // wakes end_if_not_seen
            static_cast<void>(written);
        }
    } else if (monotonic_ns() - first_at.load() > kSignalRepeatNs) {
        std::signal(number, SIG_DFL);
        std::raise(number); // delivered when this handler returns
    }
    errno = error;
}

} // namespace

void exit_on_signals(const char* name) {
    program = name;
    struct sigaction action {};
    action.sa_handler = handle_signal;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    for (const int signal : {SIGHUP, SIGINT, SIGTERM}) sigaddset(&action.sa_mask, signal);
    for (const int signal : {SIGHUP, SIGINT, SIGTERM}) {
        struct sigaction old {};
        sigaction(signal, nullptr, &old);
        if (old.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
    }
}

const std::atomic<int>& stop_on_signals() {
    if (is_looked_at.exchange(true)) return number_of_signal;
    signal_event = ::eventfd(0, EFD_CLOEXEC);
    exit_on_signals(program);
    try {
        if (signal_event.load() >= 0) std::thread(end_if_not_seen).detach();
    } catch (const std::system_error&) { // without the thread, a second signal ends the program
    }
    return number_of_signal;
}

void limit_time_after_signal(unsigned seconds) {
    most_seconds = seconds;
    struct sigaction action {};
    action.sa_handler = [](int) { exit_from_signal(number_of_signal.load()); };
    sigfillset(&action.sa_mask);
    sigaction(SIGALRM, &action, nullptr);
}

} // namespace catoptric::cli
