#pragma once

#include "../core/export.hpp"
#include "../report/comparison.hpp"
#include "../session/run.hpp"
#include "../session/watcher.hpp"

namespace catoptric::app {

inline constexpr const char* kReference = "raytrace:depth=16";
inline constexpr int kRounds = 6; ///< fewest rounds that give a confidence interval of the median

/// A study that the user asks for: its name in the table of studies (study/study.hpp), and the
/// number that belongs to it, such as that of drawn views.
struct StudyChoice {
    std::string name;
    int count = 1;
};

struct CompareRequest {
    /// The compared scene and settings; its `techniques` are the rows (empty:
    /// default_techniques(base)).
    Request base;
    std::string reference = kReference;
    bool together = false; ///< render all rows in one frame
    /// Number of rounds, at least 6. Each round measures some frames of every row, one row after
    /// another. If there are fewer frames than rounds, each round has one frame.
    int rounds = kRounds;
    /// Whether each row is measured twice, with the model `everything` and with `required`. False:
    /// each row is measured once, with `base.model`.
    bool both_models = false;
    /// Studies in addition to time and error, such as {{"causes"}, {"views", 30}, {"lag"}}. Rows of
    /// the table that study/study.hpp describes.
    std::vector<StudyChoice> studies;
    std::vector<std::string> command; ///< command line that the report quotes
    std::string images;               ///< see report::Comparison::images
    Watcher watcher;
    /// Called with the unfinished comparison, whose `complete` is false; may be empty. The calls
    /// follow each row of the first round, each later round, and each row or drawn view of the
    /// later steps.
    std::function<void(const report::Comparison&)> on_finished_row;
};

/// Returns the rows that each technique of the table proposes (reflect::Technique::compared), and
/// `auto`. Leaves out rows that fit no mirror of the scene as `base` shows it.
CATOPTRIC_API std::vector<std::string> default_techniques(const Request& base);
/// Throws `bad_data` if the scene has no mirror. The message says how to make one.
CATOPTRIC_API void check_has_mirror(const scene::Scene& scene);

/// Throws `usage` if the rounds are too few for a confidence interval of the median.
CATOPTRIC_API void check_rounds(int rounds);
/// Throws `usage` for unknown rows, and for two rows with the same settings.
CATOPTRIC_API void check_rows(const std::vector<std::string>& techniques);

/// Applies all checks above. Also refuses plans that do not fit the mirrors, and rows that are
/// asked for in both models and in one frame.
CATOPTRIC_API void check_asked(const CompareRequest& request);

/// Renders every row and the reference, measures speed in rounds and error. A row with the knob
/// `samples` is judged against the reference with as many samples. A run ends early by a signal, a
/// lost device, missing memory or an exception of `on_finished_row`. The rows measured before the
/// end are then returned with the cause in `stopped`. If there are no rows and the cause is no
/// signal, the cause is thrown instead.
CATOPTRIC_API report::Comparison compare(Engine& engine, const CompareRequest& request);

} // namespace catoptric::app
