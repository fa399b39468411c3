// Actions of keys and buttons.
#include "command.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "loop_impl.hpp"
#include "scene/camera_named.hpp"

#include <algorithm>
#include <filesystem>

namespace catoptric::view {

namespace {

/// Returns the camera as text for --camera: numbers, or the scene's own camera if numbers do not
/// describe it fully. The scene's camera is given by a unique name, because a scene file may order
/// cameras otherwise.
std::string camera_option(const scene::Scene& scene, const scene::Camera& camera) {
    std::string text = scene::format_camera(camera);
    try {
        scene::Camera typed = scene::find_camera(text, {});
        typed.name = camera.name;
        if (typed == camera) return text;
    } catch (const Error&) { // the numbers are outside the range of --camera
    }
    const auto own = std::ranges::find(scene.cameras, camera);
    if (own == scene.cameras.end()) return text;
    const bool is_known = !own->name.empty() &&
                          std::ranges::count(scene.cameras, own->name, &scene::Camera::name) == 1;
    return is_known ? own->name : std::to_string(own - scene.cameras.begin());
}

/// Returns "view-1", or the first such name for which no file with any of the extensions exists.
std::filesystem::path find_free_name(const std::string& stem,
                                     const std::vector<std::string>& extensions) {
    for (int i = 1;; ++i) {
        const std::string name = stem + "-" + std::to_string(i);
        const auto exists = [&](const std::string& extension) {
            std::error_code error; // errors are reported when the file is written
            return std::filesystem::exists(name + extension, error);
        };
        if (std::ranges::none_of(extensions, exists)) return name;
    }
}

/// Returns the plan without the settings for single mirrors, because another scene has other
/// mirrors.
EditedPlan remove_mirror_settings(EditedPlan plan) {
    plan.own.clear();
    return plan.typed.empty() || plan.typed == "auto" ? plan : EditedPlan{};
}

} // namespace

void ViewLoop::show_message(const std::string& text) {
    state_.said = text;
    cli::print_note(options_.common.output_options, text);
}

std::string ViewLoop::command() const {
    std::vector<std::string> words = options_.words;
    const std::vector<std::string> roughness = roughness_words(request_.scene, state_.roughness);
    words.insert(std::ranges::find(words, "--"), roughness.begin(), roughness.end());
    return render_command(words, state_, camera_option(request_.scene, state_.camera),
                          viewer_->make_frame_spec().size);
}

void ViewLoop::select_camera(std::size_t index) {
    const std::vector<scene::Camera>& cameras = request_.scene.cameras;
    if (!cameras.empty()) state_.camera = cameras[index % cameras.size()];
}

void ViewLoop::perform(const KeyBinding& key) {
    ScenePlayback& motion = state_.motion;
    const std::vector<scene::Camera>& cameras = request_.scene.cameras;
    switch (key.act) {
    case KeyAction::keys: state_.shows_keys ^= true; break;
    case KeyAction::panels: state_.shows_panels ^= true; break;
    case KeyAction::pause: motion.plays ^= true; break;
    case KeyAction::step: motion.plays = false, motion.time += kFrameStepSeconds; break;
    case KeyAction::back: motion.plays = false, motion.time -= kFrameStepSeconds; break;
    case KeyAction::fly: state_.flies ^= true; break;
    case KeyAction::gain: state_.gain = state_.gain >= 64 ? 1 : 2 * state_.gain; break;
    case KeyAction::mode: state_.mode = static_cast<ViewMode>(key.mode); break;
    case KeyAction::quit: ends_ = true; break;
    case KeyAction::copy: perform_requests({.copies = true}); break;
    case KeyAction::picture: perform_requests({.writes = true}); break;
    case KeyAction::save_plan: perform_requests({.saves_plan = true}); break;
    case KeyAction::cut: perform_requests({.cuts = true}); break;
    case KeyAction::against:
        state_.against = state_.against == ComparisonPicture::other ? ComparisonPicture::reference
                                                                    : ComparisonPicture::other;
        break;
    case KeyAction::model:
        state_.model = state_.model == session::RenderedWork::required
                           ? session::RenderedWork::everything
                           : session::RenderedWork::required;
        break;
    case KeyAction::camera:
        select_camera(
            static_cast<std::size_t>(std::ranges::find(cameras, state_.camera) - cameras.begin()) +
            1);
        break;
    }
}

void ViewLoop::perform_requests(const PanelRequests& requests) try {
    if (requests.cuts) viewer_->discard_history();
    if (requests.camera) select_camera(*requests.camera);
    if (requests.copies) {
        window_.copy_to_clipboard(command());
        show_message("copied: " + command());
    }
    if (requests.writes) {
        const std::string name = find_free_name("view", {".png", ".exr"});
        viewer_->write_picture(name + ".png");
        viewer_->write_picture(name + ".exr");
        show_message("written: " + name + ".png, " + name + ".exr");
    }
    if (requests.saves_plan) {
        const EditedPlan plan = resolve_plan(state_.plan, entries_);
        check(plan.typed.empty(), Failure::usage, "a plan is saved once it was drawn");
        const std::string file = find_free_name("view-plan", {".json"}).string() + ".json";
        write_file(file, plan_to_json(plan));
        show_message("written: " + file);
    }
} catch (const Error& error) {
    if (!viewer_->viewer_engine().usable()) throw;
    show_message(error.what());
}

/// Loads another scene in place of this one. If the scene cannot be read or does not fit the
/// device, the current scene stays.
void ViewLoop::load(const std::string& file) {
    const ViewOptions options = options_;
    const session::Request request = request_;
    const ViewState state = state_;
    try {
        const cli::CommonOptions defaults;
        cli::CommonOptions& common = options_.common;
        common.scene = file, common.overrides = {};
        common.root = defaults.root, common.seed = defaults.seed;
        common.use_scene_file = defaults.use_scene_file;
        options_.words = {file};
        options_.audit.clear(); // the certificate of the plan is for the earlier scene
        for (const auto& [option, value] : {std::pair{"--device", common.device.name},
                                            {"--device-profile", common.device.profile}})
            if (!value.empty()) options_.words.insert(options_.words.end(), {option, value});
        request_ = resolve_view_request(options_).request;
        state_.plan = remove_mirror_settings(state_.plan),
        state_.other = remove_mirror_settings(state_.other);
        state_.roughness.clear();
        open(SceneChangeOrigin::another);
        start_audit();
        show_message("loaded: " + file);
    } catch (const Error& error) {
        const bool is_open = viewer_ != nullptr && viewer_->viewer_engine().usable();
        options_ = options, request_ = request, state_ = state;
        if (!is_open) open(SceneChangeOrigin::same);
        show_message(error.what());
    }
}

} // namespace catoptric::view
