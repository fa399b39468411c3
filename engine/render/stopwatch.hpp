#pragma once

#include <chrono>

namespace catoptric::render {

/// Adds the milliseconds of its life to a sum.
class Stopwatch {
public:
    explicit Stopwatch(double& sum_ms) : sum_ms_(sum_ms) {}
    ~Stopwatch() {
        const std::chrono::duration<double, std::milli> life = Clock::now() - begin_;
        sum_ms_ += life.count();
    }
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;

private:
    using Clock = std::chrono::steady_clock;
    double& sum_ms_;
    Clock::time_point begin_ = Clock::now();
};

} // namespace catoptric::render
