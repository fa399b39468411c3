#pragma once

#include "app/run.hpp"
#include "app/watcher.hpp"
#include "report/comparison.hpp"

namespace catoptric::app {

struct LagRequest {
    Request base; ///< its techniques are measured one by one; its frames and warm-up do not count
    std::string reference = "raytrace:depth=16";
    /// Seconds of the scene's time in 60 frames. Each goes a whole number of times into the
    /// fastest.
    std::vector<double> speeds{0.25, 0.5, 1, 2, 4, 8};
    int most_instants = 30; ///< at which pictures are compared, along the whole path
    Watcher watcher;        ///< the reference counts as a row
    /// Called after each technique; may be empty.
    std::function<void()> on_finished_row;
};

/// Moves the session's scene along its path (one period, at most ten seconds, from `base.time`) at
/// each speed, 60 frames a second, and compares the moving picture with the still one of the same
/// technique and instant. Techniques whose passes read nothing of the frame before are left out:
/// they have no lag. What there is goes into `lag`, which is `complete` at the end: what is thrown
/// in between (`usage`, a signal, whatever the engine throws) leaves it there.
/// Costs about 2300 frames a technique for a path of four seconds.
void measure_lag(Session& session, const LagRequest& request, report::Lag& lag);

} // namespace catoptric::app
