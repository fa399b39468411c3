#include "signals.hpp"

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>

#include <time.h>
#include <unistd.h>

namespace catoptric::cli {

namespace {

constexpr std::int64_t kSignalRepeatNanoseconds = 1'000'000'000; // nanoseconds

std::atomic<const char*> program{"catoptric"};
std::atomic<bool> is_looked_at{false}; ///< whether the program polls `number_of_signal`
std::atomic<int> number_of_signal{0};
std::atomic<unsigned> most_seconds{0}; ///< seconds from the first signal to the end; 0: no limit
std::atomic<std::int64_t> first_at{0}; ///< nanoseconds of the steady clock; 0: none yet

static_assert(std::atomic<int>::is_always_lock_free &&
                  std::atomic<std::int64_t>::is_always_lock_free &&
                  std::atomic<unsigned>::is_always_lock_free &&
                  std::atomic<const char*>::is_always_lock_free,
              "a signal handler may only store without a lock");

std::int64_t monotonic_nanoseconds() {
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

void handle_signal(int number) {
    if (!is_looked_at.load()) exit_from_signal(number);
    const int error = errno;
    std::int64_t never = 0;
    if (first_at.compare_exchange_strong(never, monotonic_nanoseconds())) {
        number_of_signal.store(number);
        if (const unsigned seconds = most_seconds.load(); seconds > 0)
            ::alarm(seconds); // allowed in a signal handler
    } else if (monotonic_nanoseconds() - first_at.load() > kSignalRepeatNanoseconds) {
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
    if (!is_looked_at.exchange(true)) exit_on_signals(program);
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
