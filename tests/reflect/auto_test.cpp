// The plan that a scene suggests, drawn.
#include "scene/edit.hpp"
#include "support/rendering.hpp"

namespace {

using namespace catoptric;

constexpr uvec2 kSize{64, 64};

TEST(Auto, DrawsEachMirrorWithWhatSuitsItAndSaysWhy) {
    const scene::Scene hall = test::hall();
    const app::Part part = test::render(hall, "auto", kSize, 3),
                    plan = test::render(hall, "2,3=planar *=march", kSize, 3);
    EXPECT_TRUE(test::same_bytes(part.hdr, plan.hdr));
    ASSERT_EQ(part.plan.size(), 3u);
    const std::pair<const char*, const char*> wanted[] = {{"march", "march: a sphere, "},
                                                          {"planar", "planar: flat faces, "},
                                                          {"planar", "planar: flat, "}};
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(part.plan[i].technique, wanted[i].first);
        EXPECT_TRUE(part.plan[i].why.starts_with(wanted[i].second)) << part.plan[i].why;
    }
    EXPECT_EQ(part.label, "auto");
}

/// One technique for all is drawn as if it had been asked for.
TEST(Auto, IsThatTechniqueWhereOneSuitsAll) {
    const scene::Scene scene = scene::cornell_mirrors();
    const app::Part part = test::render(scene, "auto", kSize, 2);
    EXPECT_TRUE(test::same_bytes(part.hdr, test::render(scene, "hybrid", kSize, 2).hdr));
    EXPECT_EQ(part.scene_passes, 6);
}

/// What is suggested is so for a scene: another one is asked anew.
TEST(Auto, IsSuggestedAnewAfterAnEditAndACut) {
    scene::Scene hall = test::hall();
    app::Session session(test::engine(), hall);
    app::FrameSpec spec{.techniques = {"auto"}, .camera = hall.cameras.front(), .size = kSize};
    EXPECT_EQ(session.frame(spec).read().plan.size(), 3u);
    const std::size_t block = scene::mirrors(hall).at(1);
    session.change(scene::paint(block, 0)); // no mirror any more: the panel has another number
    const std::vector<PlanEntry> plan = session.frame(spec).read().plan;
    ASSERT_EQ(plan.size(), 2u);
    EXPECT_EQ(plan[0].technique, "march");
    EXPECT_EQ(plan[1].technique, "planar");
    app::FrameSpec away = spec; // a corner of the panel, in which the ball is not
    away.camera.eye = {.9, .9, 1.2}, away.camera.target = {.9, 1, 1.9};
    away.camera.vertical_fov_degrees = 10;
    EXPECT_EQ(session.frame(away).read().plan[0].technique, "march")
        << "the sequence goes on as it began";
    session.forget();
    EXPECT_EQ(session.frame(away).read().plan[0].technique, "reuse");
}

/// A comparison sets rows aside and goes on with them: `auto` is what it was at the first frame,
/// and is not looked for again in each round.
TEST(Auto, StaysWhatItWasWhereItsSequenceIsSetAside) {
    const scene::Scene hall = test::hall();
    app::Session session(test::engine(), hall);
    app::FrameSpec spec{.techniques = {"auto"}, .camera = hall.cameras.front(), .size = kSize};
    EXPECT_EQ(session.frame(spec).read().plan[0].technique, "march");
    app::Sequence sequence = session.suspend();
    app::FrameSpec other = spec;
    other.techniques = {"reuse:face=16"};
    session.frame(other);
    session.suspend();
    session.resume(std::move(sequence));
    spec.camera.eye = {.9, .9, 1.2}, spec.camera.target = {.9, 1, 1.9}; // the ball is not in it
    spec.camera.vertical_fov_degrees = 10;
    EXPECT_EQ(session.frame(spec).read().plan[0].technique, "march");
}

} // namespace
