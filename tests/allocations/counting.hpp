#pragma once

#include <cstddef>

namespace test {

/// How often this thread took memory with operator new, which this program replaces. What a
/// driver's threads take is theirs.
std::size_t allocations();

/// While it lives, one request for memory is refused: that which comes after so many others, on
/// whichever thread.
class Refusal {
public:
    explicit Refusal(std::size_t after);
    ~Refusal();
    Refusal(const Refusal&) = delete;
    Refusal& operator=(const Refusal&) = delete;
};

} // namespace test
