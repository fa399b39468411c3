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

/// Each variant alone beside the default: the device's time of frames of `request`, whose technique
/// is kTunedTechnique, in rounds of which each has some of every one. All in one session, since the
/// threads of several software devices would be in each other's way. Leaves the engine with the
/// defaults.
Tuned tune(Engine& engine, const Request& request, const BenchOptions& options);

} // namespace catoptric::app
