#pragma once

#include "core/export.hpp"
#include "measure/comparison.hpp"
#include "session/run.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// Compares the cost and the error of techniques, chooses one by a limit, and audits it.
namespace catoptric::study {
using namespace session;

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
    /// Most time for a reference with noise; 0: each half is one frame with all its rays.
    double reference_seconds = 60;
    bool together = false;                   ///< render all rows in one frame
    int rounds = kRounds;                    ///< at least 6, or one per frame if there are fewer
    std::optional<bool> repeats_first_round; ///< at the end, too; none: if the device is no cpu
    bool both_models = false; ///< measures each row with both models, not `base.model` alone
    /// Studies in addition to time and error, such as {{"causes"}, {"views", 30}, {"lag"}}.
    std::vector<StudyChoice> studies;
    int cameras_per_instant = 1;      ///< neighbouring drawn views that share an instant
    std::vector<std::string> command; ///< command line that the report quotes
    std::string images;               ///< see measure::Comparison::images
    std::vector<std::pair<std::string, std::string>> pictures; ///< more rows: name, picture file
    Watcher watcher;
    /// Called with the unfinished comparison after each row of the first round, each later round
    /// and each part of a study. May be empty.
    std::function<void(const measure::Comparison&)> on_finished_row;
};

/// Renders every row and the reference, measures speed in rounds and error. A row with the knob
/// `samples` is judged against the reference with as many. If a signal, a lost device, missing
/// memory or an exception of `on_finished_row` ends the run, the rows so far are returned with the
/// cause in `stopped`; without rows, a cause that is no signal is thrown.
CATOPTRIC_API measure::Comparison compare(Engine& engine, const CompareRequest& request);

/// Error over the mirrors that a limit is set for.
enum class ErrorQuantity : std::uint8_t { flip, rmse };

/// What a plan must keep, and how it is found and proved.
struct ChooseRequest {
    Request base;          ///< scene and settings; `techniques` are the candidates; empty: all
    std::string reference; ///< see CompareRequest::reference
    double reference_seconds = 60; ///< most time for a reference's noise, in each comparison
    ErrorQuantity quantity = ErrorQuantity::flip;
    std::optional<double> max_error; ///< limit of the error in a view, 0..1
    std::optional<double> max_ms;    ///< limit of the time of a frame, milliseconds
    double share = .95;              ///< share of views that must keep the limit, between 0 and 1
    double confidence = .95;         ///< between 0 and 1
    int training_views = 0;          ///< at least 6; 0: as many as show a breach of `share`
    int cameras_per_instant = 3;     ///< training views that share an instant; proofs have one each
    int proof_views = 0;             ///< views of the proof; 0: as few as can prove the share
    std::uint64_t proof_seed = 2;    ///< seed of the proof's views; must differ from base.seed
    std::string costs; ///< file of another device's costs, to predict times; empty: measure here
    Watcher watcher;
    std::function<void(const std::string&)> tell; ///< gets a sentence at each step; may be empty
};

/// A plan that keeps the limits, or the reason why none was found.
struct ChosenPlan {
    std::string plan;    ///< for FrameSpec::techniques, such as "1=reuse 2,3=secant"; empty: none
    std::string failure; ///< why no plan keeps the limits, a sentence; empty if one does
    std::string json; ///< plan.json, of the nearest plan if none keeps the limits (docs/choose.md)
};
/// Chooses the cheapest plan that keeps a limit of error, or the closest within a limit of time,
/// and proves it on fresh views. Costs a comparison with drawn views for each step. Throws `usage`
/// unless a limit is given, and what `compare` throws.
CATOPTRIC_API ChosenPlan choose(Engine& engine, const ChooseRequest& request);
/// Proves one plan on fresh views: the last step of `choose`.
CATOPTRIC_API ChosenPlan certify(Engine& engine, const ChooseRequest& request,
                                 const std::string& plan);

/// How frames are chosen for an audit (docs/choose.md).
struct AuditOptions {
    int every = 60;         ///< least number of frames in a block, of which one is audited
    double most_time = .05; ///< limit of the audits' time, as a share of the frames' time
    std::uint64_t seed = 1; ///< seed of the random choice of audited frames
    /// Called before references are rendered. Afterwards earlier frames can be read no more.
    std::function<void()> before_audit = {};
};

/// State of an audit after a frame. Frames are counted from the start of the present plan.
struct AuditState {
    std::size_t plan = 0; ///< index of the plan to render, from 0 for the plan with the least error
    std::size_t frames = 0, failures = 0; ///< audited frames: all, and those above the limit
    double assured_share = 0;    ///< share of frames that keep the limit, with the confidence
    double time_share = 0;       ///< time of all audits over the time of all frames
    std::optional<double> error; ///< of this frame, if audited; with noise an upper bound
    bool is_alarm = false;       ///< at this frame it is first certain that too many frames fail
    bool has_new_plan = false;   ///< PlanAudit::plan has changed to a plan with less error
    std::string message;         ///< about the alarm or the change, for the user; empty: neither
};

/// Compares randomly drawn frames of a running program with ray tracing, and so tests whether the
/// plan keeps the limit of its certificate. After an alarm, the plan with less error is proposed.
class PlanAudit {
public:
    /// Reads plans and certificate from a file that `choose` wrote. Throws `missing_input`, `io`,
    /// `bad_data`, and `usage` for options out of range.
    CATOPTRIC_API explicit PlanAudit(const std::filesystem::path& file, AuditOptions options = {});
    CATOPTRIC_API ~PlanAudit();
    /// Returns whether the plans were proved for this scene. True if the file does not say it.
    CATOPTRIC_API bool is_for(const scene::Scene& scene) const;
    /// Returns the plan to render, for FrameSpec::techniques.
    CATOPTRIC_API const std::string& plan() const;
    /// Renders two references, as the first frame does otherwise, to compile shaders and to learn
    /// an audit's time. Throws `usage` if a surface is rough and the reference has no rays for it.
    CATOPTRIC_API void prepare(Session& session, const FrameSpec& spec);
    /// Counts a frame of the session, and audits it if it was drawn. Call it after each frame and
    /// before the next. `seconds`: a time that never falls. Not counted: the first 8 frames of a
    /// plan, and frames of other plans, without a mirror, or with the picture of the frame before.
    CATOPTRIC_API AuditState watch_frame(Session& session, const Frame& frame,
                                         const FrameSpec& spec, double seconds);
    /// Counts no frame until captures can be complete, after a cut or in a new session.
    CATOPTRIC_API void wait_until_settled();
    /// Returns a line such as "audit: 37 of 37 frames keep flip <= 0.05; assured share 0.885; ...".
    CATOPTRIC_API std::string describe() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace catoptric::study
