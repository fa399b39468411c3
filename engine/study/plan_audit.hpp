#pragma once

#include "measure/audit.hpp"
#include "measure/audit_schedule.hpp"
#include "session/session.hpp"
#include "study/choose.hpp"

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

// Audits a plan while a program runs. Some frames are also ray traced. If too many frames break the
// certificate's limit of error, the audit changes to a plan with less error.
namespace catoptric::study {

using namespace session;

struct PlanAuditRequest {
    /// Plans from the one with the least error to the last, which runs first.
    std::vector<std::string> plans;
    ErrorQuantity quantity = ErrorQuantity::flip;
    double max_error = 0;                        ///< limit of mirror_error in a frame, 0..1
    std::string reference = "raytrace:depth=16"; ///< with rays=N if surfaces are rough
    std::string scene_hash; ///< hash of the scene that the plans were proved for; empty: not known
    measure::AuditedShare tested;
    measure::AuditPace pace;
    /// Called before watch_frame traces, while results of the frames before can still be read.
    /// May be empty.
    std::function<void()> before_audit;
};

/// Returns the request of a file that `catoptric choose` wrote: the proved plans up to the chosen
/// one, and the certificate's limit, share, confidence and reference. A certificate without a limit
/// of error gives the error that it states. Throws `missing_input`, `io` and `bad_data`.
PlanAuditRequest read_plan_audit(const std::filesystem::path& file);

/// A view that samples a picture: every `step`-th pixel in both directions, as the picture of a
/// separate camera.
struct SampledView {
    std::uint32_t step = 1; ///< odd, so that the samples are centres of pixels
    uvec2 first{0};         ///< pixel of the first sample
    uvec2 size{0};          ///< number of samples along both axes
    /// A camera that sees only the sampled pixels. The ray through the centre of its pixel (x, y)
    /// meets the surface that the picture shows at `first` + `step` * (x, y).
    scene::Camera camera;
};

/// Returns the sampled view for a picture of this size, with as many samples as possible, and at
/// most `most`.
SampledView choose_sampled_view(const scene::Camera& camera, uvec2 size, std::size_t most);
/// Returns the pixels of the samples. Throws `internal` if a sample lies outside of the picture.
measure::Picture sample_picture(const measure::Picture& picture, const SampledView& view);

/// Audits the frames of one session. The samples of a shown frame are compared with a ray-traced
/// picture of the same camera, instant and scene. The ray-traced picture is rendered outside the
/// session's frame sequence. PlanAudit of compare.hpp is this class for the users of the library.
class RunningPlanAudit {
public:
    /// Samples of a frame; a larger picture is sampled in steps of 3, 5, ... pixels.
    static constexpr std::size_t kMostSamples = 40'000;

    /// Throws `usage` for an empty list of plans, and for numbers out of range.
    explicit RunningPlanAudit(PlanAuditRequest request);

    const PlanAuditRequest& request() const { return request_; }
    /// Returns the plan to render, for FrameSpec::techniques.
    const std::string& plan() const { return request_.plans[ladder_.place()]; }
    /// Renders two references, so that shaders are compiled and the time of an audit is known.
    /// Throws `usage` if surfaces of the scene are rough and the reference draws no rays from their
    /// lobes.
    void prepare(Session& session, const FrameSpec& spec);
    /// Counts a frame, and audits it if it is the randomly drawn frame of its block. Call it after
    /// each frame and before the next. `spec` is the frame's specification, and `seconds` a time
    /// that never falls. Frames are not counted if `spec` does not begin with the plan, if they
    /// show the same camera, instant and scene as the frame before, if a surface is rough and the
    /// reference has no rays for it, or within 8 frames after a change of plan. Results of the
    /// session's earlier frames cannot be read after a frame was audited. Throws as prepare and
    /// Session::frame do.
    AuditState watch_frame(Session& session, const Frame& frame, const FrameSpec& spec,
                           double seconds);

    /// After a cut and for a new session, counts no frame until captures can be complete again.
    void wait_until_settled() { frames_of_plan_ = 0; }

    /// Returns the audit of the present plan since this plan began to run. Against a reference with
    /// noise, a frame passes only if the noise cannot hide a failure.
    const measure::Audit& audit() const { return audit_; }
    /// Returns whether it is certain that too many frames of the present plan fail. Against a
    /// reference with noise, only frames count that fail whatever the noise is.
    bool is_alarmed() const { return alarm_.is_alarmed(); }
    const measure::AuditSchedule& schedule() const { return schedule_; }
    /// Returns a line such as "audit: 37 of 37 frames keep flip <= 0.05; assured share 0.885; 4.1 %
    /// of the frames' time".
    std::string describe() const;

private:
    using Clock = std::chrono::steady_clock;

    bool shows_plan(const FrameSpec& spec);
    bool shows_new_picture(const Session& session, const FrameSpec& spec);
    bool can_reference_show(const scene::Scene& scene) const;
    measure::Difference compare_with_trace(Session& session, const measure::Picture& running,
                                           const FrameSpec& spec);
    void check_is_traced(const TechniqueResult& truth) const;
    measure::Difference compare_with_picture(Session& session, const measure::Picture& samples,
                                             const FrameSpec& traced);
    measure::Difference compare_with_halves(Session& session, const measure::Picture& samples,
                                            const FrameSpec& traced);
    void audit_frame(Session& session, const Frame& frame, const FrameSpec& spec,
                     AuditState& state);
    void step(double seconds, AuditState& state);
    double time_share() const;

    PlanAuditRequest request_;
    measure::Audit audit_; ///< counts frames as passed if their error is surely within the limit
    measure::Audit alarm_; ///< counts frames as failed if their error is surely above the limit
    int lobe_seed_ = 0;    ///< seed of the last frame of a reference with noise
    measure::AuditSchedule schedule_;
    measure::PlanLadder ladder_;
    bool is_prepared_ = false, was_alarmed_ = false;
    bool is_paused_ = false;   ///< whether a surface is rough that the reference cannot show
    int frames_of_plan_ = 0;   ///< frames counted since the plan began
    double assured_share_ = 0; ///< measure::Audit::assured_share after the last audited frame
    std::optional<FrameSpec> watched_; ///< specification of the last frame
    /// Plan of a frame, the audited plan, and whether they are the same plan in two spellings.
    struct ComparedPlans {
        std::string shown, audited;
        bool are_same = false;
    };
    ComparedPlans compared_plans_;
    std::uint64_t updates_ = 0; ///< updates of the session's scene data after the last frame
    Clock::time_point ended_;   ///< end of the last call
};

} // namespace catoptric::study
