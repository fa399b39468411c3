#pragma once

#include "controls.hpp"
#include "loop.hpp"
#include "panels.hpp"
#include "session/run.hpp"
#include "settings.hpp"

// Parts of the window's loop, shared by loop.cpp and key_actions.cpp only.
namespace catoptric::view {

class ViewLoop {
public:
    ViewLoop(const ViewOptions& options, const SimulatedUser& driver);
    int run();

private:
    bool is_simulated() const { return options_.common.frames.has_value(); }
    uvec2 initial_size() const;
    enum class SceneChangeOrigin { another, same };
    void open(SceneChangeOrigin scene);
    bool run_frame();
    void perform(const KeyBinding& key);
    void perform_requests(const PanelRequests& requests);
    void load(const std::string& file);
    void start_audit();
    void show_frame(const UserInput& inputs);
    void render(const UserInput& inputs, session::WindowOverlay overlay);
    void audit_last_frame(const UserInput& inputs);
    void recover(const Error& error);
    void show_message(const std::string& text);
    std::string command() const;
    void select_camera(std::size_t index);
    void print_times() const;
    int finish();

    ViewOptions options_;
    const SimulatedUser& driver_;
    ViewerSettings settings_;
    session::Request request_;
    ViewState state_, good_; ///< good: state of the last frame that could be rendered
    ViewWindow window_;
    ImGuiControls controls_;
    std::unique_ptr<SceneViewer> viewer_;
    MouseDrag hand_;
    std::vector<PlanEntry> entries_;
    std::string entries_of_;
    uvec2 first_, last_{0, 0}; ///< window sizes: at the start and last seen
    dvec2 scale_{1};           ///< UserInput::scale
    bool waits_ = false;       ///< whether it waits for window events, because nothing can be shown
    std::size_t frame_ = 0;
    int losses_ = 0;                        ///< device losses since the last rendered frame
    std::optional<study::PlanAudit> audit_; ///< audit of the plan of --audit
    std::size_t audited_cuts_ = 0;          ///< number of cuts before the last frame
    double seconds_ = 0;                    ///< time of the frames shown so far
    double reach_ = 1, period_ = 0;
    bool ends_ = false;
};

} // namespace catoptric::view
