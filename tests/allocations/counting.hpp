#pragma once

#include <cstddef>

namespace test {

/// How often this thread took memory with operator new, which this program replaces. What a
/// driver's threads take is theirs.
std::size_t allocations();

} // namespace test
