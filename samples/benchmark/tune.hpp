#pragma once

#include "benchmark/bench.hpp"
#include "measure/tuning.hpp"
#include "session/run.hpp"

/// Measures which variants of shaders (gpu/variants.hpp) suit a device.
namespace catoptric::app {

/// Technique that variants are measured with. It consists of the tracer's shader alone.
inline constexpr const char* kTuningTechnique = "raytrace:depth=4";

struct TuningResult {
    std::vector<measure::ShaderVariantTrial> tried; ///< in the table's order
    /// Other processes were at work and may have caused the ratios.
    bool noisy = false;
};

/// Measures each variant against the default, by the device's time of frames of `request`, whose
/// technique is kTuningTechnique. Every round has some frames of each variant. All variants share
/// one session, because the threads of several software devices would disturb each other. Leaves
/// the engine with the default choices.
TuningResult tune_shader_variants(Engine& engine, const Request& request,
                                  const BenchOptions& options);

} // namespace catoptric::app
