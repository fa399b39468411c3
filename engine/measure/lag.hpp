#pragma once

#include "measure/comparison.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

// Metrics of the lag of rows with history behind a moving scene.
namespace catoptric::measure {

/// Largest difference that counts as settled: one step of 8 bits, linear.
inline constexpr double kMaxSettledError = 1.0 / 255;

/// Errors along the whole path at one speed.
struct LagAtSpeed {
    double speed = 1;               ///< seconds of scene time that pass in 60 frames
    std::vector<Difference> errors; ///< difference from the still picture, one entry an instant
    /// Difference from the reference, one entry an instant.
    std::vector<Difference> reference_errors;
};

/// Differences from the still picture in the frames after a cut. Entry k-1 is frame k.
struct SettlingAfterCut {
    std::vector<double> rmse;
    std::vector<double> max; ///< the largest channel difference of any mirror pixel
    /// First frame from which on the rmse, or each pixel, is within kMaxSettledError. Empty if
    /// that does not happen in these frames.
    std::optional<int> rmse_settled, max_settled;
};

/// The instant and speed at which the FLIP of a row from its still picture is largest, with linear
/// pictures before exposure. Copies of a comparison without pictures have empty pictures.
struct WorstLag {
    double speed = 1;   ///< see LagAtSpeed::speed
    double seconds = 0; ///< the instant, one of LagResults::seconds
    double flip = 0;    ///< FLIP from the still picture over the mirrors, above 0
    Picture moving;     ///< the picture of the moving scene
    Picture still;      ///< the row's picture of the scene at rest
    Picture reference;  ///< the reference of the scene at rest
    /// The first mirror hit of each pixel, as in Comparison::mirror_hits.
    std::vector<std::uint32_t> mirror_hits;
};

struct LagRow {
    std::string label;
    /// Facts about the still pictures. The still picture of an instant shows the scene at rest:
    /// frames start from black captures and are drawn until nothing changes. `still_frames` is the
    /// largest number of frames that an instant needed. `restless_stills` is the number of instants
    /// that still changed at the cap.
    int still_frames = 0;
    int restless_stills = 0;
    /// Difference of the still pictures from the reference, one entry an instant.
    std::vector<Difference> still_reference_errors;
    SettlingAfterCut after_black; ///< captures start black, as in the first frame of a run
    /// The scene jumps to `seconds[0]` from `jump_from`, where its still picture had been reached.
    SettlingAfterCut after_jump;
    std::vector<LagAtSpeed> speeds;
    std::optional<WorstLag> worst; ///< empty as long as no picture differs from its still picture
};

struct LagResults {
    std::vector<double> seconds; ///< the instants in seconds, equally spaced
    double path = 0;      ///< seconds that the instants span, including the way back to the first
    double jump_from = 0; ///< seconds: half the path after the first instant
    int frame_cap = 0;    ///< most frames rendered until a still picture stops changing
    /// FLIP over the mirrors between two reference pictures of the first instant with different
    /// random rays. NaN if the reference has no noise or sees no mirror.
    double reference_flip_floor = std::numeric_limits<double>::quiet_NaN();
    /// Random rays of each point of a rough surface in the reference, and as asked for. 0: none.
    int reference_rays = 0, wanted_reference_rays = 0;
    std::vector<LagRow> rows;
    /// Labels of requested rows without history: their frames read nothing of the last frame.
    std::vector<std::string> without_history;
    bool complete = true; ///< false if the run was interrupted: the data so far
};

/// Returns a metric of each instant, NaN where the instant sees no mirror.
std::vector<double> values_at_instants(const std::vector<Difference>& errors,
                                       double Difference::*figure);
/// Return the mean and a percentile of a metric over the instants that see a mirror, or NaN if none
/// does. `fraction` is 0..1.
double mean_over_instants(const std::vector<Difference>& errors, double Difference::*figure);
double percentile_over_instants(const std::vector<Difference>& errors, double Difference::*figure,
                                double fraction);
/// Returns the instant of the largest FLIP in seconds, or NaN if there is none.
double find_worst_instant(const LagResults& lag, const LagAtSpeed& at);

} // namespace catoptric::measure
