#pragma once

#include "measure/costs.hpp"

#include <optional>
#include <string>
#include <vector>

// Times of rows whose pictures are files, as their renderers measured them (`--row-times`).
namespace catoptric::app {

/// Returns the time of each row on this device that its file of times states. Empty entries: rows
/// without such a time.
std::vector<std::optional<measure::PredictedTime>>
find_row_times_on_device(const std::vector<measure::Row>& rows, const std::string& device);

} // namespace catoptric::app
