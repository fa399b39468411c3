#include "app/processor.hpp"

#include <cmath>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

namespace catoptric::app {

namespace {

constexpr double kMostWaiting = .05; ///< share of the time that threads wanted to run
constexpr double kMostOthers = .25;  ///< processors
constexpr double kLoadMemory = 60;   ///< seconds after which a load counts 1/e
constexpr double kNanosecond = 1e-9;

} // namespace

double process_seconds() {
    timespec used{};
    if (::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used) != 0)
        return std::numeric_limits<double>::quiet_NaN();
    return static_cast<double>(used.tv_sec) + kNanosecond * static_cast<double>(used.tv_nsec);
}

double machine_load() {
    double load = 0;
    return ::getloadavg(&load, 1) == 1 ? load : std::numeric_limits<double>::quiet_NaN();
}

std::optional<ThreadTimes> thread_times() {
    ThreadTimes times;
    std::error_code error;
    for (const auto& task : std::filesystem::directory_iterator("/proc/self/task", error)) {
        std::ifstream file(task.path() / "schedstat"); // ns that it ran, ns that it waited
        ThreadTime time;
        if (!(file >> time.ran >> time.waited)) continue; // it has ended
        time.ran *= kNanosecond, time.waited *= kNanosecond;
        times.emplace(std::stoi(task.path().filename().string()), time);
    }
    if (error || times.empty()) return {};
    return times;
}

ThreadTime time_between(const ThreadTimes& before, const ThreadTimes& after) {
    ThreadTime sum;
    for (const auto& [thread, time] : after) {
        const auto found = before.find(thread);
        const ThreadTime start = found == before.end() ? ThreadTime{} : found->second;
        sum.ran += time.ran - start.ran;
        sum.waited += time.waited - start.waited;
    }
    return sum;
}

bool is_noisy(const ThreadTime& time) {
    return time.waited > kMostWaiting * (time.ran + time.waited);
}

bool is_noisy(double load, double used_seconds, double elapsed_seconds) {
    if (std::isnan(load) || !(elapsed_seconds > 0)) return false;
    const double own = used_seconds / elapsed_seconds *
                       (1 - std::exp(-elapsed_seconds / kLoadMemory));
    return load - own > kMostOthers;
}

} // namespace catoptric::app
