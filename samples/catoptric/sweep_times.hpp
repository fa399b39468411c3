#pragma once

#include "sweep_groups.hpp"

#include <string>
#include <utility>
#include <vector>

namespace catoptric::cli {

/// Returns the names and contents of the tables of times: times.json and times.csv with the time of
/// each row on each machine, and machines.csv with the times of each row over machines of one
/// identity. Returns no table if no group has timing pieces.
std::vector<std::pair<std::string, std::string>>
make_time_tables(const std::vector<SweepGroup>& groups);

} // namespace catoptric::cli
