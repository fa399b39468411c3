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

struct DocumentedScreenshot {
    std::string name;
    std::size_t frames;
    std::function<void(ViewState&)> set;
    uvec2 window{872, 512};
};

const std::vector<DocumentedScreenshot> kDocumentedScreenshots{
    {"plan", 12, [](ViewState& state) { state.said = ""; }, {872, 1000}},
    {"split", 8,
     [](ViewState& state) { state.mode = ViewMode::split, state.other = parse_plan("parallax"); }},
    {"difference", 6, [](ViewState& state) { state.mode = ViewMode::difference, state.gain = 8; }},
    {"answers", 6, [](ViewState& state) { state.mode = ViewMode::answers; }},
    {"numbers", 6, [](ViewState& state) { state.mode = ViewMode::numbers; }},
    {"causes", 16,
     [](ViewState& state) {
         state.mode = ViewMode::causes, state.cause = shared::kAblateTexelColour, state.gain = 16;
     }},
    {"reference", 24,
     [](ViewState& state) {
         state.mode = ViewMode::split, state.against = ComparisonPicture::reference,
         state.judges = true;
     }},
    {"mirror", 8,
     [](ViewState& state) {
         state.mode = ViewMode::plan, state.judges = false, state.chosen = 3;
         state.plan.own[3] = {"raytrace", {{"depth", "2"}}};
     }},
    {"keys", 4, [](ViewState& state) { state.shows_keys = true; }},
};

int make_documentation_pictures(const std::filesystem::path& folder) {
    const test::VirtualDisplay display;
    check(display.is_display_running(), Failure::no_device,
          "Xvfb does not start: apt-get install xvfb");
    std::size_t shot = 0, last = kDocumentedScreenshots.front().frames;
    SimulatedUser driver;
    driver.before = [&](std::size_t, UserInput& inputs, ViewState& state, ViewWindow& window) {
        inputs.on_controls = true; // ignores the mouse pointer of the X server
        kDocumentedScreenshots[shot].set(state);
        window.resize(kDocumentedScreenshots[shot].window);
    };
    driver.after = [&](const ViewReport& report) {
        if (report.frame < last) return;
        ::usleep(500000); // waits until the X server has drawn
        const auto& [name, frames, set, size] = kDocumentedScreenshots[shot];
        measure::write_png(
            display.read_screen_pixels(static_cast<int>(size.x), static_cast<int>(size.y)),
            folder / ("view-" + name + ".png"));
        if (++shot < kDocumentedScreenshots.size()) last += kDocumentedScreenshots[shot].frames;
    };
    std::size_t frames = 0;
    for (const DocumentedScreenshot& one : kDocumentedScreenshots) frames += one.frames;
    return parse_view_command(
        {"--frames", std::to_string(frames), "--time", "0.4"},
        [&](const ViewOptions& options) { return run_window(options, driver); })();
}

} // namespace

int main(int argc, char** argv) {
    return cli::run_catching("catoptric_view_pictures", [&] {
        check(argc == 2, Failure::usage, "wanted a folder for the pictures");
        return make_documentation_pictures(argv[1]);
    });
}
