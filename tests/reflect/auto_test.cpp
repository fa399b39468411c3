// The plan that a scene suggests, drawn.
#include "scene/edit.hpp"
#include "support/rendering.hpp"

namespace {

using namespace catoptric;

constexpr uvec2 kSize{64, 64};

TEST(Auto, DrawsEachMirrorWithWhatSuitsItAndSaysWhy) {
    const scene::Scene hall = test::hall();
    const app::Part part = test::render(hall, "auto", kSize, 3),
                    plan = test::render(hall, "1=secant 2=hybrid 3=planar", kSize, 3);
    EXPECT_TRUE(test::same_bytes(part.hdr, plan.hdr));
    ASSERT_EQ(part.plan.size(), 3u);
    const std::pair<const char*, const char*> wanted[] = {
        {"secant", "secant: it is an exact sphere"},
        {"hybrid", "hybrid: it is neither flat nor a sphere"},
        {"planar", "planar: it is flat within a sixteenth of a pixel"}};
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(part.plan[i].technique, wanted[i].first);
        EXPECT_EQ(part.plan[i].why, wanted[i].second);
    }
    EXPECT_EQ(part.label, "auto");
}

/// One technique for all is drawn as if it had been asked for.
TEST(Auto, IsThatTechniqueWhereOneSuitsAll) {
    const scene::Scene scene = scene::cornell_mirrors();
    constexpr uvec2 size{200, 200}; // none is small in it
    const app::Part part = test::render(scene, "auto", size, 2);
    EXPECT_TRUE(test::same_bytes(part.hdr, test::render(scene, "secant", size, 2).hdr));
    EXPECT_EQ(part.scene_passes, 6);
}

/// What is suggested is so for a scene: another one is asked anew.
TEST(Auto, IsSuggestedAnewAfterAnEditAndACut) {
    scene::Scene hall = test::hall();
    app::Session session(test::engine(), hall);
    app::FrameSpec spec{.techniques = {"auto"}, .camera = hall.cameras.front(), .size = kSize};
    EXPECT_EQ(session.frame(spec).read().plan.size(), 3u);
    const std::size_t ball = scene::mirrors(hall).front();
    session.change(scene::paint(ball, 0)); // no mirror any more: the others have other numbers
    const std::vector<PlanEntry> plan = session.frame(spec).read().plan;
    ASSERT_EQ(plan.size(), 2u);
    EXPECT_EQ(plan[0].technique, "hybrid");
    EXPECT_EQ(plan[1].technique, "planar");
    app::FrameSpec away = spec; // so wide that all are small
    away.camera.vertical_fov_degrees = 160;
    EXPECT_EQ(session.frame(away).read().plan[0].technique, "hybrid")
        << "the sequence goes on as it began";
    session.forget();
    EXPECT_EQ(session.frame(away).read().plan[0].technique, "reuse");
}

} // namespace
