// Properties of a mirror that jumps in each frame: its history settles once it rests.
#include "stress/property.hpp"
#include "stress/scenes.hpp"

#include <fmt/format.h>

namespace catoptric::stress {

namespace {

constexpr int kMoving = 6, kResting = 10; // numbers of frames
constexpr double kLampOfRoom = 6;         // brightest value of the room

/// Returns the room whose last ball moves `distance` away and back, twice a second.
scene::Scene with_motion(scene::Scene scene, double distance) {
    scene.objects.back().motion = scene::Harmonic{dvec3(-.6, .7, .4) * distance / 2.0, .5};
    return scene;
}

struct Seen {
    measure::Picture last;
    double brightest = 0; ///< of all frames; NaN if a pixel is not finite
};

/// Renders `moving` frames at instants far from whole periods, then `resting` frames at rest.
Seen watch(Bench& bench, const scene::Scene& scene, const std::string& technique, int moving,
           int resting) {
    app::Request request = bench.asked(scene, technique, 1);
    app::Session session(bench.engine(), scene);
    Seen seen;
    for (int k = 1 - moving; k <= resting; ++k) {
        request.time = k < 1 ? .17 * (1 - k) : 0;
        seen.last = bench.frame(session, request).hdr();
        const double most = brightest(seen.last);
        if (!(most <= seen.brightest)) seen.brightest = most;
    }
    return seen;
}

/// Judges one technique. If mirrors see each other, light travels on for some frames. Otherwise the
/// first frame at rest must be as if nothing had moved.
void judge_speed(Bench& bench, const scene::Scene& scene, int balls, const std::string& technique) {
    const int resting = technique == "raytrace" || balls == 1 ? 1 : kResting;
    const Seen wanted = watch(bench, scene, technique, 0, resting);
    for (const double distance : {1.0, 1e6}) {
        const Seen found = watch(bench, with_motion(scene, distance), technique, kMoving, resting);
        const std::string what = fmt::format("{} balls, {}, one goes {} a frame", balls, technique,
                                             distance);
        bench.add(what + ": brightest of the lamp", found.brightest / kLampOfRoom, 1.002);
        bench.add(
            fmt::format("{}: frame {} at rest, pixels unlike one that never moved", what, resting),
            double(different_pixels(found.last, wanted.last)), 0);
    }
}

void judge_speeds(Bench& bench) {
    for (const int balls : {1, 3}) {
        const scene::Scene scene = room(bench, balls);
        for (const std::string technique : {"raytrace", "reuse:face=64", "parallax:face=64",
                                            "pyramid:face=64", "layered:face=64"})
            judge_speed(bench, scene, balls, technique);
    }
}

const Registered kSpeed{{"T1", "a mirror that goes 1 and 1e6 units from frame to frame, and rests",
                         "finite, no brighter than the lamp, then as if it had never moved",
                         judge_speeds, "capture_stays_behind"}};

} // namespace

} // namespace catoptric::stress
