#pragma once

#include "benchmark/bench.hpp"
#include "measure/tuning.hpp"
#include "session/run.hpp"

/// Functions that measure which variants of shaders (gpu/variants.hpp) are fastest on a device.
namespace catoptric::benchmark {

using namespace session;

/// Technique with which shader variants are measured. Its frame consists of the ray tracer's shader
/// alone.
inline constexpr const char* kTuningTechnique = "raytrace:depth=4";

struct TuningResult {
    std::vector<measure::VariantTrial> tried; ///< tried variants in the table's order
    /// Other processes used the processors during the measurement, and may have changed the time
    /// ratios.
    bool noisy = false;
};

/// Measures each variant against the default, by the device's time of frames of `request`, whose
/// technique is kTuningTechnique. Every round has some frames of each variant. All variants share
/// one session, because the threads of several software devices would disturb each other. Leaves
/// the engine with the default choices.
TuningResult tune_shaders(Engine& engine, const Request& request, const BenchOptions& options);

} // namespace catoptric::benchmark
