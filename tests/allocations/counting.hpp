#pragma once

#include <cstddef>

namespace test {

/// Returns how often this thread has allocated memory with operator new, which this program
/// replaces. Allocations of a driver's threads do not count.
std::size_t allocations();

/// Makes one allocation fail while this object exists: the one after `after` others, on any thread.
class ScopedAllocationRefusal {
public:
    explicit ScopedAllocationRefusal(std::size_t after);
    ~ScopedAllocationRefusal();
    ScopedAllocationRefusal(const ScopedAllocationRefusal&) = delete;
    ScopedAllocationRefusal& operator=(const ScopedAllocationRefusal&) = delete;
};

} // namespace test
