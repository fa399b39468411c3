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
std::string camera_word(const scene::Scene& scene, const scene::Camera& camera) {
    std::string text = scene::camera_text(camera);
    try {
        scene::Camera typed = scene::camera_named(text, {});
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
std::filesystem::path free_name(const std::string& stem,
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

/// Returns the part of a plan that fits another scene: nothing about single mirrors.
PlanState without_mirrors(PlanState plan) {
    plan.own.clear();
    return plan.typed.empty() || plan.typed == "auto" ? plan : PlanState{};
}

} // namespace

void Loop::say(const std::string& text) {
    state_.said = text;
    cli::note(options_.common.manners, text);
}

std::string Loop::command() const {
    return render_command(options_.words, state_, camera_word(request_.scene, state_.camera),
                          viewer_->spec().size);
}

void Loop::next_camera(std::size_t index) {
    const std::vector<scene::Camera>& cameras = request_.scene.cameras;
    if (!cameras.empty()) state_.camera = cameras[index % cameras.size()];
}

void Loop::act(const KeyBinding& key) {
    Playback& motion = state_.motion;
    const std::vector<scene::Camera>& cameras = request_.scene.cameras;
    switch (key.act) {
    case Act::keys: state_.shows_keys ^= true; break;
    case Act::panels: state_.shows_panels ^= true; break;
    case Act::pause: motion.plays ^= true; break;
    case Act::step: motion.plays = false, motion.time += kStep; break;
    case Act::back: motion.plays = false, motion.time -= kStep; break;
    case Act::fly: state_.flies ^= true; break;
    case Act::gain: state_.gain = state_.gain >= 64 ? 1 : 2 * state_.gain; break;
    case Act::mode: state_.mode = static_cast<Mode>(key.mode); break;
    case Act::quit: ends_ = true; break;
    case Act::copy: carry_out({.copies = true}); break;
    case Act::picture: carry_out({.writes = true}); break;
    case Act::save_plan: carry_out({.saves_plan = true}); break;
    case Act::cut: carry_out({.cuts = true}); break;
    case Act::against:
        state_.against = state_.against == Against::other ? Against::reference : Against::other;
        break;
    case Act::model:
        state_.model = state_.model == app::Modelling::required ? app::Modelling::everything
                                                                : app::Modelling::required;
        break;
    case Act::camera:
        next_camera(
            static_cast<std::size_t>(std::ranges::find(cameras, state_.camera) - cameras.begin()) +
            1);
        break;
    }
}

void Loop::carry_out(const Wants& wants) try {
    if (wants.cuts) viewer_->cut();
    if (wants.camera) next_camera(*wants.camera);
    if (wants.copies) {
        window_.copy(command());
        say("copied: " + command());
    }
    if (wants.writes) {
        const std::string name = free_name("view", {".png", ".exr"});
        viewer_->write(name + ".png");
        viewer_->write(name + ".exr");
        say("written: " + name + ".png, " + name + ".exr");
    }
    if (wants.saves_plan) {
        const PlanState plan = resolved(state_.plan, entries_);
        check(plan.typed.empty(), Failure::usage, "a plan is saved once it was drawn");
        const std::string file = free_name("view-plan", {".json"}).string() + ".json";
        write_file(file, json_of(plan));
        say("written: " + file);
    }
} catch (const Error& error) {
    if (!viewer_->engine().usable()) throw;
    say(error.what());
}

/// Loads another scene in place of this one. If the scene cannot be read or does not fit the
/// device, the current scene stays.
void Loop::load(const std::string& file) {
    const ViewOptions options = options_;
    const app::Request request = request_;
    const State state = state_;
    try {
        const cli::Common defaults;
        cli::Common& common = options_.common;
        common.scene = file, common.overrides = {};
        common.root = defaults.root, common.seed = defaults.seed;
        common.use_scene_file = defaults.use_scene_file;
        options_.words = {file};
        for (const auto& [option, value] : {std::pair{"--device", common.device.name},
                                            {"--device-profile", common.device.profile}})
            if (!value.empty()) options_.words.insert(options_.words.end(), {option, value});
        request_ = ask(options_).request;
        state_.plan = without_mirrors(state_.plan), state_.other = without_mirrors(state_.other);
        open(SceneOrigin::another);
        say("loaded: " + file);
    } catch (const Error& error) {
        const bool is_open = viewer_ != nullptr && viewer_->engine().usable();
        options_ = options, request_ = request, state_ = state;
        if (!is_open) open(SceneOrigin::same);
        say(error.what());
    }
}

} // namespace catoptric::view
