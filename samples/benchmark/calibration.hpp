#pragma once

#include "measure/costs.hpp"
#include "session/engine.hpp"
#include "session/watcher.hpp"

#include <vector>

/// Rows whose times and counted work calibrate a device: small pictures of built-in scenes, each
/// with more of one kind of work than the others have.
namespace catoptric::benchmark {

/// Measures the rows as measure_cost_samples does. Takes most of a minute of processor time on a
/// software driver, about half of it in its compiler. The watcher may end it.
std::vector<measure::TimedWork> measure_calibration_rows(session::Engine& engine,
                                                         const session::Watcher& watcher);

} // namespace catoptric::benchmark
