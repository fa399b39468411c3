#pragma once

#include <chrono>

namespace catoptric {

using SteadyClock = std::chrono::steady_clock;

inline double ms_since(SteadyClock::time_point begin) {
    return std::chrono::duration<double, std::milli>(SteadyClock::now() - begin).count();
}

/// Adds the milliseconds from its construction to its destruction to a sum.
class Stopwatch {
public:
    explicit Stopwatch(double& sum_ms) : sum_ms_(sum_ms) {}
    ~Stopwatch() { sum_ms_ += elapsed_ms(); }
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;

    double elapsed_ms() const { return ms_since(begin_); }

private:
    double& sum_ms_;
    SteadyClock::time_point begin_ = SteadyClock::now();
};

} // namespace catoptric
