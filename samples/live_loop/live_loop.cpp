// A loop as a game or a viewer has it: two frames under way, a ball that is moved, a camera that
// walks around, what is seen read back at the end. Only what the picture requires is rendered.
#include <catoptric/error.hpp>
#include <catoptric/picture.hpp>
#include <catoptric/scene.hpp>
#include <catoptric/session.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <deque>

using namespace catoptric;

namespace {

scene::Camera turn_camera_along_path(scene::Camera camera, double turn) {
    const dvec3 arm = camera.eye - camera.target;
    camera.eye = camera.target + dvec3(std::cos(turn) * arm.x + std::sin(turn) * arm.z, arm.y,
                                       std::cos(turn) * arm.z - std::sin(turn) * arm.x);
    return camera;
}

void run_live_loop(app::Engine& engine, int frames) {
    app::Session session(engine, scene::load("cornell-mirrors"), 2);
    const scene::Camera camera = session.scene().cameras.front();
    const std::size_t ball = scene::mirrors(session.scene()).front();
    const dmat4 rest = session.scene().objects[ball].world_from_object;

    std::deque<app::Frame> under_way;
    double host_ms = 0, gpu_ms = 0;
    const auto finish_oldest = [&] { // waits for the device
        const app::FrameTimes& times = under_way.front().times();
        host_ms += times.host.sum(), gpu_ms += times.gpu_ms;
        under_way.pop_front();
    };
    for (int k = 0; k < frames; ++k) {
        dmat4 place = rest;
        place[3].y += 10 * std::sin(.2 * k); // as high as the scene's units have it
        session.change(scene::move(ball, place));
        under_way.push_back(session.frame({.techniques = {"parallax:face=64"},
                                           .camera = turn_camera_along_path(camera, .005 * k),
                                           .size = {160, 160},
                                           .model = app::RenderedWork::required}));
        if (under_way.size() == 2) finish_oldest();
    }
    measure::write_png(measure::to_display(under_way.back().hdr()), "live.png");
    while (!under_way.empty()) finish_oldest();
    std::printf("%d frames: host %.2f ms, device %.2f ms each\n", frames, host_ms / frames,
                gpu_ms / frames);
}

} // namespace

int main() try {
    for (int attempt = 0;; ++attempt) try {
            app::Engine engine({});
            run_live_loop(engine, 30);
            std::fflush(stdout);
            if (app::has_abandoned_device()) std::_Exit(0); // a lost device's driver may be at work
            return 0;
        } catch (const DeviceLost& error) { // start again, once
            if (attempt > 0) throw;
            std::fprintf(stderr, "live_loop: %s\n", error.what());
        }
} catch (const std::exception& error) {
    std::fprintf(stderr, "live_loop: %s\n", error.what());
    return 1;
}
