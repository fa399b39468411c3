#pragma once

#include "measure/comparison.hpp"

#include <cstddef>
#include <optional>
#include <string>

// Costs of the set-up work before a comparison.
namespace catoptric::measure {

/// Set-up that is done once, in milliseconds of host time each. The times of the rows do not
/// include it.
struct SetupFacts {
    /// Reading or building the scene; empty if the caller gave no time.
    std::optional<double> load_ms;
    double upload_ms = 0;    ///< laying the scene out for the device and writing it there
    double hierarchy_ms = 0; ///< building the trees for ray tracing; 0 if no row traces rays
    /// Compiling pipelines. Work that a driver defers to the first frame with a pipeline is not
    /// included.
    double compile_ms = 0;
    std::size_t pipelines = 0;
    /// Pipeline cache on disk: "none", "made" (empty before) or "used".
    std::string pipeline_cache = "none";
};

/// Returns the set-up work of a comparison; all zero if none is known.
inline SetupFacts read_setup_facts(const Comparison& comparison) {
    return comparison.setup ? *comparison.setup : SetupFacts{};
}

} // namespace catoptric::measure
