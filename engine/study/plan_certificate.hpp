#pragma once

#include "measure/comparison.hpp"

#include <string>
#include <vector>

// Certificates of plans that `catoptric choose` made (docs/choose.md), in the report of a
// comparison.
namespace catoptric::app {

/// Adds what the certificate of its plan states to each row that a file of a plan draws. `texts`:
/// of the rows, in their order; there may be more. Files without a certificate add nothing.
void add_plan_certificates(const std::vector<std::string>& texts, measure::Comparison& comparison);

} // namespace catoptric::app
