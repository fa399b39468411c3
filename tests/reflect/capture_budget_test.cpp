// Tests of the capture budget, under which a frame draws only some captures. The age of captures
// must be bounded, and a still scene must converge to full captures. Every capture must get its
// turn.
#include "scene/built_in.hpp"
#include "scene/shapes.hpp"
#include "session/access.hpp"
#include "support/drawn_hall.hpp"
#include "support/refusal.hpp"
#include "support/rendering.hpp"

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>

#include <cmath>
#include <set>

namespace {

using namespace catoptric;

constexpr uvec2 kSlicesPictureSize{64, 64};

/// Returns the number of frames within which each mirror has its turn.
std::uint32_t count_frames_per_turn(std::uint32_t mirrors, std::uint32_t most) {
    return (mirrors + most - 1) / most;
}

/// Returns the numbers of the mirrors whose captures the frame's passes drew.
std::set<int> list_drawn_mirrors(const session::FrameTimes& times) {
    std::set<int> mirrors;
    for (const session::PassTime& pass : times.passes)
        if (pass.name.starts_with("capture/") && !pass.name.ends_with(".clear"))
            mirrors.insert(std::stoi(pass.name.substr(8)));
    return mirrors;
}

scene::Scene make_coarse_room() {
    return test::replace_balls_by_coarse_balls(test::make_lit_room(3, 1));
}

session::FrameSpec
make_spec_with_capture_budget(const scene::Scene& scene, std::uint32_t most,
                              const std::string& technique = "parallax:face=32,shadow_map=64") {
    session::FrameSpec spec = test::make_test_request(scene, {technique}, kSlicesPictureSize);
    spec.model = session::RenderedWork::required;
    spec.most_captures = most;
    return spec;
}

/// Expects that the budget a frame reports agrees with its passes.
void expect_reported_budget(const session::Frame& frame, std::uint32_t most) {
    ASSERT_TRUE(frame.capture_budget());
    const session::CaptureBudget& capture_budget = *frame.capture_budget();
    EXPECT_EQ(list_drawn_mirrors(frame.times()).size(), capture_budget.drawn);
    EXPECT_EQ(capture_budget.most, std::min(most, capture_budget.mirrors));
    EXPECT_LT(capture_budget.longest, capture_budget.frames_per_cycle());
    EXPECT_EQ(frame.waiting(), capture_budget.waiting);
}

constexpr int kBallCellCount = 5;

/// Returns mirror balls, each in its own closed cell. The walls are visible only from inside their
/// cell, so no ball shows another. Each ball shows the light that its cell emits.
scene::Scene make_balls_in_cells() {
    scene::Scene scene{.name = "cells"};
    const std::size_t hot = add_material(scene,
                                         {.name = "hot", .front_only = true, .light = vec3(0)});
    const std::size_t mirror = add_material(scene, {.name = "mirror", .mirror = true});
    scene::Mesh walls{.name = "cells"};
    for (int i = 0; i < kBallCellCount; ++i)
        for (int face = 0; face < 6; ++face) {
            const scene::Mesh side = test::make_box_wall(face, {3. * i - 1.4, -1.4, -1.4},
                                                         {3. * i + 1.4, 1.4, 1.4});
            const auto first = static_cast<std::uint32_t>(walls.positions.size());
            walls.positions.insert(walls.positions.end(), side.positions.begin(),
                                   side.positions.end());
            walls.normals.insert(walls.normals.end(), side.normals.begin(), side.normals.end());
            for (const auto& triangle : side.triangles) walls.triangles.push_back(triangle + first);
        }
    test::add_mesh(scene, walls, hot);
    for (int i = 0; i < kBallCellCount; ++i)
        test::add_ball(scene, "ball" + std::to_string(i + 1), mirror, {3. * i, 0, 0}, 1);
    scene.cameras.push_back({.eye = {6, 0, -20}, .target = {6, 0, 0}, .vertical_fov_degrees = 50});
    return test::replace_balls_by_coarse_balls(std::move(scene));
}

// The cells emit the number of the frame as light. A ball's pixel therefore tells in which frame
// its capture was drawn.
TEST(CaptureBudget, NoCaptureIsOlderThanARound) {
    for (const std::uint32_t most : {1u, 2u, 3u}) {
        session::Session session(test::get_test_engine(), make_balls_in_cells());
        const session::FrameSpec spec = make_spec_with_capture_budget(
            session.scene(), most, "parallax:face=32,shadow=none");
        const int round = static_cast<int>(count_frames_per_turn(kBallCellCount, most));
        std::vector<int> oldest(kBallCellCount, 0);
        for (int k = 1; k <= 4 * round; ++k) {
            scene::Material hot = session.scene().materials[0];
            hot.emission = vec3(static_cast<float>(k));
            session.change(scene::set_material(0, hot));
            const session::Frame frame = session.frame(spec);
            expect_reported_budget(frame, most);
            const measure::Picture picture = frame.hdr();
            for (int i = 0; i < kBallCellCount; ++i) {
                const vec3 pixel = picture.at(32 + (i - 2) * 10, 32);
                const int age = k - static_cast<int>(std::round(pixel.x));
                EXPECT_NEAR(pixel.x, std::round(pixel.x), .01) << "of one frame";
                oldest[static_cast<std::size_t>(i)] = std::max(oldest[static_cast<std::size_t>(i)],
                                                               age);
            }
            EXPECT_EQ(list_drawn_mirrors(frame.times()).size(), k == 1 ? kBallCellCount : most);
        }
        EXPECT_THAT(oldest, testing::Each(testing::Le(round - 1))) << most;
        EXPECT_EQ(std::ranges::max(oldest), round - 1) << most;
    }
}

// With the knob `every`, captures take turns: that of mirror i, from 0, is drawn in the frames k
// for which k + i is a multiple of N, and the first frame draws all.
TEST(CaptureTurns, EachCaptureIsDrawnInItsTurn) {
    for (const session::RenderedWork model :
         {session::RenderedWork::everything, session::RenderedWork::required})
        for (const int every : {2, 3, 8}) {
            session::Session session(test::get_test_engine(), make_balls_in_cells());
            session::FrameSpec spec = make_spec_with_capture_budget(
                session.scene(), 0, "parallax:face=32,shadow=none,every=" + std::to_string(every));
            spec.model = model;
            std::vector<int> shown(kBallCellCount, 1);
            for (int k = 1; k <= 2 * every + 3; ++k) {
                scene::Material hot = session.scene().materials[0];
                hot.emission = vec3(static_cast<float>(k));
                session.change(scene::set_material(0, hot));
                const session::Frame frame = session.frame(spec);
                const measure::Picture picture = frame.hdr();
                std::set<int> turn;
                for (int i = 0; i < kBallCellCount; ++i) {
                    int& last = shown[static_cast<std::size_t>(i)];
                    if (k == 1 || (k + i) % every == 0) last = k, turn.insert(i + 1);
                    // The camera looks along +z, so the first ball is on the right.
                    EXPECT_NEAR(picture.at(32 + (2 - i) * 10, 32).x, last, .01)
                        << "mirror " << i + 1 << ", frame " << k << " of every=" << every;
                }
                EXPECT_EQ(list_drawn_mirrors(frame.times()), turn);
                ASSERT_TRUE(frame.capture_budget());
                EXPECT_EQ(frame.capture_budget()->drawn, turn.size());
                EXPECT_EQ(frame.capture_budget()->frames_per_cycle(), every);
            }
        }
}

// Captures that wait for their turn still show each other in the end.
TEST(CaptureTurns, StillSceneConvergesToFullCaptures) {
    const scene::Scene scene = make_coarse_room();
    const auto settle = [&](const char* technique, session::RenderedWork model) {
        session::Request request = test::make_test_request(scene, {technique}, kSlicesPictureSize);
        request.model = model;
        request.until_settled = true;
        request.warmup = 0, request.frames = 40;
        const session::RunResult ended = session::run(test::get_test_engine(), request);
        EXPECT_TRUE(ended.settled) << technique;
        return ended.parts.front().hdr;
    };
    const measure::Picture all = settle("parallax:face=32,shadow_map=64",
                                        session::RenderedWork::everything);
    const char* in_turns = "parallax:face=32,shadow_map=64,every=3";
    for (const session::RenderedWork model :
         {session::RenderedWork::required, session::RenderedWork::everything})
        EXPECT_TRUE(test::have_equal_pixel_bytes(settle(in_turns, model), all));
}

// Light probes are drawn in each frame, from captures of that frame.
TEST(CaptureTurns, LightProbesLeaveNoTurns) {
    const scene::Scene scene = make_coarse_room();
    const auto draw = [&](const std::string& knobs) {
        session::Request request = test::make_test_request(
            scene, {"parallax:face=32,shadow_map=64,indirect=captures,probes=27" + knobs},
            kSlicesPictureSize);
        request.warmup = 0, request.frames = 4;
        return session::run(test::get_test_engine(), request).parts.front();
    };
    const session::TechniqueResult in_turns = draw(",every=3");
    EXPECT_TRUE(test::have_equal_pixel_bytes(in_turns.hdr, draw("").hdr));
    EXPECT_THAT(in_turns.notes, testing::Contains(testing::HasSubstr("'every' has no effect")));
    EXPECT_FALSE(in_turns.capture_budget);
}

// A frame beside the sequence has the number of the next one, and leaves it nothing.
TEST(CaptureTurns, FramesAsideLeaveNoContents) {
    const auto draw = [](bool has_frames_aside) {
        session::Session session(test::get_test_engine(), scene::make_cornell());
        session::FrameSpec spec = test::make_test_request(
            session.scene(), {"pyramid:face=32,shadow_map=64,every=2"}, kSlicesPictureSize);
        std::vector<measure::Picture> pictures;
        for (int k = 0; k < 4; ++k) {
            spec.time = .25 * k;
            if (has_frames_aside)
                for (const double time : {1.5, 2.5}) {
                    session::FrameSpec aside = spec;
                    aside.time = time, aside.keeps_history = true;
                    session.frame(aside).hdr();
                }
            pictures.push_back(session.frame(spec).hdr());
        }
        return pictures;
    };
    const std::vector<measure::Picture> alone = draw(false), beside = draw(true);
    for (std::size_t k = 0; k < alone.size(); ++k)
        EXPECT_TRUE(test::have_equal_pixel_bytes(alone[k], beside[k])) << "frame " << k + 1;
}

// Under a budget, each bounce needs a round of frames instead of one frame.
TEST(CaptureBudget, StillSceneConvergesToFullCaptures) {
    for (const std::uint32_t most : {1u, 2u}) {
        const scene::Scene scene = make_coarse_room();
        session::Session all(test::get_test_engine(), scene), few(test::get_test_engine(), scene);
        const session::FrameSpec spec = make_spec_with_capture_budget(scene, most);
        session::FrameSpec everything = spec;
        everything.model = session::RenderedWork::everything, everything.most_captures = 0;
        const auto settle = [&] {
            std::vector<std::byte> state, next = session::Access::read_state(all.frame(everything));
            int bounces = 0;
            for (; state != next; ++bounces)
                state = std::move(next), next = session::Access::read_state(all.frame(everything));
            return bounces;
        };
        const auto follow = [&] {
            const int frames = settle() * static_cast<int>(count_frames_per_turn(3, most));
            for (int k = 1; k <= frames; ++k) {
                const session::Frame frame = few.frame(spec);
                expect_reported_budget(frame, most);
                EXPECT_LE(list_drawn_mirrors(frame.times()).size(),
                          session::Access::session_counters(few).frames == 1 ? 3 : most);
            }
            const session::Frame last = few.frame(spec);
            EXPECT_EQ(list_drawn_mirrors(last.times()), std::set<int>()) << "at rest";
            EXPECT_EQ(last.waiting(), 0u);
            EXPECT_TRUE(test::have_equal_pixel_bytes(last.hdr(), all.frame(everything).hdr()));
        };
        follow();
        const auto change = [&](const scene::Edit& edit) { all.change(edit), few.change(edit); };
        scene::Material lamp = scene.materials[3];
        lamp.emission *= .25f;
        change(scene::set_material(3, lamp));
        follow();
        dmat4 place = scene.objects.back().world_from_object;
        place[3].x -= .2;
        change(scene::move(scene.objects.size() - 1, place));
        follow();
    }
}

// Changes cameras and moves objects at random, faster than mirrors have their turns.
TEST(CaptureBudget, CapturesConvergeAfterRandomEvents) {
    for (const std::uint64_t seed : {3, 11}) {
        const scene::Scene hall = test::make_random_hall(seed, 4);
        session::Session all(test::get_test_engine(), hall), few(test::get_test_engine(), hall);
        session::FrameSpec spec = make_spec_with_capture_budget(hall, 1,
                                                                "parallax:face=16,shadow_map=64");
        test::RandomNumbers numbers(seed);
        const std::vector<std::size_t> mirrors = scene::mirrors(hall);
        for (int k = 0; k < 24; ++k) {
            if (k % 3 == 0) {
                const std::size_t mirror = mirrors[numbers.random_integer_below(mirrors.size())];
                const dvec3 place(hall.objects[mirror].world_from_object[3]);
                spec.camera = {.eye = place + dvec3(.3, .2, -1.7), .target = place};
            }
            const std::size_t moved = numbers.random_integer_below(hall.objects.size());
            dmat4 to = hall.objects[moved].world_from_object;
            to[3] += dvec4(dvec3(numbers.random_point_in_cube()) * .3, 0);
            for (session::Session* session : {&all, &few}) session->change(scene::move(moved, to));
            expect_reported_budget(few.frame(spec), 1);
        }
        constexpr int kBudgetRounds = 12;
        for (int k = 0; k < kBudgetRounds * 4; ++k) few.frame(spec);
        spec.model = session::RenderedWork::everything, spec.most_captures = 0;
        for (int k = 0; k < kBudgetRounds; ++k) all.frame(spec);
        const measure::Picture wanted = all.frame(spec).hdr();
        spec.model = session::RenderedWork::required, spec.most_captures = 1;
        const session::Frame last = few.frame(spec);
        EXPECT_TRUE(test::have_equal_pixel_bytes(last.hdr(), wanted)) << seed;
        EXPECT_EQ(list_drawn_mirrors(last.times()), std::set<int>()) << seed;
    }
}

// Something moves in every frame, so every capture always waits to be drawn.
TEST(CaptureBudget, EachMirrorIsDrawnWithinARound) {
    const scene::Scene scene = test::replace_balls_by_coarse_balls(scene::make_cornell());
    session::Session session(test::get_test_engine(), scene);
    session::FrameSpec spec = make_spec_with_capture_budget(scene, 1);
    std::vector<int> since(4, 0);
    for (int k = 1; k <= 14; ++k) {
        const session::Frame frame = session.frame(spec);
        expect_reported_budget(frame, 1);
        for (int& frames : since) ++frames;
        for (const int mirror : list_drawn_mirrors(frame.times()))
            since[static_cast<std::size_t>(mirror - 1)] = 0;
        EXPECT_THAT(since, testing::Each(testing::Lt(4))) << k;
        spec.time += 1 / 20.0;
    }
}

TEST(CaptureBudget, BudgetOfAllMirrorsChangesNothing) {
    const scene::Scene scene = test::replace_balls_by_coarse_balls(scene::make_cornell());
    session::Session one(test::get_test_engine(), scene), other(test::get_test_engine(), scene);
    for (int k = 0; k < 6; ++k) {
        session::FrameSpec spec = make_spec_with_capture_budget(scene, 4),
                           whole = make_spec_with_capture_budget(scene, 0);
        spec.time = whole.time = k < 4 ? k / 20.0 : .2;
        const session::Frame found = one.frame(spec), wanted = other.frame(whole);
        EXPECT_TRUE(test::have_equal_pixel_bytes(found.hdr(), wanted.hdr())) << k;
        EXPECT_EQ(list_drawn_mirrors(found.times()), list_drawn_mirrors(wanted.times())) << k;
        EXPECT_FALSE(wanted.capture_budget());
    }
}

// Tests budgets in milliseconds that are right on any device: nearly no time draws one mirror a
// frame, and very much time draws all mirrors.
TEST(CaptureBudget, BudgetInMillisecondsLimitsTheNumberOfMirrors) {
    const scene::Scene scene = make_coarse_room();
    session::Session little(test::get_test_engine(), scene), much(test::get_test_engine(), scene);
    session::FrameSpec spec = make_spec_with_capture_budget(scene, 0);
    for (int k = 1; k <= 5; ++k) {
        spec.ambient = .05 * k; // a change of the ambient light, so all captures must be drawn
        spec.budget_ms = 1e-6;
        const session::Frame frame = little.frame(spec);
        expect_reported_budget(frame, k == 1 ? 3 : 1);
        EXPECT_EQ(frame.capture_budget()->drawn, k == 1 ? 3u : 1u);
        session::FrameSpec aside = spec;
        aside.keeps_history = true;
        EXPECT_FALSE(little.frame(aside).capture_budget()) << "beside the sequence all are drawn";
        if (k == 3) { // the times measured before and after this other sequence still count
            session::FrameSequence sequence = session::Access::suspend(little);
            EXPECT_EQ(little.frame(spec).capture_budget()->drawn, 3u) << "the first of its own";
            session::Access::resume(little, std::move(sequence));
        }
        spec.budget_ms = 1e9;
        EXPECT_EQ(much.frame(spec).capture_budget()->drawn, 3u);
    }
}

TEST(CaptureBudget, PicturesDoNotDependOnFramesInFlight) {
    const scene::Scene scene = make_coarse_room();
    session::Session one(test::get_test_engine(), scene), more(test::get_test_engine(), scene, 3);
    for (int k = 0; k < 8; ++k) {
        session::FrameSpec spec = make_spec_with_capture_budget(scene, 1);
        spec.ambient = k < 3 ? .05 * (k + 1) : .2;
        const session::Frame wanted = one.frame(spec), found = more.frame(spec);
        EXPECT_TRUE(test::have_equal_pixel_bytes(found.hdr(), wanted.hdr())) << k;
    }
    // Without a budget, the captures that were put off are drawn.
    session::FrameSpec whole = make_spec_with_capture_budget(scene, 0);
    std::optional<session::Frame> wanted, found;
    for (int k = 0; k < 40; ++k) wanted = one.frame(whole), found = more.frame(whole);
    EXPECT_TRUE(test::have_equal_pixel_bytes(found->hdr(), wanted->hdr()));
    EXPECT_EQ(list_drawn_mirrors(found->times()), std::set<int>());
}

// A shell hides the first ball, which has the first turn, so that drawing its capture changes no
// visible pixel. The run must not end as settled then, because other captures still wait.
TEST(CaptureBudget, RunIsNotSettledWhileACaptureWaits) {
    scene::Scene scene = make_coarse_room();
    scene::Object shell = scene.objects[scene::mirrors(scene).front()];
    shell.name = "shell", shell.material = 0, shell.sphere.reset();
    shell.world_from_object = shell.world_from_object * glm::scale(dmat4(1), dvec3(1.05));
    scene.objects.push_back(shell);
    session::Request request = test::make_test_request(scene, {"parallax:face=32,shadow_map=64"},
                                                       kSlicesPictureSize);
    request.model = session::RenderedWork::required;
    request.frames = 28, request.until_settled = true;
    session::Session session(test::get_test_engine(), scene);
    const session::RunResult whole = session::run(session, request);
    request.most_captures = 1;
    const session::RunResult sliced = session::run(session, request);
    EXPECT_TRUE(whole.settled && sliced.settled);
    EXPECT_GT(sliced.frames.size(), whole.frames.size());
    EXPECT_TRUE(test::have_equal_pixel_bytes(sliced.parts.front().hdr, whole.parts.front().hdr));
    EXPECT_EQ(sliced.parts.front().capture_budget->waiting, 0u);
    request.frames = 1; // under a budget, one frame counts as a round of three
    EXPECT_EQ(session::run(session, request).frames.size(), 3u);
}

TEST(CaptureBudget, InvalidBudgetsAreRefused) {
    const scene::Scene scene = make_coarse_room();
    session::Session session(test::get_test_engine(), scene);
    const auto refused = [&](session::FrameSpec spec, const std::string& text) {
        test::expect_error([&] { session.frame(spec); }, Failure::usage, {text});
    };
    session::FrameSpec spec = make_spec_with_capture_budget(scene, 2);
    spec.model = session::RenderedWork::everything;
    refused(spec, "limits of captures (most_captures, budget_ms): wanted the model required");
    spec = make_spec_with_capture_budget(scene, 2);
    spec.budget_ms = 4;
    refused(spec, "limited by number (2) and by milliseconds (4): wanted one of them");
    spec = make_spec_with_capture_budget(scene, 0);
    for (const double ms : {-1., double{INFINITY}, double{NAN}}) {
        spec.budget_ms = ms;
        refused(spec, "the milliseconds for captures must be finite and above 0, not ");
    }
}

} // namespace
