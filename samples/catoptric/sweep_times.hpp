#pragma once

#include "sweep_groups.hpp"

#include <string>
#include <utility>
#include <vector>

namespace catoptric::cli {

/// Returns the names and contents of the tables of times: times.json and times.csv with the time of
/// each row on each machine, machines.csv with the times of each row over machines of one identity,
/// and results.json, which `catoptric results add` puts on a site: the time of each row on each
/// machine beside its median errors over the views. Returns nothing if no group has timing pieces.
std::vector<std::pair<std::string, std::string>> time_tables(const std::vector<SweepGroup>& groups);

} // namespace catoptric::cli
