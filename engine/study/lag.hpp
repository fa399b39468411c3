#pragma once

#include "measure/lag.hpp"
#include "report/comparison.hpp"
#include "session/run.hpp"
#include "session/watcher.hpp"

namespace catoptric::study {

using namespace session;

struct LagRequest {
    Request base; ///< techniques to measure one by one; its `frames` and `warmup` are ignored
    std::string reference = "raytrace:depth=16";
    /// Most seconds for the reference's random rays at all instants. Their number is lowered to it.
    double reference_seconds = 60;
    /// Speeds: seconds of scene time in 60 frames. The fastest must be a whole multiple of each.
    std::vector<double> speeds{0.25, 0.5, 1, 2, 4, 8};
    /// Largest number of instants along the scene's motion at which pictures are compared.
    int most_instants = 30;
    Watcher watcher; ///< is told of the reference as one more row
    /// Function that is called after each technique has been measured. May be empty.
    std::function<void()> on_finished_row;
};

/// Measures how far techniques lag behind a moving scene. Moves the session's scene along its path
/// (one period, at most ten seconds, from `base.time`) at each speed, 60 frames a second. Compares
/// each moving picture with the still picture of the same technique and instant. Leaves out
/// techniques whose passes read nothing of the frame before, because they have no lag. Writes
/// results into `lag` as they come, and sets `lag.complete` at the end. An exception (`usage`, a
/// signal, a failure of the engine) leaves the results so far in `lag`. Costs about 2300 frames per
/// technique for a path of four seconds.
void measure_lag(Session& session, const LagRequest& request, report::LagResults& lag);

} // namespace catoptric::study
