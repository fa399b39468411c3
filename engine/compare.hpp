#pragma once

#include "core/export.hpp"
#include "measure/comparison.hpp"
#include "session/run.hpp"

#include <functional>
#include <string>
#include <vector>

/// Compares the cost and the error of techniques.
namespace catoptric::app {

inline constexpr const char* kReference = "raytrace:depth=16";
inline constexpr int kRounds = 6; ///< fewest rounds that give a confidence interval of the median

struct StudyChoice {
    std::string name;                    ///< option of `catoptric compare` without "--"
    int count = 1;                       ///< the option's number, such as that of drawn views
    std::vector<std::string> texts = {}; ///< the option's words, such as file names
};

struct CompareRequest {
    /// Scene and settings. Its `techniques` are the rows; empty: those that techniques propose.
    Request base;
    std::string reference;      ///< empty: kReference, or rays from lobes if a mirror is rough
    std::string reference_file; ///< .exr of its halves, read if it exists and written; empty: none
    double reference_seconds = 60; ///< most time to reduce the noise of a reference
    bool together = false;         ///< render all rows in one frame
    /// Rounds, at least 6, or one per frame if there are fewer. Each measures frames of every row.
    int rounds = kRounds;
    std::optional<bool> repeats_first_round; ///< at the end, too; none: if the device is no cpu
    /// Whether each row is measured with both models, not with `base.model` alone.
    bool both_models = false;
    /// Studies in addition to time and error, such as {{"causes"}, {"views", 30}, {"lag"}}.
    std::vector<StudyChoice> studies;
    int cameras_per_instant = 1;      ///< neighbouring drawn views that share an instant
    std::vector<std::string> command; ///< command line that the report quotes
    std::string images;               ///< see measure::Comparison::images
    std::vector<std::pair<std::string, std::string>> pictures; ///< more rows: name, picture file
    Watcher watcher;
    /// Called with the unfinished comparison, whose `complete` is false, after each row of the
    /// first round, after each later round, and after each part of a study. May be empty.
    std::function<void(const measure::Comparison&)> on_finished_row;
};

/// Renders every row and the reference, measures speed in rounds and error. A row with the knob
/// `samples` is judged against the reference with as many samples. A run ends early by a signal, a
/// lost device, missing memory or an exception of `on_finished_row`. The rows measured before the
/// end are then returned with the cause in `stopped`. If there are no rows and the cause is no
/// signal, the cause is thrown instead.
CATOPTRIC_API measure::Comparison compare(Engine& engine, const CompareRequest& request);

} // namespace catoptric::app
