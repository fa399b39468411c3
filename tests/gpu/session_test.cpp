// Tests of scenes that stay on the device. After any change the next frame must equal that of a new
// session with the changed scene. No memory or work may accumulate.
#include "import/load.hpp"
#include "scene/built_in.hpp"
#include "session/access.hpp"
#include "session/run.hpp"
#include "support/refusal.hpp"
#include "support/rendering.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <random>

namespace {

using namespace catoptric;

constexpr uvec2 kSessionPictureSize{48, 40};

double milliseconds_since_begin(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
        .count();
}

session::FrameSpec make_frame_spec(const scene::Scene& scene, const std::string& technique) {
    return test::make_test_request(scene, {technique}, kSessionPictureSize);
}

/// Makes random changes of everything that a session allows to change.
class RandomSceneChanger {
public:
    explicit RandomSceneChanger(std::uint64_t seed) : random_(seed) {}

    double random_number(double low, double high) {
        return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1p-53;
    }
    std::size_t random_index(std::size_t count) { return random_() % count; }
    vec3 random_colour() {
        return vec3(random_number(0, 1), random_number(0, 1), random_number(0, 1));
    }

    scene::Edit make_random_edit(const scene::Scene& scene) {
        const std::size_t object = random_index(scene.objects.size());
        const std::size_t material = random_index(scene.materials.size());
        switch (random_index(4)) {
        case 0:
            return scene::move(object,
                               move_placement_randomly(scene.objects[object].world_from_object));
        case 1: return scene::paint(object, material);
        case 2: {
            scene::Material value = scene.materials[material];
            value.albedo = random_colour();
            value.reflectance = random_colour();
            return scene::set_material(material, value);
        }
        default: {
            scene::Material value = scene.materials[material];
            if (value.emission != vec3(0))
                value.emission *= static_cast<float>(random_number(.1, 3));
            value.mirror = value.emission == vec3(0) && random_index(2) == 0;
            return scene::set_material(material, value);
        }
        }
    }

    void change_camera_randomly(scene::Camera& camera) {
        camera.eye += dvec3(random_number(-.2, .2), random_number(-.2, .2), random_number(-.2, .2));
    }

private:
    dmat4 move_placement_randomly(dmat4 place) {
        place = glm::rotate(place, random_number(-1, 1),
                            dvec3(random_number(-1, 1), 1, random_number(-1, 1)));
        place[3] += dvec4(random_number(-.4, .4), random_number(-.4, .4), random_number(-.4, .4),
                          0);
        return place;
    }
    std::mt19937_64 random_;
};

TEST(Session, ChangedSceneEqualsAFreshSession) {
    RandomSceneChanger draw(11);
    // Test a scene with motion too, because a session copies such a scene and moves its objects for
    // each instant.
    for (const auto& [technique, moves] : {std::pair{std::string("pyramid:face=16"), false},
                                           {"raytrace", false},
                                           {"raytrace", true}}) {
        scene::Scene at_rest = test::make_lit_room(3, 2);
        if (moves) at_rest.objects.back().motion = scene::HarmonicMotion{.amplitude = {.1, 0, 0}};
        session::Session session(test::get_test_engine(), at_rest);
        session::FrameSpec spec = make_frame_spec(at_rest, technique);
        measure::Picture before = session.frame(spec).hdr();
        int seen = 0;
        for (int change = 0; change < 20; ++change) {
            session.change(draw.make_random_edit(session.scene()));
            if (change % 4 == 3) draw.change_camera_randomly(spec.camera);
            session.forget();
            session::Session fresh(test::get_test_engine(), session.scene());
            for (int k = 1; k <= 2; ++k) {
                const measure::Picture found = session.frame(spec).hdr();
                ASSERT_TRUE(test::have_equal_pixel_bytes(found, fresh.frame(spec).hdr()))
                    << technique << ", change " << change << ", frame " << k;
                seen += !test::have_equal_pixel_bytes(found, before);
                before = found;
            }
        }
        EXPECT_GT(seen, 10) << "changes must show";
    }
}

TEST(Session, RaysHitEachObjectWhereItWasMoved) {
    const scene::Scene at_rest = test::make_lit_room(3, 2);
    const session::FrameSpec spec = make_frame_spec(at_rest, "raytrace");
    session::Session session(test::get_test_engine(), at_rest);
    measure::Picture before = session.frame(spec).hdr();
    for (const std::size_t back : {1, 2, 3, 2}) {
        const std::size_t object = at_rest.objects.size() - back;
        dmat4 place = session.scene().objects[object].world_from_object;
        place[3].y += .3;
        session.change(scene::move(object, place));
        const measure::Picture found = session.frame(spec).hdr();
        EXPECT_FALSE(test::have_equal_pixel_bytes(found, before)) << "it is in sight";
        session::Session fresh(test::get_test_engine(), session.scene());
        EXPECT_TRUE(test::have_equal_pixel_bytes(found, fresh.frame(spec).hdr())) << object;
        before = found;
    }
}

TEST(Session, HistorySurvivesAChangeAndEndsAtACut) {
    const scene::Scene scene = test::make_lit_room(3, 1);
    const session::FrameSpec spec = make_frame_spec(scene, "reuse:face=16");
    session::Session session(test::get_test_engine(), scene);
    const measure::Picture first = session.frame(spec).hdr(), second = session.frame(spec).hdr();
    EXPECT_FALSE(test::have_equal_pixel_bytes(first, second))
        << "mirrors in mirrors are black at first";
    // This edit changes nothing.
    session.change(scene::set_material(0, session.scene().materials[0]));
    EXPECT_FALSE(test::have_equal_pixel_bytes(session.frame(spec).hdr(), first))
        << "history was lost";
    session.forget();
    EXPECT_TRUE(test::have_equal_pixel_bytes(session.frame(spec).hdr(), first));
}

/// Several sequences of frames take turns in one session. Each sequence must show the same pictures
/// as when it runs alone.
TEST(Session, ResumedSequenceContinues) {
    const scene::Scene scene = test::make_lit_room(3, 1);
    session::Session session(test::get_test_engine(), scene), alone(test::get_test_engine(), scene);
    const std::string techniques[] = {"reuse:face=16", "reuse:face=auto", "raytrace"};
    std::vector<session::FrameSequence> aside;
    for (int k = 1; k <= 4; ++k)
        for (std::size_t i = 0; i < 3; ++i) {
            const session::FrameSpec spec = make_frame_spec(scene, techniques[i]);
            if (k > 1) session::Access::resume(session, std::move(aside[i]));
            const measure::Picture found = session.frame(spec).hdr();
            if (k > 1)
                aside[i] = session::Access::suspend(session);
            else
                aside.push_back(session::Access::suspend(session));
            alone.forget();
            measure::Picture wanted;
            for (int frame = 1; frame <= k; ++frame) wanted = alone.frame(spec).hdr();
            EXPECT_TRUE(test::have_equal_pixel_bytes(found, wanted))
                << techniques[i] << ", frame " << k;
        }
    const session::FrameSpec spec = make_frame_spec(scene, techniques[0]);
    alone.forget();
    EXPECT_TRUE(test::have_equal_pixel_bytes(session.frame(spec).hdr(), alone.frame(spec).hdr()))
        << "without one that goes on, a frame begins without history";
}

TEST(Session, WatcherIsToldOfEveryFrameAndCanStop) {
    session::Request request = test::make_test_request(scene::make_cornell(), {"reuse:face=16"},
                                                       kSessionPictureSize);
    request.warmup = 2, request.frames = 3;
    session::Session session(test::get_test_engine(), request.scene);
    std::vector<std::pair<int, int>> told;
    std::atomic<int> stop = 0;
    const session::Watcher watcher{
        .on_frame = [&](int number, int count) { told.emplace_back(number, count); },
        .stop = &stop};
    session::run(session, request, watcher);
    EXPECT_EQ(told, (std::vector<std::pair<int, int>>{{1, 5}, {2, 5}, {3, 5}, {4, 5}, {5, 5}}));
    for (const auto& [signal, failure] :
         {std::pair(1, Failure::hangup), {2, Failure::interrupted}, {15, Failure::terminated}}) {
        stop = signal;
        told.clear();
        test::expect_error([&] { session::run(session, request, watcher); }, failure,
                           {"stopped by signal " + std::to_string(signal)});
        EXPECT_TRUE(told.empty());
    }
}

/// A capture in other scene units cannot serve as history.
TEST(Session, SequenceInOtherSceneUnitsLosesItsHistory) {
    const scene::Scene scene = test::make_lit_room(3, 1);
    const session::FrameSpec spec = make_frame_spec(scene, "reuse:face=16");
    session::Session session(test::get_test_engine(), scene);
    session.frame(spec), session.frame(spec);
    session::FrameSequence sequence = session::Access::suspend(session);
    dmat4 far = scene.objects.back().world_from_object;
    far[3] += dvec4(20, 0, 0, 0); // far enough to change the scene units
    session.change(scene::move(scene.objects.size() - 1, far));
    session::Access::resume(session, std::move(sequence));
    session::Session fresh(test::get_test_engine(), session.scene());
    EXPECT_TRUE(test::have_equal_pixel_bytes(session.frame(spec).hdr(), fresh.frame(spec).hdr()));
}

TEST(Session, FrameOfAnotherTechniqueDropsHistoryUnlessMarkedToKeepIt) {
    const scene::Scene scene = test::make_lit_room(3, 1);
    const session::FrameSpec spec = make_frame_spec(scene, "reuse:face=16");
    session::FrameSpec aside = make_frame_spec(scene, "raytrace");
    aside.keeps_history = true;
    session::Session session(test::get_test_engine(), scene), alone(test::get_test_engine(), scene);
    const measure::Picture first = alone.frame(spec).hdr(), second = alone.frame(spec).hdr();
    EXPECT_TRUE(test::have_equal_pixel_bytes(session.frame(spec).hdr(), first));
    session.frame(aside);
    EXPECT_TRUE(test::have_equal_pixel_bytes(session.frame(spec).hdr(), second));
    aside.keeps_history = false;
    session.frame(aside);
    EXPECT_TRUE(test::have_equal_pixel_bytes(session.frame(spec).hdr(), first))
        << "another began in between";
}

TEST(Session, StillFramesWriteNothing) {
    const scene::Scene scene = test::make_lit_room(2, 1);
    session::FrameSpec spec = make_frame_spec(scene, "reuse:face=16");
    session::Session session(test::get_test_engine(), scene);
    for (int k = 0; k < 5; ++k) session.frame(spec);
    EXPECT_EQ(session::Access::session_counters(session).frames, 5u);
    EXPECT_EQ(session::Access::session_counters(session).updates, 1u);
    spec.camera.eye.x += .1;
    session.frame(spec);
    EXPECT_EQ(session::Access::session_counters(session).updates, 2u);
}

TEST(Session, FrameCanBeReadUntilTheNextFrame) {
    const scene::Scene scene = test::make_lit_room(1, 1);
    const session::FrameSpec spec = make_frame_spec(scene, "reuse:face=16");
    session::Session session(test::get_test_engine(), scene);
    const session::Frame old = session.frame(spec);
    old.hdr(), old.times();
    session.frame(spec);
    EXPECT_GT(old.times().gpu_ms, 0) << "times stay";
    test::expect_error([&] { old.hdr(); }, Failure::internal, {"frame 1", "frame 2"});
}

TEST(Session, InvalidEditsAndFramesAreRefused) {
    const scene::Scene scene = test::make_lit_room(1, 1);
    session::Session session(test::get_test_engine(), scene);
    const session::FrameSpec spec = make_frame_spec(scene, "reuse:face=16");
    const std::string objects = std::to_string(scene.objects.size());
    test::expect_error([&] { session.change(scene::move(999, dmat4(1))); }, Failure::usage,
                       {"object 999", objects});
    test::expect_error([&] { session.change(scene::paint(0, 999)); }, Failure::usage,
                       {"material 999", std::to_string(scene.materials.size())});
    test::expect_error([&] { session.change(scene::move(0, dmat4(0))); }, Failure::usage,
                       {scene.objects[0].name, "affine transform with an inverse"});
    session::FrameSpec none = spec;
    none.size = {0, 4};
    test::expect_error([&] { session.frame(none); }, Failure::usage, {"at least 1x1", "0x4"});
    none = spec, none.techniques = {};
    test::expect_error([&] { session.frame(none); }, Failure::usage, {"no technique"});
    session::Session untouched(test::get_test_engine(), scene);
    EXPECT_TRUE(
        test::have_equal_pixel_bytes(session.frame(spec).hdr(), untouched.frame(spec).hdr()));
}

TEST(Session, PicturesDoNotDependOnFramesInFlight) {
    const scene::Scene scene = test::make_lit_room(3, 1);
    std::vector<std::vector<measure::Picture>> seen;
    for (const std::uint32_t in_flight : {1u, 2u, 3u}) {
        session::Session session(test::get_test_engine(), scene, in_flight);
        std::vector<session::Frame> frames;
        std::vector<measure::Picture>& pictures = seen.emplace_back();
        for (int k = 0; k < 9; ++k) {
            session::FrameSpec spec = make_frame_spec(scene, "parallax:face=16");
            spec.time = .1 * k;
            spec.camera.eye.x += .02 * (k / 2);
            frames.push_back(session.frame(spec));
            if (frames.size() < in_flight) continue;
            pictures.push_back(frames.front().hdr()); // the oldest frame that can still be read
            frames.erase(frames.begin());
        }
        for (const session::Frame& frame : frames) pictures.push_back(frame.hdr());
    }
    ASSERT_EQ(seen[0].size(), 9u);
    for (std::size_t k = 0; k < 9; ++k)
        for (std::size_t i : {1, 2})
            EXPECT_TRUE(test::have_equal_pixel_bytes(seen[i][k], seen[0][k])) << k;
    test::expect_error([&] { session::Session(test::get_test_engine(), scene, 4); }, Failure::usage,
                       {"1 to 3", "4"});
}

TEST(Session, TechniquesShareTheSceneAndItsHierarchy) {
    const scene::Scene scene = scene::make_cornell();
    session::Session session(test::get_test_engine(), scene);
    std::uint64_t uploads = 0;
    for (const std::string technique : {"reuse:face=16", "raytrace", "hybrid:face=16"}) {
        session.forget();
        for (int k = 0; k < 3; ++k) session.frame(make_frame_spec(scene, technique));
        const session::SessionCounters counts = session::Access::session_counters(session);
        EXPECT_EQ(counts.hierarchies_built, technique == "reuse:face=16" ? 0u : 1u);
        EXPECT_EQ(counts.hierarchies_refitted, 0u);
        if (technique == "hybrid:face=16") {
            EXPECT_EQ(counts.uploads, uploads) << "all is there";
        }
        uploads = counts.uploads;
    }
}

TEST(Session, OnlyTracingTechniquesRefitTrees) {
    const scene::Scene scene = scene::make_cornell(); // a scene with a moving ball
    for (const std::string technique : {"parallax:face=16", "raytrace"}) {
        session::Session session(test::get_test_engine(), scene);
        for (int k = 0; k < 5; ++k) {
            session::FrameSpec spec = make_frame_spec(scene, technique);
            spec.time = .1 * k;
            session.frame(spec);
        }
        const session::SessionCounters counts = session::Access::session_counters(session);
        const bool traces = technique == "raytrace";
        EXPECT_EQ(counts.hierarchies_built, traces ? 1u : 0u);
        EXPECT_EQ(counts.hierarchies_refitted, traces ? 4u : 0u);
    }
}

/// Tests that the host's work time excludes the time from submit to the end of the frame. The sum
/// of both may not exceed the whole frame's duration.
TEST(Session, WaitingTimeIsNotHostWork) {
    const scene::Scene scene = scene::make_cornell();
    session::Session session(test::get_test_engine(), scene);
    session::FrameSpec spec = make_frame_spec(scene, "raytrace:samples=4");
    spec.size = {256, 256};
    for (int k = 0; k < 4; ++k) {
        spec.time = .1 * k;
        const auto begin = std::chrono::steady_clock::now();
        const session::FrameTimes times = session.frame(spec).times();
        const double all = milliseconds_since_begin(begin);
        EXPECT_GT(times.host.sum(), 0);
        EXPECT_LE(times.host.sum() + times.wall_ms, all);
        EXPECT_LE(times.frame_ms(), all);
        EXPECT_GT(times.wait_ms, 0);
        EXPECT_LE(times.wait_ms, times.wall_ms) << "it begins after the submit";
        EXPECT_EQ(times.frame_ms(), times.host.sum() + times.gpu_ms);
    }
}

/// If a caller asks for times after the frame has ended, the call does not wait. A new frame waits
/// for an older frame if all slots are in use.
TEST(Session, FrameWaitsOnlyForUnfinishedFrames) {
    const scene::Scene scene = scene::make_cornell();
    session::FrameSpec spec = make_frame_spec(scene, "raytrace");
    spec.size = {256, 256};
    session::Session two(test::get_test_engine(), scene, 2), one(test::get_test_engine(), scene);
    int ended = 0, taken = 0;
    // Try several times, because other processes may use the processor at any time.
    for (int k = 0; k < 5; ++k) {
        const session::Frame first = two.frame(spec), second = two.frame(spec);
        second.times();
        ended += first.times().wait_ms < first.times().gpu_ms;
        one.frame(spec);
        const session::FrameTimes times = one.frame(spec).times();
        taken += times.wait_ms > times.wall_ms;
        EXPECT_LT(times.host.sum(), times.wait_ms);
    }
    EXPECT_GT(ended, 0);
    EXPECT_GT(taken, 0);
}

TEST(Session, SetupReportsTheTimesOfOneTimeWork) {
    const scene::Scene scene = test::make_lit_room(2, 1);
    const auto begin = std::chrono::steady_clock::now();
    session::Session session(test::get_test_engine(), scene);
    EXPECT_EQ(session::Access::setup_times(session).upload_ms, 0)
        << "nothing is written before the first frame";
    session.frame(make_frame_spec(scene, "reuse:face=16"));
    const session::SetupTimes raster = session::Access::setup_times(session);
    EXPECT_GT(raster.upload_ms, 0);
    EXPECT_EQ(raster.hierarchy_ms, 0) << "nobody has traced";
    session.frame(make_frame_spec(scene, "raytrace"));
    const session::SetupTimes traced = session::Access::setup_times(session);
    EXPECT_GT(traced.hierarchy_ms, 0);
    EXPECT_GT(traced.upload_ms, raster.upload_ms) << "the trees' way to the device";
    EXPECT_LE(traced.upload_ms + traced.hierarchy_ms, milliseconds_since_begin(begin));
    const std::size_t ball = scene::mirrors(scene).front();
    dmat4 place = scene.objects[ball].world_from_object;
    place[3].x += .1;
    session.change(scene::move(ball, place));
    session::FrameSpec spec = make_frame_spec(scene, "raytrace");
    spec.camera.eye.x += .1;
    session.frame(spec);
    EXPECT_EQ(session::Access::setup_times(session).upload_ms, traced.upload_ms) << "once";
    EXPECT_EQ(session::Access::setup_times(session).hierarchy_ms, traced.hierarchy_ms);
}

TEST(Session, EngineCompilesEachPipelineOnce) {
    const scene::Scene scene = test::make_lit_room(1, 1);
    const auto begin = std::chrono::steady_clock::now();
    session::Engine engine({.device = test::read_wanted_device_name()});
    EXPECT_EQ(session::Access::compiled_pipelines(engine).pipelines, 0u);
    EXPECT_EQ(session::Access::pipeline_cache_state(engine), session::PipelineCacheState::none);
    const session::FrameSpec spec = make_frame_spec(scene, "raytrace:depth=1");
    session::Session(engine, scene).frame(spec).times();
    const session::CompiledPipelines once = session::Access::compiled_pipelines(engine);
    EXPECT_GT(once.pipelines, 0u);
    EXPECT_GT(once.ms, 0);
    EXPECT_LE(once.ms, milliseconds_since_begin(begin));
    session::Session(engine, scene).frame(spec).times();
    EXPECT_EQ(session::Access::compiled_pipelines(engine).pipelines, once.pipelines);
    EXPECT_EQ(session::Access::compiled_pipelines(engine).ms, once.ms);
    session::Session(engine, scene).frame(make_frame_spec(scene, "naive:bounces=0")).times();
    EXPECT_GT(session::Access::compiled_pipelines(engine).pipelines, once.pipelines);
    EXPECT_GT(session::Access::compiled_pipelines(engine).ms, once.ms);
}

TEST(Session, ChangeOfSceneUnitsWaitsForFramesInFlight) {
    scene::Scene scene = test::make_lit_room(2, 1);
    session::Session session(test::get_test_engine(), scene, 3);
    session::FrameSpec spec = make_frame_spec(scene, "raytrace:samples=4");
    spec.size = {128, 128};
    for (int k = 0; k < 4; ++k) { // move the ball so far away that the scene units change
        dmat4 place = session.scene().objects.back().world_from_object;
        place[3] += dvec4(20 + 100 * k, 0, 0, 0);
        const session::Frame before = session.frame(spec);
        session.change(scene::move(scene.objects.size() - 1, place));
        const measure::Picture found = session.frame(spec).hdr();
        session::Session fresh(test::get_test_engine(), session.scene());
        EXPECT_TRUE(test::have_equal_pixel_bytes(found, fresh.frame(spec).hdr())) << k;
    }
}

TEST(Session, GraphOfAShapeIsPlannedOnce) {
    const scene::Scene scene = test::make_lit_room(2, 1);
    session::Session session(test::get_test_engine(), scene);
    session::FrameSpec spec = make_frame_spec(scene, "reuse:face=16");
    for (int k = 0; k < 6; ++k) {
        spec.camera.eye.x += .01;
        session.frame(spec);
    }
    EXPECT_EQ(session::Access::session_counters(session).plans, 1u) << "with history and without";
    spec.size.x += 8;
    session.frame(spec);
    EXPECT_EQ(session::Access::session_counters(session).plans, 2u);
}

} // namespace
