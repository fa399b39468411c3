#pragma once

#include "../core/export.hpp"
#include "difference.hpp"

#include <optional>
#include <string>
#include <vector>

// How far rows that read last frame's captures are behind a moving scene, as plain data. Every
// error is over the pixels whose first hit is a mirror.
namespace catoptric::measure {

/// A picture that changes too little to be seen: one step of 8 bits, linear.
inline constexpr double kLagBound = 1.0 / 255;

/// The whole path at one speed.
struct LagAtSpeed {
    double speed = 1;                         ///< seconds of the scene's time in 60 frames
    std::vector<Difference> errors;           ///< against the still picture, one an instant
    std::vector<Difference> reference_errors; ///< against the reference, one an instant
};

/// The frames after a cut against the still picture; entry k-1 is frame k.
struct Settling {
    std::vector<double> rmse;
    std::vector<double> max; ///< the largest channel difference of any mirror pixel
    /// From this frame on the rmse, or every pixel, is within kLagBound; none: not in these frames.
    std::optional<int> rmse_settled, max_settled;
};

struct LagRow {
    std::string label;
    /// The still picture of an instant: the scene stands, rendered from black captures until
    /// nothing changes any more. Most frames that one took; how many still changed at the cap.
    int still_frames = 0;
    int restless_stills = 0;
    std::vector<Difference> still_reference_errors; ///< against the reference, one an instant
    Settling after_black; ///< captures start black, as in a run's first frame
    Settling
        after_jump; ///< the scene jumps to `seconds[0]` from `jump_from`, whose still was reached
    std::vector<LagAtSpeed> speeds;
};

struct Lag {
    std::vector<double> seconds; ///< the instants, equally spaced
    double path = 0;             ///< seconds that they span, the way back to the first included
    double jump_from = 0;        ///< seconds: half the path after the first instant
    int frame_cap = 0;           ///< most frames that a still or a cut was given
    std::vector<LagRow> rows;
    std::vector<std::string>
        without_history;  ///< asked for, but their frames read nothing of the last
    bool complete = true; ///< false: interrupted, what there was so far
};

/// A figure of every instant; NaN at those that see no mirror.
CATOPTRIC_API std::vector<double> figures_of(const std::vector<Difference>& errors,
                                             double Difference::*figure);
/// Over the instants that see a mirror; NaN where none does.
CATOPTRIC_API double mean_of(const std::vector<Difference>& errors, double Difference::*figure);
CATOPTRIC_API double percentile_of(const std::vector<Difference>& errors,
                                   double Difference::*figure, double fraction);
/// The instant of the largest FLIP, seconds; NaN where there is none.
CATOPTRIC_API double worst_instant(const Lag& lag, const LagAtSpeed& at);

} // namespace catoptric::measure
