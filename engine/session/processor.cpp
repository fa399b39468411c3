#include "session/processor.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include <sched.h>
#include <unistd.h>

namespace catoptric::session {

namespace {

constexpr double kMaxWaitingShare = .05; ///< share of the time that threads ran or were ready
constexpr double kMaxBusyOtherProcessors = .25; ///< number of other processors that may be busy
constexpr double kLoadAverageSeconds = 60;      ///< seconds after which a load counts 1/e
constexpr double kSecondsPerNanosecond = 1e-9;

/// Returns the seconds that all processors worked, for any process.
double read_busy_seconds() {
    std::ifstream file("/proc/stat");
    std::string name;
    double user = 0, nice = 0, system = 0, idle = 0, io = 0, irq = 0, softirq = 0, stolen = 0;
    file >> name >> user >> nice >> system >> idle >> io >> irq >> softirq >> stolen;
    const auto ticks = static_cast<double>(::sysconf(_SC_CLK_TCK));
    if (!file || name != "cpu" || !(ticks > 0)) return std::numeric_limits<double>::quiet_NaN();
    return (user + nice + system + irq + softirq + stolen) / ticks;
}

/// Returns the numbers of this process's threads whose name begins with `prefix`, sorted by name.
std::vector<int> find_threads(const std::string& prefix) {
    std::map<std::string, int> found;
    std::error_code error;
    for (const auto& task : std::filesystem::directory_iterator("/proc/self/task", error)) {
        std::string name;
        std::getline(std::ifstream(task.path() / "comm"), name);
        if (name.starts_with(prefix))
            found.emplace(name, std::stoi(task.path().filename().string()));
    }
    std::vector<int> threads;
    for (const auto& [name, thread] : found) threads.push_back(thread);
    return threads;
}

cpu_set_t read_allowed_processors() {
    cpu_set_t allowed;
    CPU_ZERO(&allowed);
    ::sched_getaffinity(0, sizeof allowed, &allowed);
    return allowed;
}

} // namespace

std::string read_processor_name() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        if (!line.starts_with("model name")) continue;
        const std::size_t begin = line.find_first_not_of(" \t:", line.find(':'));
        if (begin != std::string::npos) return line.substr(begin);
    }
    return "unknown";
}

double read_process_seconds() {
    timespec used{};
    if (::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used) != 0)
        return std::numeric_limits<double>::quiet_NaN();
    return static_cast<double>(used.tv_sec) +
           kSecondsPerNanosecond * static_cast<double>(used.tv_nsec);
}

double read_machine_load() {
    double load = 0;
    return ::getloadavg(&load, 1) == 1 ? load : std::numeric_limits<double>::quiet_NaN();
}

std::optional<ProcessorTimes> read_processor_times() {
    ProcessorTimes use{{}, read_busy_seconds()};
    std::error_code error;
    for (const auto& task : std::filesystem::directory_iterator("/proc/self/task", error)) {
        // The file begins with the nanoseconds that the thread ran, and those that it waited.
        std::ifstream file(task.path() / "schedstat");
        ThreadTimes time;
        if (!(file >> time.ran >> time.waited)) continue; // the thread has ended meanwhile
        time.ran *= kSecondsPerNanosecond, time.waited *= kSecondsPerNanosecond;
        use.threads.emplace(std::stoi(task.path().filename().string()), time);
    }
    if (error || use.threads.empty()) return {};
    return use;
}

void WaitingTimes::operator+=(const WaitingTimes& more) {
    ran += more.ran, waited += more.waited, others += more.others;
}

WaitingTimes waiting_times(const ProcessorTimes& before, const ProcessorTimes& after) {
    WaitingTimes sum;
    for (const auto& [thread, time] : after.threads) {
        const auto found = before.threads.find(thread);
        const ThreadTimes start = found == before.threads.end() ? ThreadTimes{} : found->second;
        sum.ran += time.ran - start.ran;
        sum.waited += time.waited - start.waited;
    }
    sum.others = after.busy - before.busy - sum.ran;
    return sum;
}

double waiting_share(const WaitingTimes& waiting) {
    if (!(waiting.waited > 0)) return 0;
    const double share = waiting.waited / (waiting.ran + waiting.waited);
    if (std::isnan(waiting.others)) return share;
    // The system counts processor time in hundredths of a second, so the difference can be slightly
    // negative.
    const double others = std::max(0.0, waiting.others);
    return others > 0 ? share * others / (waiting.ran + others) : 0;
}

bool is_timing_noisy(double waited_share) { return waited_share > kMaxWaitingShare; }

bool is_timing_noisy(double load, double used_seconds, double elapsed_seconds) {
    if (std::isnan(load) || !(elapsed_seconds > 0)) return false;
    const double own = used_seconds / elapsed_seconds *
                       (1 - std::exp(-elapsed_seconds / kLoadAverageSeconds));
    return load - own > kMaxBusyOtherProcessors;
}

PinnedThreads::PinnedThreads() : threads_(find_threads("llvmpipe-")) {
    const cpu_set_t allowed = read_allowed_processors();
    if (threads_.size() > static_cast<std::size_t>(CPU_COUNT(&allowed))) threads_.clear();
    int processor = -1;
    for (const int thread : threads_) {
        do ++processor;
        while (!CPU_ISSET(processor, &allowed));
        cpu_set_t one;
        CPU_ZERO(&one);
        CPU_SET(processor, &one);
        ::sched_setaffinity(thread, sizeof one, &one);
    }
}

PinnedThreads::~PinnedThreads() {
    const cpu_set_t allowed = read_allowed_processors();
    for (const int thread : threads_) ::sched_setaffinity(thread, sizeof allowed, &allowed);
}

} // namespace catoptric::session
