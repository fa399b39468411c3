#pragma once

#include "benchmark/tune.hpp"
#include "options.hpp"

#include <string>
#include <vector>

namespace catoptric::cli {

/// Returns a table with one line per variant: its ratio to the default, the interval, and whether
/// the variant is chosen.
std::string tuning_table(const session::DeviceInfo& device,
                         const std::vector<measure::VariantTrial>& tried);

/// Runs `bench --tune`: measures variants in `rounds`, prints the results and writes the profile.
/// An empty `output` writes it to the path where the engine looks for it. Returns the exit code.
/// Throws as benchmark::tune_shaders does, `usage` for too few rounds or a given starting
/// profile, and `cannot_create`.
int tune_device(const CommonOptions& common, int rounds, const std::string& output);

} // namespace catoptric::cli
