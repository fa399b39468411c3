#pragma once

#include "compare.hpp"
#include "inputs.hpp"
#include "reference.hpp"
#include "session/run.hpp"
#include "session/screen.hpp"
#include "times.hpp"
#include "window.hpp"

#include <deque>
#include <filesystem>

namespace catoptric::view {

/// A scene on a device, with its frames in a window. Two frames are in flight. The user's view of
/// it is a ViewState, which outlives this object.
class SceneViewer {
public:
    /// Opens the request's scene with its size and first instant. Throws as Engine, WindowScreen
    /// and Session do.
    SceneViewer(ViewWindow& window, const session::EngineOptions& options,
                const session::Request& request);
    /// Waits for frames in flight.
    ~SceneViewer();

    session::WindowScreen& screen() { return *screen_; }
    session::Session& viewer_session() { return *session_; }
    session::Engine& viewer_engine() { return *engine_; }
    const TimeStatistics& times() const { return times_; }
    const ProgressiveReference& progressive_reference() const { return reference_; }
    const std::optional<measure::Difference>& measured_error() const { return error_; }
    /// Returns how each mirror was drawn in the last frame. `culled_work` returns its culled work.
    std::vector<PlanEntry> entries() const;
    const std::vector<require::CulledWork>& culled_work() const { return left_out_; }
    /// Returns the capture budget of the first technique, if there is one.
    const std::optional<session::CaptureBudget>& capture_budget() const { return capture_budget_; }

    /// Renders a frame of `size`, and shows it if the window is visible (`is_seen`). Throws `usage`
    /// for a plan that does not fit the scene, `device_lost` and `exhausted`.
    void render_frame(const ViewState& state, uvec2 size, session::WindowOverlay overlay,
                      bool is_seen);
    /// Returns the number, from 1, of the mirror that a pixel of the last frame shows; 0: none.
    std::uint32_t mirror_at(uvec2 pixel);
    void discard_history();
    /// Audits the last frame if the audit selects this frame (study::PlanAudit::watch_frame).
    study::AuditState audit_last_frame(study::PlanAudit& audit, double seconds);
    /// Writes the picture of the last frame. A PNG is the picture as shown, without overlay. An EXR
    /// holds the plan's linear picture.
    void write_picture(const std::filesystem::path& file) const;
    session::FrameSpec make_frame_spec() const { return spec_; }
    std::size_t cut_count() const { return cuts_; }
    /// Collects the times of the oldest frames until at most `most` are in flight.
    void collect_frames(std::size_t most);

private:
    void update_spec(const ViewState& state, uvec2 size);
    bool update_roughness(const MirrorRoughness& roughness);
    void measure_at_rest(const ViewState& state);
    std::shared_ptr<const measure::Picture> host_picture(const ViewState& state);

    struct FrameInFlight {
        session::Frame frame;
        TimeStatistics::FrameSample sample;
    };

    std::unique_ptr<session::Engine> engine_;
    std::unique_ptr<session::WindowScreen> screen_;
    std::unique_ptr<session::Session> session_;
    std::deque<FrameInFlight> pending_;
    std::optional<session::Frame> last_;
    session::WindowPictures showing_; ///< what the last frame showed
    session::FrameSpec spec_;
    scene::Scene given_;        ///< the scene without changes of roughness
    MirrorRoughness roughness_; ///< roughness of mirrors that the session's scene shows
    TimeStatistics times_;
    ProgressiveReference reference_;
    std::optional<measure::Difference> error_;
    std::vector<require::CulledWork> left_out_;
    std::optional<session::CaptureBudget> capture_budget_;
    double budget_ms_ = 0;
    std::shared_ptr<const measure::Picture> made_; ///< picture made for `made_mode_`
    ViewMode made_mode_ = ViewMode::plan;
    std::uint32_t made_cause_ = 0;
    int made_gain_ = 0;
    std::size_t frames_ = 0, cuts_ = 0;
    int still_ = 0;          ///< frames since the last change
    bool was_moved_ = false; ///< whether the view moved since the last cut
    double began_ = 0;
};

} // namespace catoptric::view
