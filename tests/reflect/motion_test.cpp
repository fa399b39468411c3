// Time: frame k of an animation shows the scene (k - 1) / 60 s after its start.
#include "support/rendering.hpp"

namespace {

using namespace catoptric;

TEST(Motion, FrameKStandsWhereItShould) {
    // No memory of earlier frames: an animation's last frame is a still of its instant.
    for (const char* technique : {"naive:bounces=1,face=64", "raytrace"}) {
        app::Request moving = test::request(scene::cornell_mirrors(), {technique}, {64, 64});
        moving.animate = true, moving.time = .5, moving.warmup = 3, moving.frames = 4;
        app::Request still = test::request(scene::cornell_mirrors(), {technique}, {64, 64});
        still.time = .5 + 6 / 60.0;
        const measure::Picture last = test::engine().run(moving).parts.front().hdr;
        EXPECT_TRUE(test::same_bytes(last, test::engine().run(still).parts.front().hdr))
            << technique;
        still.time = .5;
        EXPECT_FALSE(test::same_bytes(last, test::engine().run(still).parts.front().hdr))
            << technique;
    }
}

TEST(Motion, WithoutAnimationEveryFrameIsTheSame) {
    app::Request request = test::request(scene::cornell_mirrors(), {"naive:bounces=1,face=64"},
                                         {64, 64});
    const measure::Picture one = test::engine().run(request).parts.front().hdr;
    request.frames = 5;
    EXPECT_TRUE(test::same_bytes(one, test::engine().run(request).parts.front().hdr));
}

TEST(Motion, AClockSaysWhereEachFrameStands) {
    app::Request request = test::request(scene::cornell_mirrors(), {"naive:bounces=1,face=64"},
                                         {64, 64});
    std::vector<measure::Picture> seen;
    request.frames = 3, request.time = 7;
    request.clock = [](int k) { return k == 2 ? .5 : 1.5; };
    request.watch = [&](int k, const app::ReadParts& read) {
        EXPECT_EQ(static_cast<std::size_t>(k), seen.size() + 1);
        seen.push_back(read().front().hdr);
        return true;
    };
    const measure::Picture last = test::engine().run(request).parts.front().hdr;
    app::Request still = test::request(scene::cornell_mirrors(), request.techniques, {64, 64});
    still.time = .5;
    ASSERT_EQ(seen.size(), 3u);
    EXPECT_TRUE(test::same_bytes(seen[1], test::engine().run(still).parts.front().hdr));
    EXPECT_FALSE(test::same_bytes(seen[1], seen[2]));
    EXPECT_TRUE(test::same_bytes(seen[0], seen[2]));
    EXPECT_TRUE(test::same_bytes(last, seen[2]));
}

TEST(Motion, WhoHasSeenEnoughEndsTheRun) {
    app::Request request = test::request(test::room(2, 1), {"reuse:face=32"}, {32, 32});
    request.warmup = 1, request.frames = 9;
    int progressed = 0;
    request.progress = [&](int k, int total) {
        progressed = k;
        EXPECT_EQ(total, 10);
    };
    request.watch = [](int k, const app::ReadParts&) { return k < 4; };
    const app::Result result = test::engine().run(request);
    EXPECT_EQ(progressed, 4);
    EXPECT_EQ(result.frames.size(), 3u) << "the measured ones of four";
    EXPECT_TRUE(test::same_bytes(result.parts.front().hdr,
                                 test::render(test::room(2, 1), "reuse:face=32", {32, 32}, 4).hdr));
}

TEST(Samples, OnlyAnIrregularNumberDependsOnTheSeed) {
    for (const auto& [samples, depends] : {std::pair{"4", false}, {"5", true}}) {
        app::Request request = test::request(
            test::room(1, 1), {std::string("raytrace:samples=") + samples}, {48, 48});
        const measure::Picture first = test::engine().run(request).parts.front().hdr;
        request.seed = 2;
        EXPECT_EQ(test::same_bytes(first, test::engine().run(request).parts.front().hdr), !depends)
            << samples;
    }
}

} // namespace
