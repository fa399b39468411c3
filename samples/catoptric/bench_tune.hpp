#pragma once

#include "app/tune.hpp"
#include "options.hpp"

#include <string>
#include <vector>

namespace catoptric::cli {

/// One line a variant: its ratio to the default, with its interval, and whether it is taken.
std::string tuned_table(const app::DeviceInfo& device, const std::vector<measure::Tried>& tried);

/// `bench --tune`: measures in `rounds`, prints, and writes the profile to `output`, or where the
/// engine looks for it if that is empty. Returns the exit code; throws as app::tune does,
/// `usage` for too few rounds and for a profile to begin with, `cannot_create`.
int tune_device(const Common& common, int rounds, const std::string& output);

} // namespace catoptric::cli
