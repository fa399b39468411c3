#pragma once

#include "measure/comparison.hpp"

namespace catoptric::measure {

/// Returns notes on what was done otherwise than the row asks for, one sentence each. These are the
/// comparison's warnings that begin with the row's label in quotes, without that label.
std::vector<std::string> list_row_notes(const Comparison& comparison, const Row& row);

} // namespace catoptric::measure
