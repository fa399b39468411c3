#pragma once

#include "measure/benchmark.hpp"

#include <string>
#include <vector>

/// Choice of shader variants for a device: each variant is measured against the default.
namespace catoptric::measure {

/// One variant and the default, measured in the same rounds.
struct VariantTrial {
    std::string variant, choice, standard; ///< "groups", "in order", "scattered"
    std::string benchmark;
    std::vector<double> ms, standard_ms; ///< milliseconds of each round, on the device

    /// Returns the variant's time divided by the default's.
    CostRatio time_ratio() const { return cost_ratio(ms, standard_ms); }
    /// Returns whether the variant is faster than the default with 95 % confidence.
    bool is_faster() const { return time_ratio().is_below_one(); }
};

} // namespace catoptric::measure
