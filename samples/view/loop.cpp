// The loop of a window, from opening to closing. User actions change the state, and each frame is
// rendered from the state.
#include "catoptric/program.hpp"
#include "catoptric/signals.hpp"
#include "core/error.hpp"
#include "loop_impl.hpp"
#include "scene/pose.hpp"
#include "session/exposure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace catoptric::view {

namespace {

/// Returns the diagonal of the scene's bounds, in world units.
double scene_diagonal(const scene::Scene& scene) {
    const Bounds<double> bounds = scene::bounds(scene);
    return bounds.empty() ? 1 : std::max(glm::length(bounds.hi - bounds.lo), 1e-9);
}

} // namespace

ViewLoop::ViewLoop(const ViewOptions& options, const SimulatedUser& driver)
    : options_(options), driver_(driver),
      settings_(is_simulated() ? ViewerSettings() : load_settings(settings_file())),
      request_(resolve_view_request(options).request), window_("Catoptric", initial_size()),
      controls_(window_) {
    state_.plan = parse_plan(options.technique);
    state_.other = parse_plan("raytrace");
    state_.shows_panels = settings_.shows_panels, state_.flies = settings_.flies;
    state_.motion.speed = settings_.speed, state_.gain = settings_.gain;
    state_.model = request_.model;
    open(SceneChangeOrigin::another);
    start_audit();
}

/// Starts the audit for which the options name a file of plans.
void ViewLoop::start_audit() {
    audit_.reset();
    if (options_.audit.empty()) return;
    study::AuditOptions options;
    options.every = options_.audit_every;
    options.most_time = options_.audit_percent / 100;
    options.before_audit = [this] { viewer_->collect_frames(0); };
    audit_.emplace(options_.audit, std::move(options));
    if (!audit_->is_for(request_.scene))
        cli::print_warning("--audit " + options_.audit +
                           ": its plans were proved for another scene");
    audit_->prepare(viewer_->viewer_session(), request_);
}

/// Audits the last frame before the next frame is rendered. After an alarm, changes the plan of the
/// window.
void ViewLoop::audit_last_frame(const UserInput& inputs) {
    seconds_ += is_simulated() ? kFrameStepSeconds : inputs.seconds;
    if (!audit_) return;
    if (viewer_->cut_count() != audited_cuts_) audit_->wait_until_settled();
    audited_cuts_ = viewer_->cut_count();
    const study::AuditState audited = viewer_->audit_last_frame(*audit_, seconds_);
    if (audited.has_new_plan) state_.plan = parse_plan(audit_->plan());
    if (!audited.message.empty()) show_message(audited.message);
}

/// Returns the first window size, with room for the picture and for controls beside it, in desktop
/// units.
uvec2 ViewLoop::initial_size() const {
    const bool is_size_said = std::ranges::any_of(
        options_.words, [](const std::string& word) { return word.starts_with("--size"); });
    if (!is_size_said && settings_.window.x > 0) return settings_.window;
    return options_.common.size + uvec2(settings_.shows_panels ? kPanelWidth : 0, 0);
}

/// Opens engine, screen and session for the requested scene.
void ViewLoop::open(SceneChangeOrigin scene) {
    viewer_.reset(); // releases its surface before another is made
    entries_of_.clear();
    const session::EngineOptions options = cli::engine_options(options_.common.device);
    viewer_ = std::make_unique<SceneViewer>(window_, options, request_);
    controls_.upload_font(viewer_->screen());
    if (scene == SceneChangeOrigin::same) return; // the state stays the same
    cli::print_device(viewer_->viewer_engine(), options_.common.output_options);
    session::resolve_exposure(viewer_->viewer_session(), request_);
    state_.camera = request_.camera;
    state_.exposure = request_.exposure;
    state_.motion.time = request_.time;
    state_.motion.plays = request_.animate;
    reach_ = scene_diagonal(request_.scene);
    period_ = scene::scene_period(request_.scene);
    good_ = state_;
}

void ViewLoop::render(const UserInput& inputs, session::WindowOverlay overlay) {
    const bool is_first = inputs.window == first_ || inputs.window == uvec2(0);
    const uvec2 size = is_simulated() && is_first && state_.shows_panels == settings_.shows_panels
                           ? request_.size
                           : choose_picture_size(last_, state_.shows_panels);
    const bool is_seen = inputs.window != uvec2(0) && viewer_->screen().fit(inputs.window);
    waits_ = !is_seen && !is_simulated();
    if (waits_) return;
    viewer_->render_frame(state_, size, std::move(overlay), is_seen);
    good_ = state_, losses_ = 0;
    const std::string text = technique_text(state_.plan) + " " +
                             std::to_string(viewer_->cut_count());
    if (text != entries_of_) { // a suggested plan may change after each cut
        entries_ = state_.plan.typed.empty() ? std::vector<PlanEntry>() : viewer_->entries();
        entries_of_ = text;
    }
}

/// Recovers from an error. After a refused frame, it restores the state of the last good frame.
/// After a device loss, it opens engine, screen and session again. Must be called while `error` is
/// handled, and rethrows it if recovery fails.
void ViewLoop::recover(const Error& error) {
    constexpr int kMaxDeviceLosses = 2; // device losses without a frame in between
    const auto asked = [](const ViewState& state) {
        return std::tie(state.plan, state.other, state.mode, state.model, state.camera,
                        state.motion.time, state.roughness);
    };
    const bool is_lost = !viewer_->viewer_engine().usable();
    losses_ += is_lost;
    const bool is_new = asked(state_) != asked(good_);
    if (frame_ == 0 || losses_ > kMaxDeviceLosses || (!is_lost && !is_new)) throw;
    if (!is_lost || losses_ > 1) { // a single loss may be chance
        state_.plan = good_.plan, state_.other = good_.other;
        state_.mode = good_.mode, state_.model = good_.model;
        state_.camera = good_.camera, state_.motion.time = good_.motion.time;
        state_.roughness = good_.roughness;
    }
    if (!is_lost) return show_message(error.what());
    cli::print_warning(std::string(error.what()) + "; a new session is made");
    open(SceneChangeOrigin::same);
    if (audit_) audit_->wait_until_settled();
    state_.said = std::string("the device was lost: ") + error.what();
}

void ViewLoop::show_frame(const UserInput& inputs) {
    audit_last_frame(inputs);
    PanelRequests requests;
    controls_.begin(glm::max(last_, uvec2(1)), inputs);
    draw_panels(state_, {request_.scene, *viewer_, entries_, period_, audit_ ? &*audit_ : nullptr},
                last_, requests);
    session::WindowOverlay overlay = controls_.end();
    perform_requests(requests);
    render(inputs, std::move(overlay));
    ++frame_;
    if (viewer_->screen().lost()) {
        cli::print_warning("the window's surface was lost; a new session is made");
        open(SceneChangeOrigin::same);
    }
    if (driver_.after) driver_.after({frame_, state_, *viewer_, command()});
}

/// Runs one frame, which may be refused. Returns false after the last frame.
bool ViewLoop::run_frame() try {
    UserInput inputs = window_.poll_events(waits_);
    inputs.on_controls = controls_.takes_mouse();
    if (controls_.takes_keyboard()) inputs.acts.clear(), inputs.flies = {};
    if (driver_.before) driver_.before(frame_ + 1, inputs, state_, window_);
    if (frame_ == 0) first_ = inputs.window;
    if (inputs.window != uvec2(0)) last_ = inputs.window, scale_ = inputs.scale;
    for (const KeyBinding& key : inputs.acts) perform(key);
    for (const std::string& file : inputs.dropped) load(file);
    const uvec2 size = choose_picture_size(last_, state_.shows_panels);
    if (const auto clicked = hand_.apply_drag(inputs, state_, size, reach_))
        state_.chosen = viewer_->mirror_at(*clicked);
    if (is_simulated() && state_.motion.plays)
        state_.motion.time = request_.instant(static_cast<int>(frame_) + 1);
    else
        state_.motion.time = advance_time(state_.motion, inputs.seconds);
    if (ends_ || inputs.closes || cli::stop_on_signals().load() != 0) return false;
    if (inputs.window == uvec2(0) && !is_simulated()) {
        waits_ = true; // minimised: no frame is rendered until the window comes back
        return true;
    }
    show_frame(inputs);
    return !is_simulated() || frame_ < static_cast<std::size_t>(*options_.common.frames);
} catch (const Error& error) {
    recover(error);
    return true;
}

/// Prints the times of the last frames, with -v.
void ViewLoop::print_times() const {
    const TimeStatistics& times = viewer_->times();
    std::vector<TimeRow> lines = times.list_pass_times();
    for (const TimeRow& line : times.host()) lines.push_back(line);
    lines.push_back(times.gpu());
    lines.push_back(times.frame());
    for (const TimeRow& line : lines)
        cli::print_detail(options_.common.output_options,
                          fmt::format("  {:<40} {:10.4f} ms", line.name, line.median));
}

int ViewLoop::finish() {
    print_times();
    if (audit_) cli::print_note(options_.common.output_options, audit_->describe());
    if (!options_.screenshot.empty()) viewer_->write_picture(options_.screenshot);
    if (options_.common.device.validate) viewer_->viewer_engine().check_validation();
    if (is_simulated()) return 0;
    try {
        save_settings({uvec2(glm::round(dvec2(last_) / scale_)), state_.shows_panels, state_.flies,
                       state_.motion.speed, state_.gain},
                      settings_file());
    } catch (const Error& error) { // no reason for the whole run to fail
        cli::print_warning(error.what());
    }
    return 0;
}

int ViewLoop::run() {
    constexpr unsigned kMostSecondsAfterSignal = 2;
    cli::limit_time_after_signal(kMostSecondsAfterSignal);
    while (run_frame()) {
    }
    const int code = finish();
    const int signal = cli::stop_on_signals().load();
    return signal == 0 ? code : 128 + signal;
}

int run_window(const ViewOptions& options, const SimulatedUser& driver) {
    return ViewLoop(options, driver).run();
}

int run_program(int argc, char** argv) {
    const std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
    return cli::run_catching("catoptric-view", [&] {
        return parse_view_command(words,
                                  [](const ViewOptions& options) { return run_window(options); })();
    });
}

} // namespace catoptric::view
