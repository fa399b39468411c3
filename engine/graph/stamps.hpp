#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace catoptric::graph {

/// Milliseconds from the first time stamp to each. Only the low `valid_bits` (1..64) of a stamp
/// count, and the counter may wrap once in between; `tick_ns`: nanoseconds of one tick. Empty for
/// no stamps.
std::vector<double> milliseconds_since_first(std::span<const std::uint64_t> stamps,
                                             std::uint32_t valid_bits, double tick_ns);

} // namespace catoptric::graph
