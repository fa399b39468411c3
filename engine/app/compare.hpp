#pragma once

#include "../core/export.hpp"
#include "../report/comparison.hpp"
#include "run.hpp"
#include "watcher.hpp"

namespace catoptric::app {

inline constexpr const char* kReference = "raytrace:depth=16";
inline constexpr int kRounds = 6; ///< the fewest that bound a median

struct CompareRequest {
    Request base; ///< its `techniques` are the rows; empty = default_techniques(base)
    std::string reference = kReference;
    bool together = false; ///< all rows in one frame
    /// In which the rows' frames are measured, at least 6: one row's frames after another's. Fewer
    /// frames than that are measured one a round.
    int rounds = kRounds;
    /// Each row with everything and with what is required, one after the other; `base.model` else.
    bool both_models = false;
    bool causes = false; ///< split each row's error by cause; only against the default reference
    int views = 1; ///< beside the one of the pictures as many drawn ones (app/views.hpp); 1: none
    bool lag = false; ///< also how far rows are behind a moving scene (app/lag.hpp): minutes a row
    std::vector<std::string> command; ///< for the record
    std::string images;               ///< Comparison::images
    Watcher watcher;
    /// Called after each row of the first round, each later round, and each row or drawn view of
    /// what follows, with what there is so far, not `complete`; may be empty.
    std::function<void(const report::Comparison&)> on_finished_row;
};

/// The rows that each technique of the table names for itself (reflect::Technique::compared), and
/// `auto`, but those that fit no mirror of the scene as `base` shows it.
CATOPTRIC_API std::vector<std::string> default_techniques(const Request& base);
/// Throws `bad_data`, saying how to make one, where a scene has no mirror.
CATOPTRIC_API void check_has_mirror(const scene::Scene& scene);

/// Throws `usage` for fewer than bound a median.
CATOPTRIC_API void check_rounds(int rounds);
/// Throws `usage` for a reference other than the default one, by its settings: what is mended is
/// its own.
CATOPTRIC_API void check_explains(const std::string& reference);
/// Throws `usage` for rows that are unknown or, with the same settings, asked for twice.
CATOPTRIC_API void check_rows(const std::vector<std::string>& techniques);

/// All of these, plans that do not fit the mirrors, and rows that are asked for in both models and
/// in one frame.
CATOPTRIC_API void check_asked(const CompareRequest& request);

/// Renders every row and the reference, measures speed in rounds and error. A row with `samples` is
/// judged against the reference at as many samples. What ends the run early (a signal, a lost
/// device, no memory, `on_finished_row`) is in `stopped` of the rows so far, or thrown where there
/// is none and it was no signal.
CATOPTRIC_API report::Comparison compare(Engine& engine, const CompareRequest& request);

} // namespace catoptric::app
