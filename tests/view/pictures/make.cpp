// Writes the pictures of docs/view.md: the window in each mode, as an X server without a screen
// shows it. Usage: catoptric_view_pictures FOLDER
#include "catoptric/program.hpp"
#include "core/error.hpp"
#include "measure/picture_file.hpp"
#include "shared.h"
#include "view/display.hpp"
#include "view/loop.hpp"

#include <functional>

namespace {

using namespace catoptric;
using namespace catoptric::view;

struct Shot {
    std::string name;
    std::size_t frames;
    std::function<void(State&)> set;
    uvec2 window{872, 512};
};

const std::vector<Shot> kShots{
    {"plan", 12, [](State& state) { state.said = ""; }, {872, 1000}},
    {"split", 8, [](State& state) { state.mode = Mode::split, state.other = plan_of("parallax"); }},
    {"difference", 6, [](State& state) { state.mode = Mode::difference, state.gain = 8; }},
    {"answers", 6, [](State& state) { state.mode = Mode::answers; }},
    {"numbers", 6, [](State& state) { state.mode = Mode::numbers; }},
    {"causes", 16,
     [](State& state) {
         state.mode = Mode::causes, state.cause = shared::kAblateTexels, state.gain = 16;
     }},
    {"reference", 24,
     [](State& state) {
         state.mode = Mode::split, state.against = Against::reference, state.judges = true;
     }},
    {"mirror", 8,
     [](State& state) {
         state.mode = Mode::plan, state.judges = false, state.chosen = 3;
         state.plan.own[3] = {"raytrace", {{"depth", "2"}}};
     }},
    {"keys", 4, [](State& state) { state.shows_keys = true; }},
};

int make(const std::filesystem::path& folder) {
    const test::Display display;
    check(display.is_there(), Failure::no_device, "Xvfb does not start: apt-get install xvfb");
    std::size_t shot = 0, last = kShots.front().frames;
    Driver driver;
    driver.before = [&](std::size_t, Inputs& inputs, State& state, Window& window) {
        inputs.on_controls = true; // ignores the mouse pointer of the X server
        kShots[shot].set(state);
        window.resize(kShots[shot].window);
    };
    driver.after = [&](const Report& report) {
        if (report.frame < last) return;
        ::usleep(500000); // waits until the X server has drawn
        const auto& [name, frames, set, size] = kShots[shot];
        measure::write_png(display.shown(static_cast<int>(size.x), static_cast<int>(size.y)),
                           folder / ("view-" + name + ".png"));
        if (++shot < kShots.size()) last += kShots[shot].frames;
    };
    std::size_t frames = 0;
    for (const Shot& one : kShots) frames += one.frames;
    return parse({"--frames", std::to_string(frames), "--time", "0.4"},
                 [&](const ViewOptions& options) { return run(options, driver); })();
}

} // namespace

int main(int argc, char** argv) {
    return cli::run_guarded("catoptric_view_pictures", [&] {
        check(argc == 2, Failure::usage, "wanted a folder for the pictures");
        return make(argv[1]);
    });
}
