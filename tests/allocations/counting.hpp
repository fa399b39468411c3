#pragma once

#include <cstddef>

namespace test {

/// Returns how often this thread has allocated memory with operator new, which this program
/// replaces. Allocations of a driver's threads do not count.
std::size_t allocations();

/// Makes one allocation fail while this object exists: the one after `after` others, on any thread.
class AllocationRefusal {
public:
    explicit AllocationRefusal(std::size_t after);
    ~AllocationRefusal();
    AllocationRefusal(const AllocationRefusal&) = delete;
    AllocationRefusal& operator=(const AllocationRefusal&) = delete;
};

} // namespace test
