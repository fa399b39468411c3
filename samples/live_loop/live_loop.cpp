// A loop as a game or a viewer has it: two frames under way, a ball that is moved, a camera that
// walks around. With `--audit PLAN.json`, the plan of `catoptric choose` is audited in the loop.
#include <catoptric/compare.hpp>
#include <catoptric/scene.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <deque>

using namespace catoptric;

namespace {

scene::Camera turn_camera(scene::Camera camera, double turn) {
    const dvec3 arm = camera.eye - camera.target;
    camera.eye = camera.target + dvec3(std::cos(turn) * arm.x + std::sin(turn) * arm.z, arm.y,
                                       std::cos(turn) * arm.z - std::sin(turn) * arm.x);
    return camera;
}

void run_live_loop(session::Engine& engine, const char* plan_file) {
    session::Session session(engine, scene::load("cornell-mirrors"), 2);
    const scene::Camera camera = session.scene().cameras.front();
    const std::size_t ball = scene::mirrors(session.scene()).front();
    const dmat4 rest = session.scene().objects[ball].world_from_object;
    std::deque<session::Frame> under_way;
    double host_ms = 0, gpu_ms = 0;
    const auto finish_frames = [&](std::size_t most) { // waits for the device
        for (; under_way.size() > most; under_way.pop_front()) {
            const session::FrameTimes& times = under_way.front().times();
            host_ms += times.host.sum(), gpu_ms += times.gpu_ms;
        }
    };
    session::FrameSpec spec{.techniques = {"parallax:face=64"},
                            .size = {160, 160},
                            .model = session::RenderedWork::required};
    std::optional<study::PlanAudit> audit;
    if (plan_file != nullptr)
        audit.emplace(plan_file, study::AuditOptions{.every = 4, // often, because the loop is short
                                                     .most_time = 100,
                                                     .before_audit = [&] { finish_frames(0); }});
    const int frames = audit ? 90 : 30;
    for (int k = 0; k < frames; ++k) {
        dmat4 place = rest;
        place[3].y += 10 * std::sin(.2 * k); // as high as the scene's units have it
        session.change(scene::move(ball, place));
        spec.camera = turn_camera(camera, .005 * k);
        if (audit) spec.techniques = {audit->plan()};
        const session::Frame frame = under_way.emplace_back(session.frame(spec));
        finish_frames(1);
        if (audit && k + 1 < frames) audit->watch_frame(session, frame, spec, k / 60.0);
    }
    measure::write_png(measure::to_display(under_way.back().hdr()), "live.png");
    finish_frames(0);
    std::printf("%d frames: host %.2f ms, device %.2f ms each\n", frames, host_ms / frames,
                gpu_ms / frames);
    if (audit) std::printf("%s\n", audit->describe().c_str());
}

} // namespace

int main(int argc, char** argv) try {
    if (argc != 1 && (argc != 3 || argv[1] != std::string("--audit")))
        throw UsageError("wanted no option, or --audit PLAN.json");
    for (int attempt = 0;; ++attempt) try {
            session::Engine engine({});
            run_live_loop(engine, argc == 3 ? argv[2] : nullptr);
            std::fflush(stdout);
            if (session::has_abandoned_device())
                std::_Exit(0); // a lost device's driver may be at work
            return 0;
        } catch (const DeviceLost& error) { // start again, once
            if (attempt > 0) throw;
            std::fprintf(stderr, "live_loop: %s\n", error.what());
        }
} catch (const std::exception& error) {
    std::fprintf(stderr, "live_loop: %s\n", error.what());
    return 1;
}
