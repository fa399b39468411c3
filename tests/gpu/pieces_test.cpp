// Tests of frames in pieces (graph/frame_pieces.hpp): no piece holds more rays than its bound, the
// pictures stay the same, and the work stops between two pieces.
#include "core/watch.hpp"
#include "graph/frame_pieces.hpp"
#include "scene/built_in.hpp"
#include "scene/classify.hpp"
#include "session/access.hpp"
#include "session/watcher.hpp"
#include "session/work.hpp"
#include "support/rendering.hpp"

#include <algorithm>
#include <atomic>
#include <utility>

namespace {

using namespace catoptric;

constexpr uvec2 kPiecesPictureSize{48, 40};
constexpr std::uint64_t kUnlimitedRays = std::uint64_t{1} << 40;

session::Request make_rough_request(const std::string& technique) {
    scene::Scene scene = scene::make_rough_cornell();
    scene::find_mirrors(scene);
    return test::make_test_request(std::move(scene), {technique}, kPiecesPictureSize);
}

/// Renders a frame and returns its picture. `told`: gets the arguments of each on_piece.
measure::Picture render_in_pieces(const std::string& technique, std::uint64_t most_rays,
                                  std::vector<std::pair<std::uint64_t, std::uint64_t>>& told) {
    const session::Request request = make_rough_request(technique);
    session::Session session(test::get_test_engine(), request.scene);
    const WorkWatch watch{
        .on_piece = [&](std::uint64_t done, std::uint64_t all) { told.emplace_back(done, all); },
        .most_rays = most_rays};
    const WatchScope scope(&watch);
    const session::Frame frame = session.frame(request);
    EXPECT_EQ(
        frame.times().passes.size(),
        static_cast<std::size_t>(std::ranges::count_if(
            frame.times().passes, [](const session::PassTime& pass) { return pass.ms() >= 0; })))
        << "the times of pieces must not overlap";
    return frame.hdr();
}

class FramePiecesOf : public testing::TestWithParam<const char*> {};

TEST_P(FramePiecesOf, HoldNoMoreRaysThanTheBoundAndKeepThePicture) {
    std::vector<std::pair<std::uint64_t, std::uint64_t>> whole, told;
    const measure::Picture expected = render_in_pieces(GetParam(), kUnlimitedRays, whole);
    EXPECT_TRUE(whole.empty());
    for (const std::uint64_t most : {std::uint64_t{640}, std::uint64_t{1900}}) {
        told.clear();
        EXPECT_TRUE(
            test::have_equal_pixel_bytes(render_in_pieces(GetParam(), most, told), expected));
        ASSERT_FALSE(told.empty());
        std::uint64_t before = 0;
        for (const auto& [done, all] : told) {
            EXPECT_LE(done - before, most) << "rays between two looks at the signal";
            EXPECT_LE(done, all);
            before = done;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Techniques, FramePiecesOf,
                         testing::Values("raytrace:rays=6", "raytrace:samples=5,rays=2",
                                         "raytrace:depth=2", "raytrace:rays=4,first=raster",
                                         "raytrace:rays=3,indirect=paths",
                                         "hybrid:face=32,rays=4,force=unknown"));

TEST(FramePieces, HoldAtMost32768RaysOnAProcessor) {
    if (!test::get_test_device().device.is_cpu()) GTEST_SKIP() << "the device is no cpu";
    std::vector<std::pair<std::uint64_t, std::uint64_t>> told;
    render_in_pieces("raytrace:depth=1,rays=40", 0, told);
    ASSERT_FALSE(told.empty());
    std::uint64_t before = 0;
    for (const auto& [done, all] : told) {
        EXPECT_LE(done - before, std::uint64_t{1} << 15);
        before = done;
    }
}

TEST(FramePieces, HoldUpTo262144RaysOnAProcessor) {
    if (!test::get_test_device().device.is_cpu()) GTEST_SKIP() << "the device is no cpu";
    session::Request request = test::make_test_request(scene::make_cornell(), {"raytrace:depth=1"},
                                                       {1024, 1024});
    session::Session session(test::get_test_engine(), request.scene);
    std::vector<std::uint64_t> largest;
    for (int frame = 0; frame < 8; ++frame) {
        std::uint64_t before = 0;
        largest.push_back(0);
        const WorkWatch watch{.on_piece = [&](std::uint64_t done, std::uint64_t) {
            largest.back() = std::max(largest.back(), done - before);
            before = done;
        }};
        const WatchScope scope(&watch);
        session.frame(request);
    }
    EXPECT_EQ(largest.front(), std::uint64_t{1} << 15);
    for (const std::uint64_t rays : largest) EXPECT_LE(rays, std::uint64_t{1} << 18);
}

// Pieces grow from frame to frame where they are short, as those of a small scene are, and shrink
// where they are long.
TEST(FramePieces, GrowWhereTheyAreShortAndShrinkWhereTheyAreLong) {
    constexpr std::uint64_t kLeast = std::uint64_t{1} << 15, kMost = std::uint64_t{1} << 18;
    std::uint64_t rays = kLeast;
    for (const std::uint64_t wanted : {kLeast * 2, kLeast * 4, kMost, kMost})
        EXPECT_EQ(rays = graph::fit_rays(rays, 49, true), wanted);
    EXPECT_EQ(graph::fit_rays(rays, 100, true), kMost);
    for (const std::uint64_t wanted : {kLeast * 4, kLeast * 2, kLeast, kLeast})
        EXPECT_EQ(rays = graph::fit_rays(rays, 201, true), wanted);
    EXPECT_EQ(graph::fit_rays(kLeast, 1, false), kLeast) << "one piece says nothing";
}

TEST(FramePieces, StopBetweenTwoPiecesLeavesASessionThatDrawsOn) {
    const session::Request request = make_rough_request("raytrace:rays=6");
    session::Request kept = make_rough_request("secant:face=16");
    session::Session session(test::get_test_engine(), request.scene);
    session.frame(kept), session.frame(kept);
    std::atomic<int> stop = 0;
    int pieces = 0;
    const WorkWatch watch{.stop = &stop,
                          .on_piece = [&](std::uint64_t, std::uint64_t) { ++pieces, stop = 15; },
                          .most_rays = 1000};
    {
        const WatchScope scope(&watch);
        test::expect_error([&] { session.frame(request); }, Failure::terminated,
                           {"stopped by signal 15"});
    }
    EXPECT_EQ(pieces, 1);
    session::Session fresh(test::get_test_engine(), request.scene);
    for (int k = 0; k < 2; ++k)
        EXPECT_TRUE(
            test::have_equal_pixel_bytes(session.frame(kept).hdr(), fresh.frame(kept).hdr()));
    EXPECT_TRUE(
        test::have_equal_pixel_bytes(session.frame(request).hdr(), fresh.frame(request).hdr()));
}

TEST(FramePieces, RunStopsWithinAFrame) {
    session::Request request = make_rough_request("raytrace:rays=40");
    request.warmup = 0, request.frames = 1;
    session::Session session(test::get_test_engine(), request.scene);
    std::atomic<int> stop = 0;
    int frames = 0;
    const session::Watcher watcher{.on_frame = [&](int, int) { ++frames; },
                                   .on_piece = [&](std::uint64_t, std::uint64_t) { stop = 2; },
                                   .stop = &stop};
    if (!test::get_test_device().device.is_cpu()) GTEST_SKIP() << "the device is no cpu";
    test::expect_error([&] { session::run(session, request, watcher); }, Failure::interrupted,
                       {"stopped by signal 2"});
    EXPECT_EQ(frames, 0);
}

TEST(FramePieces, CountTheSameWork) {
    const session::Request request = make_rough_request("hybrid:face=32,rays=4,force=unknown");
    const auto count = [&](std::uint64_t most_rays) {
        session::Session session(test::get_test_engine(), request.scene);
        const WorkWatch watch{.most_rays = most_rays};
        const WatchScope scope(&watch);
        std::vector<PassWork> passes = session::count_frame_work(session, request);
        for (PassWork& pass : passes) // a piece has dispatches and work groups of its own
            for (const WorkKind kind : {WorkKind::dispatches, WorkKind::invocations})
                pass.counts[kind] = 0;
        return passes;
    };
    const std::vector<PassWork> whole = count(kUnlimitedRays), pieces = count(2000);
    ASSERT_EQ(whole.size(), pieces.size());
    for (std::size_t i = 0; i < whole.size(); ++i)
        EXPECT_EQ(whole[i].counts.values, pieces[i].counts.values) << whole[i].name;
}

} // namespace
