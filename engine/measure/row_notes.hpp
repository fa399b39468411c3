#pragma once

#include "measure/comparison.hpp"

namespace catoptric::measure {

/// What was done otherwise than the row asks for, a sentence each: the comparison's warnings that
/// begin with the row's label in quotes, without it.
std::vector<std::string> notes_of(const Comparison& comparison, const Row& row);

} // namespace catoptric::measure
