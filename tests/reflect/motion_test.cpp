// Tests of animations: frame k shows the scene (k - 1) / 60 s after the start.
#include "scene/build.hpp"
#include "scene/built_in.hpp"
#include "session/frames.hpp"
#include "support/rendering.hpp"

namespace {

using namespace catoptric;

TEST(Motion, LastFrameOfAnAnimationEqualsAStillOfItsInstant) {
    // These techniques have no history, so the last frame of an animation must equal a still
    // picture of the same instant.
    for (const char* technique : {"naive:bounces=1,face=64", "raytrace"}) {
        session::Request moving = test::make_test_request(scene::make_cornell(), {technique},
                                                          {64, 64});
        moving.animate = true, moving.time = .5, moving.warmup = 3, moving.frames = 4;
        session::Request still = test::make_test_request(scene::make_cornell(), {technique},
                                                         {64, 64});
        still.time = .5 + 6 / 60.0;
        const measure::Picture last =
            session::run(test::get_test_engine(), moving).parts.front().hdr;
        EXPECT_TRUE(test::have_equal_pixel_bytes(
            last, session::run(test::get_test_engine(), still).parts.front().hdr))
            << technique;
        still.time = .5;
        EXPECT_FALSE(test::have_equal_pixel_bytes(
            last, session::run(test::get_test_engine(), still).parts.front().hdr))
            << technique;
    }
}

TEST(Motion, FramesWithoutAnimationAreEqual) {
    session::Request request = test::make_test_request(scene::make_cornell(),
                                                       {"naive:bounces=1,face=64"}, {64, 64});
    const measure::Picture one = session::run(test::get_test_engine(), request).parts.front().hdr;
    request.frames = 5;
    EXPECT_TRUE(test::have_equal_pixel_bytes(
        one, session::run(test::get_test_engine(), request).parts.front().hdr));
}

TEST(Motion, SessionShowsInstantsInAnyOrder) {
    const session::Request still = test::make_test_request(scene::make_cornell(),
                                                           {"naive:bounces=1,face=64"}, {64, 64});
    session::Session session(test::get_test_engine(), still.scene);
    std::vector<measure::Picture> seen;
    for (const double time : {1.5, .5, 1.5}) {
        session::FrameSpec spec = still;
        spec.time = time;
        seen.push_back(session.frame(spec).hdr());
    }
    session::Request half = still;
    half.time = .5;
    EXPECT_TRUE(test::have_equal_pixel_bytes(
        seen[1], session::run(test::get_test_engine(), half).parts.front().hdr));
    EXPECT_FALSE(test::have_equal_pixel_bytes(seen[1], seen[2]));
    EXPECT_TRUE(test::have_equal_pixel_bytes(seen[0], seen[2]));
}

TEST(Motion, FramesAreNumberedFromOne) {
    session::Request request = test::make_test_request(test::make_lit_room(2, 1), {"reuse:face=32"},
                                                       {32, 32});
    request.warmup = 1, request.frames = 3;
    session::Session session(test::get_test_engine(), request.scene);
    session::FrameLoop frames(session, request);
    for (int k = 1; k <= 4; ++k) {
        ASSERT_TRUE(frames.render_next());
        EXPECT_EQ(frames.frame_number(), k);
    }
    EXPECT_FALSE(frames.render_next());
    const session::RunResult result = frames.result();
    EXPECT_EQ(result.frames.size(), 3u) << "the measured ones of four";
    EXPECT_TRUE(test::have_equal_pixel_bytes(
        result.parts.front().hdr,
        test::render_technique(test::make_lit_room(2, 1), "reuse:face=32", {32, 32}, 4).hdr));
}

// The BVH keeps only one of many copies in one place. A copy that moves away must be added to the
// BVH.
TEST(Motion, CopyThatLeavesItsPlaceIsSeen) {
    scene::Scene scene{.name = "copies"};
    const std::size_t lamp = test::add_material(scene, {.name = "glow", .emission = vec3(.5F)});
    test::add_quad(scene, "copy", lamp, {-.5, -.5, 0}, {.5, -.5, 0}, {.5, .5, 0}, {-.5, .5, 0});
    for (int i = 1; i < 40; ++i) scene.objects.push_back(scene.objects.front());
    scene.cameras.push_back({.eye = {0, 0, 4}, .target = {0, 0, 0}});
    session::Request still = test::make_test_request(scene, {"raytrace"}, {48, 48});
    dmat4 there(1);
    there[3] = {.8, .4, 0, 1};
    for (const std::size_t leaves : {0U, 7U, 39U}) {
        session::Session session(test::get_test_engine(), scene);
        const measure::Picture before = session.frame(still).hdr();
        session.change(scene::move(leaves, there));
        const measure::Picture after = session.frame(still).hdr();
        EXPECT_FALSE(test::have_equal_pixel_bytes(before, after)) << leaves;
        session::Session fresh(test::get_test_engine(), session.scene());
        EXPECT_TRUE(test::have_equal_pixel_bytes(after, fresh.frame(still).hdr())) << leaves;
    }
}

TEST(Samples, OnlyIrregularSampleCountsDependOnTheSeed) {
    for (const auto& [samples, depends] : {std::pair{"4", false}, {"5", true}}) {
        session::Request request = test::make_test_request(
            test::make_lit_room(1, 1), {std::string("raytrace:samples=") + samples}, {48, 48});
        const measure::Picture first =
            session::run(test::get_test_engine(), request).parts.front().hdr;
        request.seed = 2;
        EXPECT_EQ(test::have_equal_pixel_bytes(
                      first, session::run(test::get_test_engine(), request).parts.front().hdr),
                  !depends)
            << samples;
    }
}

} // namespace
