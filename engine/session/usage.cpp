#include "session/usage.hpp"

#include "session/processor.hpp"

#include <cerrno>
#include <ctime>
#include <system_error>

#include <linux/perf_event.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace catoptric::session {

namespace {

constexpr std::array<std::uint64_t, 2> kPerfEventCodes{PERF_COUNT_HW_CPU_CYCLES,
                                                       PERF_COUNT_HW_INSTRUCTIONS};

/// Opens a counter of the calling thread in user mode. Returns -1 and sets errno on failure.
int open_perf_counter(std::uint64_t event, bool of_threads_to_come) {
    perf_event_attr wanted{};
    wanted.size = sizeof wanted;
    wanted.type = PERF_TYPE_HARDWARE;
    wanted.config = event;
    wanted.exclude_kernel = 1; // user mode alone may be counted without privileges
    wanted.exclude_hv = 1;
    wanted.inherit = of_threads_to_come ? 1 : 0;
    wanted.read_format = PERF_FORMAT_TOTAL_TIME_ENABLED | PERF_FORMAT_TOTAL_TIME_RUNNING;
    return static_cast<int>(
        ::syscall(SYS_perf_event_open, &wanted, 0, -1, -1, PERF_FLAG_FD_CLOEXEC));
}

/// The count is scaled up if the counter had to share the processor's hardware counters.
std::optional<double> read_perf_counter(int counter) {
    struct {
        std::uint64_t value, enabled, running;
    } found{};
    if (counter < 0 || ::read(counter, &found, sizeof found) != sizeof found) return {};
    const auto value = static_cast<double>(found.value);
    if (found.running == found.enabled) return value;
    if (found.running == 0) return {};
    return value * static_cast<double>(found.enabled) / static_cast<double>(found.running);
}

double read_thread_seconds() {
    timespec used{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
    return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

std::optional<double> difference(const std::optional<double>& after,
                                 const std::optional<double>& before) {
    return after && before ? std::optional(*after - *before) : std::nullopt;
}

} // namespace

ProcessorUsage ProcessorUsage::operator-(const ProcessorUsage& before) const {
    return {cpu_ms - before.cpu_ms, difference(cycles, before.cycles),
            difference(instructions, before.instructions)};
}

UsageMeter::UsageMeter(Threads of) : of_(of) {
    for (std::size_t i = 0; i < kPerfEventCodes.size(); ++i) {
        counters_[i] = open_perf_counter(kPerfEventCodes[i], of == Threads::process);
        if (counters_[i] < 0 && uncounted_.empty())
            uncounted_ = "perf_event_open: " + std::generic_category().message(errno);
    }
}

UsageMeter::~UsageMeter() {
    for (const int counter : counters_)
        if (counter >= 0) ::close(counter);
}

ProcessorUsage UsageMeter::read() const {
    const double seconds = of_ == Threads::process ? read_process_seconds() : read_thread_seconds();
    return {1e3 * seconds, read_perf_counter(counters_[0]), read_perf_counter(counters_[1])};
}

} // namespace catoptric::session
