// Properties of pictures whose camera is inside a mirror
// (docs/notes/ADR-007-views-and-flat-mirrors.md). Mirrors have two sides, so no light from outside
// reaches the inside of a closed mirror.
#include "stress/property.hpp"
#include "stress/scenes.hpp"

#include "measure/flip.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace catoptric::stress {

namespace {

struct TestedEyePosition {
    const char* what;
    scene::Camera camera;
    bool inside;
};

void judge_eye_positions(Bench& bench, const scene::Scene& scene, const scene::Sphere& ball) {
    const dvec3 out = normalize(dvec3(.3, .4, .8)), along = normalize(cross(out, dvec3(0, 1, 0)));
    const auto eye = [&](double radii, const dvec3& direction) {
        const dvec3 place = ball.centre + radii * ball.radius * out;
        return scene::Camera{.eye = place, .target = place + direction, .vertical_fov_degrees = 60};
    };
    const TestedEyePosition places[] = {
        {"at the centre", eye(0, out), true},
        {"halfway out", eye(.5, out), true},
        {"just under the surface, looking along it", eye(.99, along), true},
        {"on the surface, looking away", eye(1, out), false},
        {"on the surface, looking along it", eye(1, along), false},
        {"on the surface, looking at it", eye(1, -out), false}};
    for (const TestedEyePosition& place : places) {
        const auto render = [&](const std::string& technique) {
            session::Request request = bench.make_request(scene, technique);
            request.size = bench.size_at_least(64);
            request.camera = place.camera;
            return bench.render_technique(request);
        };
        const session::TechniqueResult traced = render("raytrace:depth=16");
        if (place.inside)
            bench.add_case(fmt::format("{}, raytrace: brightest of 0", place.what),
                           brightest_channel(traced.hdr), 0);
        // The correction by one distance fails where a ball fills the picture and something stands
        // before the wall that it reflects.
        const session::TechniqueResult corrected = render("parallax");
        bench.add_flip(fmt::format("{}, parallax", place.what), corrected, traced, .03,
                       place.inside ? ""
                                    : "a ball close to the camera shows what stands before "
                                      "its walls in the wrong place; searches correct it");
        for (const std::string technique : {"pyramid", "hybrid"})
            bench.add_flip(fmt::format("{}, {}", place.what, technique), render(technique), traced,
                           .03);
        const session::TechniqueResult plain = render("reuse");
        if (place.inside) bench.add_flip(fmt::format("{}, reuse", place.what), plain, traced, .03);
        // From outside, a look-up without parallax correction is wrong for every camera, and most
        // wrong if the ball fills the picture.
        else {
            const auto error = [&](const session::TechniqueResult& part) {
                return measure::flip_mean(measure::flip(part.display, traced.display));
            };
            bench.add_warning(
                fmt::format("{}, reuse", place.what), error(plain), .05,
                "a ball close to the camera shows the room as from its own centre, so that "
                "reflections stand in the wrong place; parallax and later searches correct it");
            // The correction may fail, but then no worse than none.
            bench.add_case(
                fmt::format("{}, parallax: FLIP above both .03 and that of reuse", place.what),
                std::max(0.0, error(corrected) - std::max(.03, error(plain))), .002);
        }
    }
}

/// Judges a ball that moves over the camera. A frame must be black exactly while the camera is
/// inside the ball.
void judge_ball_over_eye(Bench& bench, scene::Scene scene) {
    constexpr int kSettlingFrames = 16;
    scene::Object& object = scene.objects.back();
    // The ball and the camera on its way stay in the room, whose middle is 0.
    const double reach = (object.sphere->centre.x > 0 ? -3 : 3) * object.sphere->radius;
    object.motion = scene::HarmonicMotion{dvec3(reach, 0, 0) / 2.0, 1};
    scene::Camera camera{.eye = object.sphere->centre + dvec3(reach / 2, 0, 0)};
    camera.target = camera.eye + dvec3(0, 0, 1);
    for (const std::string technique : {"raytrace", "parallax"}) {
        session::Request request = bench.make_request(scene, bench.fit_captures(technique),
                                                      kSettlingFrames);
        request.camera = camera;
        session::Session session(bench.bench_engine(), scene);
        int wrong = 0, inside = 0;
        for (int k = 0; k < kSettlingFrames; ++k) {
            request.time = double(k) / kSettlingFrames;
            const session::Frame frame = bench.render_frame(session, request);
            const scene::Scene now = scene::scene_at(scene, request.time);
            const double depth = 1 - length(camera.eye - now.objects.back().sphere->centre) /
                                         object.sphere->radius;
            if (std::abs(depth) < .01) continue; // the eye is between the mesh and its sphere
            inside += depth > 0;
            wrong += (brightest_channel(frame.hdr()) == 0) != (depth > 0);
        }
        bench.add_case(
            fmt::format(
                "a ball moves over the eye, {}: frames that are black outside or lit inside",
                technique),
            wrong, 0);
        bench.add_case(
            fmt::format("a ball moves over the eye, {}: too few frames inside or outside",
                        technique),
            inside < 4 || inside > kSettlingFrames - 4 ? 1 : 0, 0);
    }
}

void judge_eye_inside_mirror(Bench& bench) {
    const scene::Scene scene = make_room(bench, 2);
    judge_eye_positions(bench, scene, *scene.objects.back().sphere);
    judge_ball_over_eye(bench, scene);
}

const RegisteredProperty kEyeInsideMirrorProperty{
    {"C5", "camera inside a ball, at its centre, touching it; a ball moves over it",
     "a closed mirror is black from inside, in both worlds (FLIP)", judge_eye_inside_mirror,
     "mirrors_one_sided",
     "things inside with the eye: ray tracing also shows their images in the wall around them"}};

} // namespace

} // namespace catoptric::stress
