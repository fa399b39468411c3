#include "viewer.hpp"

#include "catoptric/signals.hpp"
#include "core/error.hpp"
#include "core/stopwatch.hpp"
#include "measure/picture_file.hpp"
#include "scene/build.hpp"

#include <algorithm>
#include <chrono>

namespace catoptric::view {

namespace {

constexpr std::uint32_t kFramesInFlight = 2;
constexpr int kFramesUntilCameraRests =
    3; // after this many frames without a change, the camera rests
constexpr int kUnshownFramesAfterCut = 4; // frames after a cut that are not shown
constexpr int kFramesUntilMeasured =
    12; // frames at rest before errors and their causes are measured

double now_ms() {
    return std::chrono::duration<double, std::milli>(
               std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

/// Returns whether a signal asks the program to end. Work beside the frames then begins no more.
bool is_stopped() { return cli::stop_on_signals().load() != 0; }

bool same_picture(const session::FrameSpec& a, const session::FrameSpec& b) {
    return a.techniques == b.techniques && a.camera == b.camera && a.size == b.size &&
           a.time == b.time && a.exposure == b.exposure && a.model == b.model;
}

} // namespace

SceneViewer::SceneViewer(ViewWindow& window, const session::EngineOptions& options,
                         const session::Request& request) {
    session::EngineHooks hooks;
    window.add_hooks(hooks);
    engine_.reset(new session::Engine(session::Access::make_engine(options, hooks)));
    screen_ = std::make_unique<session::WindowScreen>(*engine_);
    given_ = request.scene;
    separate_materials(given_);
    session_ = std::make_unique<session::Session>(*engine_, given_, kFramesInFlight);
    spec_ = request;
    budget_ms_ = request.budget_ms;
}

SceneViewer::~SceneViewer() = default;

std::vector<PlanEntry> SceneViewer::entries() const {
    return last_ ? last_->read().plan : std::vector<PlanEntry>();
}

void SceneViewer::collect_frames(std::size_t most) {
    while (pending_.size() > most) {
        pending_.front().sample.frame = pending_.front().frame.times();
        times_.add(std::move(pending_.front().sample));
        pending_.pop_front();
    }
}

void SceneViewer::discard_history() {
    collect_frames(0);
    session_->forget();
    was_moved_ = false;
    ++cuts_;
}

/// Returns whether any roughness changed.
bool SceneViewer::update_roughness(const MirrorRoughness& roughness) {
    if (roughness == roughness_) return false;
    const std::vector<std::size_t> mirrors = scene::mirrors(given_);
    const auto set = [&](std::uint32_t mirror, scene::Material value) {
        session_->change(
            scene::set_material(given_.objects[mirrors[mirror - 1]].material, std::move(value)));
    };
    for (const auto& [mirror, value] : roughness_)
        if (!roughness.contains(mirror))
            set(mirror, given_.materials[given_.objects[mirrors[mirror - 1]].material]);
    for (const auto& [mirror, value] : roughness) {
        const auto before = roughness_.find(mirror);
        if (before == roughness_.end() || before->second != value)
            set(mirror, change_roughness(given_, mirror, value));
    }
    roughness_ = roughness;
    return true;
}

/// Updates the frame specification from the state, and counts frames at rest.
void SceneViewer::update_spec(const ViewState& state, uvec2 size) {
    session::FrameSpec next = spec_;
    next.techniques = choose_shown_pictures(state).techniques;
    next.camera = state.camera;
    next.size = size;
    next.time = state.motion.time;
    next.exposure = state.exposure;
    next.model = state.model;
    next.budget_ms = state.model == session::RenderedWork::required ? budget_ms_ : 0;
    const bool is_changed = update_roughness(state.roughness);
    const bool same = same_picture(next, spec_) && !is_changed;
    const bool same_view = next.camera == spec_.camera && next.size == spec_.size &&
                           next.time == spec_.time && next.exposure == spec_.exposure &&
                           !is_changed;
    still_ = same ? still_ + 1 : 0;
    if (!same_view && frames_ > 0) {
        reference_.restart();
        was_moved_ = true;
    }
    if (!same) {
        error_.reset();
        made_.reset();
    }
    spec_ = std::move(next);
}

/// Works while the view is at rest. When the view comes to rest, a new frame sequence begins, as
/// in `catoptric render`. Automatic capture edges then fit this view, and the picture becomes the
/// same bytes. The first frames are not shown, because mirrors do not show each other yet.
void SceneViewer::measure_at_rest(const ViewState& state) {
    if (still_ >= kFramesUntilCameraRests && was_moved_ && !state.motion.plays) {
        discard_history();
        for (int k = 0; k < kUnshownFramesAfterCut && !is_stopped(); ++k) {
            last_ = session_->frame(spec_);
            if (!session::Access::remembers(*last_)) break;
        }
    }
    const bool compares = (state.mode == ViewMode::split || state.mode == ViewMode::difference) &&
                          state.against == ComparisonPicture::reference;
    if (still_ >= kFramesUntilCameraRests && (compares || state.judges) && !is_stopped()) {
        collect_frames(0); // frames outside the sequence use the slots of earlier frames
        reference_.render_pass(*session_, spec_);
    }
    // A picture that paints search answers has no error to measure.
    const bool waits = last_ && last_->waiting() > 0; // the capture budget has put off captures
    if (still_ >= kFramesUntilMeasured && !waits && state.judges &&
        state.mode != ViewMode::answers && !error_ && reference_.can_measure_errors() &&
        !is_stopped()) {
        last_ = session_->frame(spec_);
        error_ = reference_.compare(last_->hdr(), spec_.exposure);
    }
}

std::shared_ptr<const measure::Picture> SceneViewer::host_picture(const ViewState& state) {
    if (state.mode == ViewMode::split || state.mode == ViewMode::difference)
        return reference_.displayed_picture();
    const bool is_made = made_ && made_mode_ == state.mode && made_cause_ == state.cause &&
                         made_gain_ == state.gain;
    if (is_made) return made_;
    if (is_stopped()) return nullptr;
    if (state.mode == ViewMode::causes && still_ < kFramesUntilMeasured) return nullptr;
    made_mode_ = state.mode, made_cause_ = state.cause, made_gain_ = state.gain;
    collect_frames(0);
    if (state.mode == ViewMode::numbers) {
        made_ = std::make_shared<measure::Picture>(
            mirror_number_picture(render_mirror_hits(*session_, spec_), spec_.size));
        return made_;
    }
    session::FrameSpec aside = spec_;
    aside.keeps_history = true;
    const measure::Picture as_it_is = session_->frame(aside).read().display;
    made_ = std::make_shared<measure::Picture>(difference_picture(
        as_it_is,
        session::Access::render_frame(*session_, aside, {.ablated = state.cause}).read().display,
        static_cast<float>(state.gain)));
    return made_;
}

void SceneViewer::render_frame(const ViewState& state, uvec2 size, session::WindowOverlay overlay,
                               bool is_seen) {
    update_spec(state, size);
    measure_at_rest(state);
    const ShownPictures what = choose_shown_pictures(state);
    showing_ = {what.kind,
                what.first,
                what.second,
                static_cast<float>(state.divider * size.x),
                static_cast<float>(state.gain),
                nullptr,
                std::move(overlay)};
    if (needs_host_picture(state)) showing_.canvas = host_picture(state);
    if (!showing_.canvas) { // not made yet: show the plan's picture
        if (showing_.first == session::WindowPictures::kCanvasPicture) showing_.first = 0;
        if (showing_.second == session::WindowPictures::kCanvasPicture) showing_.second = 0;
    }
    collect_frames(kFramesInFlight - 1);
    const double begin = now_ms();
    session::Frame made = is_seen ? session::Access::show(*session_, spec_, *screen_, showing_)
                                  : session_->frame(spec_);
    TimeStatistics::FrameSample sample;
    if (is_seen)
        sample.acquire_ms = screen_->acquire_ms(), sample.present_ms = screen_->present_ms();
    sample.host_ms = now_ms() - begin - sample.acquire_ms - sample.present_ms;
    sample.interval_ms = frames_ > 0 ? begin - began_ : 0;
    began_ = begin;
    last_ = made;
    left_out_ = session::Access::rendered_model(made).left_out;
    capture_budget_ = made.capture_budget();
    pending_.push_back({std::move(made), std::move(sample)});
    ++frames_;
}

study::AuditState SceneViewer::audit_last_frame(study::PlanAudit& audit, double seconds) {
    if (!last_) return {};
    return audit.watch_frame(*session_, *last_, spec_, seconds);
}

std::uint32_t SceneViewer::mirror_at(uvec2 pixel) {
    if (frames_ == 0) return 0;
    collect_frames(0);
    const std::vector<std::uint32_t> hits = render_mirror_hits(*session_, spec_);
    const std::size_t at = std::size_t{pixel.y} * spec_.size.x + pixel.x;
    return at < hits.size() ? hits[at] & 0xFFFFU : 0;
}

void SceneViewer::write_picture(const std::filesystem::path& file) const {
    check(last_.has_value(), Failure::usage, "there is no frame yet to be written");
    if (file.extension() == ".exr") return measure::write_exr(last_->read(0).hdr, file);
    const auto picture = [&](std::size_t part) {
        return part == session::WindowPictures::kCanvasPicture ? *showing_.canvas
                                                               : last_->read(part).display;
    };
    measure::Picture shown = picture(showing_.first);
    if (showing_.kind == session::WindowPictures::Arrangement::difference)
        shown = difference_picture(shown, picture(showing_.second), showing_.gain);
    if (showing_.kind == session::WindowPictures::Arrangement::split) {
        const measure::Picture right = picture(showing_.second);
        for (int y = 0; y < shown.height; ++y)
            for (int x = static_cast<int>(showing_.divider); x < shown.width; ++x)
                shown.at(x, y) = right.at(x, y);
    }
    measure::write_png(shown, file);
}

} // namespace catoptric::view
