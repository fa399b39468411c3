#pragma once

#include "app/bench.hpp"
#include "app/run.hpp"
#include "measure/tuning.hpp"

/// Measuring which variants of shaders (gpu/variants.hpp) suit a device.
namespace catoptric::app {

/// What variants are measured with: it is made of the tracer's shader alone.
inline constexpr const char* kTunedTechnique = "raytrace:depth=4";

struct Tuned {
    std::vector<measure::Tried> tried; ///< in the table's order
    bool noisy = false;                ///< others were at work beside: the ratios may be theirs
};

/// Each variant alone beside the default: the device's time of frames of
/// `request`, whose technique is kTunedTechnique, in rounds of which each has some of every one.
/// `engine`: the options of engines of one device, without variants or profile. Costs as many
/// engines, each with a session of the scene, as there are variants, and one.
Tuned tune(const EngineOptions& engine, const Request& request, const BenchOptions& options);

} // namespace catoptric::app
