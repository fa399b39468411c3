#pragma once

#include "measure/costs.hpp"

#include <optional>
#include <string>
#include <vector>

// Functions for stated times of rows whose pictures are files, as other renderers measured them
// (`--row-times`).
namespace catoptric::study {

/// Returns, for each row, the time on this device that a file of stated times gives; empty for rows
/// without such a time.
std::vector<std::optional<measure::PredictedTime>>
find_row_times(const std::vector<measure::Row>& rows, const std::string& device);

} // namespace catoptric::study
