#pragma once

#include "options.hpp"

#include <string>

namespace catoptric::cli {

/// Runs `bench --calibrate`: fits the unit costs of the device to a few small rows, prints them,
/// and writes them to `output`, or if that is empty to the file from which engines read them.
/// Returns the exit code. Throws as benchmark::measure_calibration_rows does, and `cannot_create`.
int calibrate_device(const CommonOptions& common, const std::string& output);

} // namespace catoptric::cli
