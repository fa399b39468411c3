#pragma once

#include <chrono>

namespace catoptric {

/// Adds the milliseconds from its construction to its destruction to a sum.
class Stopwatch {
public:
    explicit Stopwatch(double& sum_ms) : sum_ms_(sum_ms) {}
    ~Stopwatch() { sum_ms_ += ms(); }
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;

    /// Returns the milliseconds since construction.
    double ms() const {
        const std::chrono::duration<double, std::milli> life = Clock::now() - begin_;
        return life.count();
    }

private:
    using Clock = std::chrono::steady_clock;
    double& sum_ms_;
    Clock::time_point begin_ = Clock::now();
};

} // namespace catoptric
