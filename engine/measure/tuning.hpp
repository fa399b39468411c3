#pragma once

#include "measure/benchmark.hpp"

#include <string>
#include <vector>

/// What is better for a device: a variant of its shaders beside the default.
namespace catoptric::measure {

/// One variant beside the default, measured in the same rounds.
struct Tried {
    std::string variant, choice, standard; ///< "groups", "in order", "scattered"
    std::string benchmark;                 ///< what was measured
    std::vector<double> ms, standard_ms;   ///< of each round, on the device

    /// The variant over the default.
    Ratio ratio() const { return ratio_of(ms, standard_ms); }
    /// Only what is told apart from the default, and is faster.
    bool is_taken() const { return ratio().is_below_one(); }
};

} // namespace catoptric::measure
