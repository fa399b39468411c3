#pragma once

#include "measure/comparison.hpp"

namespace catoptric::measure {

/// Returns notes, one sentence each, on differences between a row's request and what was done.
/// These notes are the comparison's warnings that begin with the row's label in quotes. The label
/// is left out.
std::vector<std::string> row_notes(const Comparison& comparison, const Row& row);

} // namespace catoptric::measure
