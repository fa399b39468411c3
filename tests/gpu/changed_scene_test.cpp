// Tests that switch off a lamp in the middle of a frame sequence. Only the history may still show
// the light of the lamp.
#include "support/rendering.hpp"

namespace {

using namespace catoptric;

constexpr int kFramesAfterChange = 12, kFramesWithLight = 4;
constexpr uvec2 kChangedScenePictureSize{64, 64};

/// Renders `frames` frames of a test room and returns the last picture. The material of the first
/// lamp is made dark after `lit_frames` frames.
measure::Picture render_changed_scene(int lit_frames, int frames) {
    scene::Scene scene = test::make_lit_room(2, 2);
    const std::size_t out = test::add_material(scene, {.name = "out"});
    const auto lamp = std::ranges::find(scene.objects, "lamp1", &scene::Object::name);
    const scene::Edit put_out = scene::paint(static_cast<std::size_t>(lamp - scene.objects.begin()),
                                             out);
    session::Session session(test::get_test_engine(), scene);
    const session::FrameSpec spec = test::make_test_request(scene, {"reuse:face=32"},
                                                            kChangedScenePictureSize);
    measure::Picture last;
    for (int k = 1; k <= frames; ++k) {
        if (k == lit_frames + 1) session.change(put_out);
        last = session.frame(spec).hdr();
    }
    return last;
}

TEST(ChangedScene, PicturesEqualUnchangedScenesBeforeTheEditAndAfterSettling) {
    EXPECT_TRUE(
        test::have_equal_pixel_bytes(render_changed_scene(kFramesWithLight, kFramesWithLight),
                                     render_changed_scene(kFramesAfterChange, kFramesWithLight)));
    EXPECT_TRUE(
        test::have_equal_pixel_bytes(render_changed_scene(kFramesWithLight, kFramesAfterChange),
                                     render_changed_scene(0, kFramesAfterChange)));
    EXPECT_FALSE(
        test::have_equal_pixel_bytes(render_changed_scene(kFramesAfterChange, kFramesAfterChange),
                                     render_changed_scene(0, kFramesAfterChange)));
}

TEST(ChangedScene, EditKeepsTheHistory) {
    // The first frame without the lamp still shows its light in mirrors that are seen in mirrors,
    // because those come from the history. A session without history shows black in these pixels.
    EXPECT_FALSE(test::have_equal_pixel_bytes(
        render_changed_scene(kFramesWithLight, kFramesWithLight + 1), render_changed_scene(0, 1)));
    EXPECT_FALSE(
        test::have_equal_pixel_bytes(render_changed_scene(kFramesWithLight, kFramesWithLight + 1),
                                     render_changed_scene(0, kFramesWithLight + 1)));
}

} // namespace
