// A light put out in mid-run: what the frame before left is kept, and no more than that.
#include "support/rendering.hpp"

namespace {

using namespace catoptric;

constexpr int kFrames = 12, kLit = 4;
constexpr uvec2 kSize{64, 64};

/// The last picture of a room whose first lamp is out after so many frames.
measure::Picture picture(int lit_frames, int frames) {
    scene::Scene scene = test::room(2, 2);
    const std::size_t out = test::add_material(scene, {.name = "out"});
    const auto lamp = std::ranges::find(scene.objects, "lamp1", &scene::Object::name);
    const scene::Edit put_out = scene::paint(static_cast<std::size_t>(lamp - scene.objects.begin()),
                                             out);
    app::Session session(test::engine(), scene);
    const app::FrameSpec spec = test::request(scene, {"reuse:face=32"}, kSize);
    measure::Picture last;
    for (int k = 1; k <= frames; ++k) {
        if (k == lit_frames + 1) session.change(put_out);
        last = session.frame(spec).hdr();
    }
    return last;
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
