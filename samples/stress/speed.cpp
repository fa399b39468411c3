// Stress properties of a mirror that jumps a large distance in each frame. After the mirror rests,
// the picture must not depend on its motion.
#include "stress/property.hpp"
#include "stress/scenes.hpp"

#include <fmt/format.h>

namespace catoptric::stress {

namespace {

constexpr int kMovingCameraFrames = 6, kRestingCameraFrames = 10;
constexpr double kBrightestRoomValue = 6;

/// Returns the room with a motion of its last ball, which moves by `distance` and back, twice a
/// second.
scene::Scene add_ball_motion(scene::Scene scene, double distance) {
    scene.objects.back().motion = scene::HarmonicMotion{dvec3(-.6, .7, .4) * distance / 2.0, .5};
    return scene;
}

struct CameraMotionMeasurement {
    measure::Picture last;
    double brightest = 0; ///< brightest channel of all frames; NaN if a pixel is not finite
};

/// Renders `moving` frames at instants far from whole periods, then `resting` frames at rest.
CameraMotionMeasurement measure_motion(Bench& bench, const scene::Scene& scene,
                                       const std::string& technique, int moving, int resting) {
    session::Request request = bench.make_request(scene, bench.fit_captures(technique), 1);
    session::Session session(bench.bench_engine(), scene);
    CameraMotionMeasurement seen;
    for (int k = 1 - moving; k <= resting; ++k) {
        request.time = k < 1 ? .17 * (1 - k) : 0;
        seen.last = bench.render_frame(session, request).hdr();
        const double most = brightest_channel(seen.last);
        if (!(most <= seen.brightest)) seen.brightest = most;
    }
    return seen;
}

/// Judges one technique. If mirrors see each other, light of earlier positions remains for some
/// frames. Otherwise the first frame at rest must equal the picture of a ball that never moved.
void judge_speed(Bench& bench, const scene::Scene& scene, int balls, const std::string& technique) {
    const int resting = technique == "raytrace" || balls == 1 ? 1 : kRestingCameraFrames;
    const CameraMotionMeasurement wanted = measure_motion(bench, scene, technique, 0, resting);
    for (const double distance : {1.0, 1e6}) {
        const CameraMotionMeasurement found = measure_motion(
            bench, add_ball_motion(scene, distance), technique, kMovingCameraFrames, resting);
        const std::string what = fmt::format("{} balls, {}, one goes {} a frame", balls, technique,
                                             distance);
        bench.add_case(what + ": brightest of the lamp", found.brightest / kBrightestRoomValue,
                       1.002);
        bench.add_case(
            fmt::format("{}: frame {} at rest, pixels unlike one that never moved", what, resting),
            double(count_different(found.last, wanted.last)), 0);
    }
}

void judge_moving_mirror(Bench& bench) {
    for (const int balls : {1, 3}) {
        const scene::Scene scene = make_room(bench, balls);
        for (const std::string technique : {"raytrace", "reuse:face=64", "parallax:face=64",
                                            "pyramid:face=64", "layered:face=64"})
            judge_speed(bench, scene, balls, technique);
    }
}

const RegisteredProperty kMovingMirrorProperty{
    {"T1", "a mirror that goes 1 and 1e6 units from frame to frame, and rests",
     "finite, no brighter than the lamp, then as if it had never moved", judge_moving_mirror,
     "capture_stays_behind"}};

} // namespace

} // namespace catoptric::stress
