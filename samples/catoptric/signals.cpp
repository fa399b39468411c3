#include "signals.hpp"

#include "app/engine.hpp"

#include <csignal>

namespace catoptric::cli {

static_assert(std::atomic<int>::is_always_lock_free,
              "a signal handler may only store without a lock");

void stop_on_signals() {
    for (const int signal : {SIGINT, SIGTERM}) {
        struct sigaction old {};
        sigaction(signal, nullptr, &old);
        if (old.sa_handler == SIG_IGN) continue;
        struct sigaction action {};
        action.sa_handler = [](int number) { app::stop_signal.store(number); };
        action.sa_flags = SA_RESETHAND | SA_RESTART;
        sigaction(signal, &action, nullptr);
    }
}

} // namespace catoptric::cli
