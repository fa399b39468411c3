#pragma once

#include <optional>
#include <span>

namespace catoptric::measure {

/// The smallest k, from 1, such that entry k and all that follow are at most `bound`; none when the
/// last one is not, or when there is none. An entry that is NaN is not within.
std::optional<int> settled_from(std::span<const double> errors, double bound);

} // namespace catoptric::measure
