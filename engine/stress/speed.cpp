// A mirror that is somewhere else in every frame: what is remembered of it settles once it rests.
#include "stress/property.hpp"
#include "stress/scenes.hpp"

#include "measure/flip.hpp"
#include "scene/load.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace catoptric::stress {

namespace {

constexpr int kMoving = 6, kSoon = 4, kResting = 20; // frames
constexpr double kLampOfRoom = 6;                    // the brightest there is in it

/// The room whose last ball goes `distance` away, and back, twice a second.
scene::Scene with_motion(scene::Scene scene, double distance) {
    scene.objects.back().motion = scene::Harmonic{dvec3(-.6, .7, .4) * distance / 2.0, .5};
    return scene;
}

/// Frames of a session of its own: number k from 1 after `moving` at other instants; each is given
/// to `look`.
void watch(Bench& bench, const scene::Scene& scene, const std::string& technique, int moving,
           int resting, const std::function<void(int k, const app::Frame&)>& look) {
    app::Request request = bench.asked(scene, technique, 1);
    app::Session session(bench.engine(), scene);
    for (int k = 1 - moving; k <= resting; ++k) {
        request.time = k < 1 ? .17 * (1 - k) : 0; // far from whole periods
        look(k, bench.frame(session, request));
    }
}

void judge_speed(Bench& bench, const scene::Scene& scene, int balls, double distance,
                 const std::string& technique) {
    measure::Picture wanted, soon, shown;
    const int resting = technique == "raytrace" || balls == 1 ? 1 : kResting;
    watch(bench, scene, technique, 0, resting, [&](int k, const app::Frame& frame) {
        if (k == resting) wanted = frame.read().display, shown = frame.hdr();
    });
    double brightest_moving = 0;
    const std::string what = fmt::format("{} balls, {}, one goes {} a frame", balls, technique,
                                         distance);
    watch(bench, with_motion(scene, distance), technique, kMoving, resting,
          [&](int k, const app::Frame& frame) {
              const measure::Picture hdr = frame.hdr();
              const double most = brightest(hdr);
              if (!(most <= brightest_moving)) brightest_moving = most;
              if (k == kSoon) soon = frame.read().display;
              if (k == resting)
                  bench.add(fmt::format("{}: frame {} at rest, pixels unlike one that never moved",
                                        what, k),
                            double(different_pixels(hdr, shown)), 0);
          });
    bench.add(what + ": brightest of the lamp", brightest_moving / kLampOfRoom, 1.002);
    if (resting > kSoon)
        bench.add(fmt::format("{}: frame {} at rest (FLIP)", what, kSoon),
                  measure::flip_mean(measure::flip(soon, wanted)), .001);
}

void judge_speeds(Bench& bench) {
    for (const int balls : {1, 3}) {
        const scene::Scene scene = room(bench, balls);
        for (const double distance : {1.0, 1e6})
            for (const std::string technique : {"raytrace", "reuse:face=64", "parallax:face=64",
                                                "pyramid:face=64", "layered:face=64"})
                judge_speed(bench, scene, balls, distance, technique);
    }
}

const Registered kSpeed{{"T1", "a mirror that goes 1 and 1e6 units from frame to frame, and rests",
                         "finite, no brighter than the lamp, then as if it had never moved",
                         judge_speeds, "moved_only_while_moving"}};

} // namespace

} // namespace catoptric::stress
