#pragma once

#include "compare.hpp"

#include <string>
#include <vector>

namespace catoptric::study {

using namespace session;

/// Returns warnings about light that the row and the reference compute by different models, one
/// sentence each. Such light counts as an error of the row. `technique`: text of the row's
/// technique or plan. `reference`: settings of the reference.
std::vector<std::string> light_model_warnings(const CompareRequest& request,
                                              const std::string& technique,
                                              const std::string& label,
                                              const std::vector<Setting>& reference);

} // namespace catoptric::study
