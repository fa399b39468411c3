// A light put out in mid-run: what the frame before left is kept, and no more than that.
#include "support/rendering.hpp"

namespace {

using namespace catoptric;

constexpr int kFrames = 12, kLit = 4;
constexpr uvec2 kSize{64, 64};

/// The last picture of a room whose first lamp is out after so many frames.
measure::Picture picture(int lit_frames, int frames) {
    const scene::Scene lit = test::room(2, 2);
    scene::Scene dark = lit;
    const auto lamp = std::ranges::find(dark.objects, "lamp1", &scene::Object::name);
    lamp->material = test::add_material(dark, {.name = "out"});
    app::Request request = test::request(lit, {"reuse:face=32"}, kSize);
    request.warmup = frames - 1;
    request.changed = [&](int frame) { return frame <= lit_frames ? lit : dark; };
    return test::engine().run(request).parts.front().hdr;
}

TEST(ChangedScene, FramesBeforeAndAfterAreThoseOfTheOneAndTheOther) {
    EXPECT_TRUE(test::same_bytes(picture(kLit, kLit), picture(kFrames, kLit)));
    EXPECT_TRUE(test::same_bytes(picture(kLit, kFrames), picture(0, kFrames)));
    EXPECT_FALSE(test::same_bytes(picture(kFrames, kFrames), picture(0, kFrames)));
}

TEST(ChangedScene, HistoryIsKept) {
    // The first frame without the lamp still shows its light in mirrors seen in mirrors; a cold
    // start shows black there.
    EXPECT_FALSE(test::same_bytes(picture(kLit, kLit + 1), picture(0, 1)));
    EXPECT_FALSE(test::same_bytes(picture(kLit, kLit + 1), picture(0, kLit + 1)));
}

} // namespace
