#pragma once

#include <optional>
#include <span>

namespace catoptric::measure {

/// Returns the smallest k, from 1, such that entry k and all later entries are at most `bound`.
/// Returns nothing if the list is empty or its last entry is larger. NaN counts as larger than
/// `bound`.
std::optional<int> find_settled_frame(std::span<const double> errors, double bound);

} // namespace catoptric::measure
