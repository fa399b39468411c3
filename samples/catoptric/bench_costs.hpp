#pragma once

#include "measure/costs.hpp"
#include "options.hpp"

#include <string>
#include <vector>

namespace catoptric::cli {

struct CostsArguments {
    CommonOptions common;
    std::vector<std::string> scenes;     ///< names of scenes; empty: all built-in scenes
    std::vector<std::string> techniques; ///< empty: those that `compare` proposes for each scene
    std::string times;                   ///< file of times of another device; empty: measure
    std::string output;                  ///< output file; empty: the costs are only printed
    int rounds = 6;
};

/// Runs `bench --costs`: fits the unit costs of a device to the times and the counted work of rows,
/// prints the costs and writes them to a file. Returns the exit code. Throws as
/// benchmark::measure_cost_samples and measure::fit_costs do.
int run_cost_fit(const CostsArguments& arguments);

/// Returns a table of fitted costs, with the share of rows that are predicted well.
std::string costs_table(const measure::DeviceCosts& costs);

} // namespace catoptric::cli
