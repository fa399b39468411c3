#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace catoptric::graph {

/// Returns the milliseconds from the first GPU timestamp to each. Only the low `valid_bits` (1..64)
/// of a timestamp are valid. The counter may wrap once between the first and each other timestamp.
/// `tick_ns`: nanoseconds per tick. The result is empty if there are no timestamps.
std::vector<double> to_milliseconds(std::span<const std::uint64_t> stamps, std::uint32_t valid_bits,
                                    double tick_ns);

/// Takes the time between the pieces of a frame out of its times. `begins`: positions of the first
/// time of each piece but the first; the time before it ends the piece before. Both are removed.
std::vector<double> remove_gaps(std::span<const double> times, std::span<const std::size_t> begins);

} // namespace catoptric::graph
