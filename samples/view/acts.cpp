// What keys and buttons do.
#include "command.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "loop_impl.hpp"
#include "scene/camera_named.hpp"

#include <algorithm>
#include <filesystem>

namespace catoptric::view {

namespace {

/// As --camera takes it: in numbers, or the scene's own where numbers do not say all.
std::string camera_word(const scene::Scene& scene, const scene::Camera& camera) {
    const auto own = std::ranges::find(scene.cameras, camera);
    return own == scene.cameras.end() ? scene::camera_text(camera)
                                      : std::to_string(own - scene.cameras.begin());
}

/// "view-1.png", or the first number that is free.
std::filesystem::path free_name(const std::string& stem, const std::string& extension) {
    for (int i = 1;; ++i) {
        std::filesystem::path path = stem + "-" + std::to_string(i) + extension;
        if (!std::filesystem::exists(path)) return path;
    }
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

void Loop::act(const Key& key) {
    Motion& motion = state_.motion;
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
        const std::filesystem::path png = free_name("view", ".png");
        std::filesystem::path exr = png;
        viewer_->write(png);
        viewer_->write(exr.replace_extension(".exr"));
        say("written: " + png.string() + ", " + exr.string());
    }
    if (wants.saves_plan) {
        const std::filesystem::path file = free_name("view-plan", ".json");
        write_file(file, json_of(resolved(state_.plan, entries_)));
        say("written: " + file.string());
    }
} catch (const Error& error) {
    if (!viewer_->engine().usable()) throw;
    say(error.what());
}

/// Another scene in place of this one; where it cannot be read, this one stays.
void Loop::load(const std::string& file) try {
    Options other = options_;
    other.common.scene = file;
    other.common.wishes = {};
    other.words = {file};
    app::Request request = ask(other).request;
    viewer_.reset(); // refers to the request
    options_ = std::move(other);
    request_ = std::move(request);
    state_.plan.own.clear(), state_.other.own.clear();
    open(Scene::another);
    say("loaded: " + file);
} catch (const Error& error) {
    if (!viewer_) throw;
    say(error.what());
}

} // namespace catoptric::view
